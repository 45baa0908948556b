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
  int window_px = 21;           ///< side of the KLT patch
  int max_iterations = 20;      ///< of KLT, per level
  double forward_backward_px = 0.5;      ///< largest return error of a track followed back to the frame before
  double epipolar_px = 1.0;              ///< largest distance from the epipolar line between consecutive frames
  int border_px = 4;                     ///< points nearer to the image border are dropped
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
    field("border_px", border_px);
    field("initial_gyro_bias_sigma", initial_gyro_bias_sigma);
  }
};

/// What the front end is made of. Every value is checked by the FrontEnd's constructor.
struct FrontEndParams {
  PyramidParams pyramid;
  PointTrackerParams points;

  template <class F>
  void fields(F&& field) {
    field("pyramid", pyramid);
    field("points", points);
  }
};

}  // namespace lintel
