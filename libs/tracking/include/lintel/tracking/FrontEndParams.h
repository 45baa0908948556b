// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/ParamRange.h"

namespace lintel {

/// The image pyramid that points and lines share.
struct PyramidParams {
  int levels = 4;           ///< levels, full resolution included; 4 reach about 60 px of unpredicted flow
  bool equalise = false;    ///< contrast-limited histogram equalisation (CLAHE) before everything else; 1.2 ms a frame
  double clip_limit = 3.0;  ///< of CLAHE

  template <class F>
  void fields(F&& field) {
    field("levels", levels, Range{1, 8});
    field("equalise", equalise);
    field("clip_limit", clip_limit, Range{0.1, 1000});
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
    field("max_points", max_points, Range{1, 10000});
    field("min_distance_px", min_distance_px, ReferencePixels{1, 1000});
    field("min_quality", min_quality, Range{0, 1});
    field("detect_every_n", detect_every_n, Range{1, 1000});
    field("window_px", window_px, Range{5, 51});
    field("max_iterations", max_iterations, Range{1, 1000});
    field("forward_backward_px", forward_backward_px, Range{0.001, 100});
    field("epipolar_px", epipolar_px, Range{0.01, 1000});
    field("drift_px", drift_px, Range{0.01, 1000});
    field("drift_frames", drift_frames, Range{2, 1000});
    field("border_px", border_px, Range{0, 100});
    field("initial_gyro_bias_sigma", initial_gyro_bias_sigma, Range{1e-6, 10});
  }
};

/// Lines: detected segments, carried from frame to frame [Lim2021, line tracking].
struct LineTrackerParams {
  /// flow: predicted by optical flow, merged with detections; four_steps: as [Lim2021] describes it; descriptor: LBD
  /// matches only (baseline)
  std::string mode = "flow";
  std::string detector = "edge_drawing";  ///< edge_drawing or lsd (slower, [Lim2021]); both at half resolution
  int gradient_threshold = 24;            ///< of edge_drawing: Sobel response an edge must have
  int detect_every_n = 3;                 ///< frames between detections, mode flow
  int max_lines = 100;                    ///< lines held at once; older, then longer ones first
  int sightings_before_use =
      2;                      ///< detections of a line before it gets an identity: single false detections are left out
  double min_length_px = 50;  ///< of a new line [Lim2021: 50 px]
  double keep_length_px = 30;             ///< a tracked line that gets shorter is lost
  int window_px = 8;                      ///< side of the KLT patch of a sample on a line; multiples of 8 are quickest
  int flow_levels = 1;                    ///< pyramid levels for the samples; those not found are looked for on all
  int max_iterations = 6;                 ///< of their KLT, per level
  int min_samples = 5;                    ///< on a short line
  int max_samples = 6;                    ///< on a long line
  double max_jump_px = 8;                 ///< optical flow further than this from a line's steady motion is rejected
  double refine_px = 3;                   ///< how far from the prediction the edge is searched
  double grow_px = 16;                    ///< how far a line may grow along its edge in one frame, at each end
  double merge_angle_rad = 0.07;          ///< largest angle between a prediction and a detection of the same line
  double merge_distance_px = 3;           ///< largest distance of the detection's ends from the predicted line
  int max_frames_without_detection = 20;  ///< a line that only optical flow sees is dropped after this
  int border_px = 4;                      ///< lines end this far from the image border
  int descriptor_distance = 80;  ///< largest Hamming distance of LBD descriptors (of 256 bits), not of mode flow

  template <class F>
  void fields(F&& field) {
    field("mode", mode, OneOf{"flow four_steps descriptor"});
    field("detector", detector, OneOf{"edge_drawing lsd"});
    field("gradient_threshold", gradient_threshold, Range{1, 255});
    field("detect_every_n", detect_every_n, Range{1, 1000});
    field("max_lines", max_lines, Range{1, 10000});
    field("sightings_before_use", sightings_before_use, Range{1, 1000});
    field("min_length_px", min_length_px, ReferencePixels{20, 10000});
    field("keep_length_px", keep_length_px, ReferencePixels{16, 10000});
    field("window_px", window_px, Range{5, 51});
    field("flow_levels", flow_levels, Range{1, 8});
    field("max_iterations", max_iterations, Range{1, 1000});
    field("min_samples", min_samples, Range{3, 100});
    field("max_samples", max_samples, Range{3, 100});
    field("max_jump_px", max_jump_px, ReferencePixels{0.5, 1000});
    field("refine_px", refine_px, Range{0.5, 8});
    field("grow_px", grow_px, ReferencePixels{0, 1000});
    field("merge_angle_rad", merge_angle_rad, Range{0.001, 1});
    field("merge_distance_px", merge_distance_px, Range{0.1, 100});
    field("max_frames_without_detection", max_frames_without_detection, Range{0, 1000000});
    field("border_px", border_px, Range{1, 100});
    field("descriptor_distance", descriptor_distance, Range{0, 256});
  }
};

/// What the front end is made of. Every value is checked by the FrontEnd's constructor.
struct FrontEndParams {
  static constexpr OneOf kFeatures{"points points_lines"};
  std::string features = "points_lines";  ///< or points; a key of the whole program, not of tracking
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
