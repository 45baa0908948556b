// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lintel {

/// The image pyramid that points and lines share.
struct PyramidParams {
  int levels = 4;           ///< levels, full resolution included; 4 reach about 60 px of unpredicted flow
  bool equalise = false;    ///< contrast-limited histogram equalisation (CLAHE) before everything else; 1.2 ms a frame
  double clip_limit = 3.0;  ///< of CLAHE

  template <class F>
  void fields(F&& field) {
    field("levels", levels);
    field("equalise", equalise);
    field("clip_limit", clip_limit);
  }
};

/// Points: KLT tracks of corners.
struct PointTrackerParams {
  int max_points = 150;         ///< points held at once [Lim2021: 150]
  double min_distance_px = 25;  ///< between points when new ones are chosen
  double min_quality = 0.01;    ///< smallest corner response, as a share of the image's strongest
  int detect_every_n = 2;       ///< frames between searches for new corners; 2 = the estimator's rate at 20 Hz images
  int window_px = 13;           ///< side of the KLT patch
  int max_iterations = 20;      ///< of KLT, per level
  double forward_backward_px = 0.5;  ///< largest return error of a track followed back, where its patch was not found
  double epipolar_px = 1.0;          ///< largest distance from the epipolar line between consecutive frames
  double drift_px = 1.5;             ///< largest distance from the epipolar line over drift_frames
  int drift_frames = 10;             ///< baseline of the check against slow drift [frames]
  int border_px = 4;                 ///< points nearer to the image border are dropped
  double initial_gyro_bias_sigma = 0.1;  ///< how wrong the gyro may be at the start [rad/s]

  template <class F>
  void fields(F&& field) {
    field("max_points", max_points);
    field("min_distance_px", min_distance_px);
    field("min_quality", min_quality);
    field("detect_every_n", detect_every_n);
    field("window_px", window_px);
    field("max_iterations", max_iterations);
    field("forward_backward_px", forward_backward_px);
    field("epipolar_px", epipolar_px);
    field("drift_px", drift_px);
    field("drift_frames", drift_frames);
    field("border_px", border_px);
    field("initial_gyro_bias_sigma", initial_gyro_bias_sigma);
  }
};

/// Lines: detected segments, carried from frame to frame [Lim2021, line tracking].
struct LineTrackerParams {
  std::string mode =
      "flow";  ///< flow: predicted by optical flow, merged with detections; descriptor: LBD matches alone (baseline)
  std::string detector = "edge_drawing";  ///< edge_drawing or lsd (slower); both at half resolution
  int gradient_threshold = 24;            ///< of edge_drawing: Sobel response an edge must have
  int detect_every_n = 3;                 ///< frames between detections, mode flow
  int max_lines = 100;                    ///< lines held at once; older, then longer ones first
  int sightings_before_use = 2;           ///< detections of a line before it gets an identity: chance lines stay out
  double min_length_px = 50;              ///< of a new line [Lim2021: 50 px]
  double keep_length_px = 30;             ///< a tracked line that gets shorter is lost
  int window_px = 8;                      ///< side of the KLT patch of a sample on a line; multiples of 8 are quickest
  int flow_levels = 1;                    ///< pyramid levels for the samples; those not found are looked for on all
  int max_iterations = 6;                 ///< of their KLT, per level
  int min_samples = 5;                    ///< on a short line
  int max_samples = 6;                    ///< on a long line
  double max_jump_px = 8;         ///< optical flow further than this from a line's steady motion is not believed
  double refine_px = 3;           ///< how far from the prediction the edge is searched
  double grow_px = 16;            ///< how far a line may grow along its edge in one frame, at each end
  double merge_angle_rad = 0.07;  ///< largest angle between a prediction and a detection of the same line
  double merge_distance_px = 3;   ///< largest distance of the detection's ends from the predicted line
  int max_frames_without_detection = 20;  ///< a line that only optical flow sees is dropped after this
  int border_px = 4;                      ///< lines end this far from the image border
  int descriptor_distance = 80;  ///< largest Hamming distance of LBD descriptors (of 256 bits), mode descriptor

  template <class F>
  void fields(F&& field) {
    field("mode", mode);
    field("detector", detector);
    field("gradient_threshold", gradient_threshold);
    field("detect_every_n", detect_every_n);
    field("max_lines", max_lines);
    field("sightings_before_use", sightings_before_use);
    field("min_length_px", min_length_px);
    field("keep_length_px", keep_length_px);
    field("window_px", window_px);
    field("flow_levels", flow_levels);
    field("max_iterations", max_iterations);
    field("min_samples", min_samples);
    field("max_samples", max_samples);
    field("max_jump_px", max_jump_px);
    field("refine_px", refine_px);
    field("grow_px", grow_px);
    field("merge_angle_rad", merge_angle_rad);
    field("merge_distance_px", merge_distance_px);
    field("max_frames_without_detection", max_frames_without_detection);
    field("border_px", border_px);
    field("descriptor_distance", descriptor_distance);
  }
};

/// What the front end is made of. Every value is checked by the FrontEnd's constructor.
struct FrontEndParams {
  std::string features = "points_lines";  ///< or points, alone; of the whole program: not among the keys of tracking
  PyramidParams pyramid;
  PointTrackerParams points;
  LineTrackerParams lines;

  template <class F>
  void fields(F&& field) {
    field("pyramid", pyramid);
    field("points", points);
    field("lines", lines);
  }
};

}  // namespace lintel
