// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/ParamRange.h"

namespace lintel {

/// How observations become residuals.
struct FactorParams {
  double point_sigma_px = 0.4;    ///< standard deviation of a tracked point by itself [px]
  double point_noise_px = 0.15;   ///< in the window: the white part of a track's errors (TrackNoise) [px]
  double point_walk_px = 0.3;     ///< and the standard deviation of their walk after a second [px]
  double point_loss_width = 1.5;  ///< Cauchy width, in standard deviations
  double line_sigma_px = 0.6;     ///< scales LineObservation::sigma_px
  double line_noise_px = 0.3;     ///< as with points; both scale LineObservation::sigma_px
  double line_walk_px = 0.4;
  double line_loss_width = 1.5;  ///< Cauchy width, in standard deviations
  bool find_track_noise = true;  ///< both by the recording's own residuals, these its start (NoiseScale)
  double track_freedom = 2;  ///< of a track's own variance about these: the smaller, the more tracks differ (TrackLoss)
  double gyro_noise_scale = 1.0;   ///< of the rig's noise density; 1: checked against the samples (NoiseMeter)
  double accel_noise_scale = 1.0;  ///< the same; other than 1: the rig's density is taken as given
  double gyro_walk_scale = 1.0;
  double accel_walk_scale = 1.0;

  template <class F>
  void fields(F&& field) {
    field("point_sigma_px", point_sigma_px, Range{0.01, 100});
    field("point_noise_px", point_noise_px, Range{0.01, 100});
    field("point_walk_px", point_walk_px, Range{0, 100});
    field("point_loss_width", point_loss_width, Range{0.1, 1000000});
    field("line_sigma_px", line_sigma_px, Range{0.01, 100});
    field("line_noise_px", line_noise_px, Range{0.01, 100});
    field("line_walk_px", line_walk_px, Range{0, 100});
    field("line_loss_width", line_loss_width, Range{0.1, 1000000});
    field("find_track_noise", find_track_noise);
    field("track_freedom", track_freedom, Range{0.5, 1000000});
    field("gyro_noise_scale", gyro_noise_scale, Range{0.001, 10000});
    field("accel_noise_scale", accel_noise_scale, Range{0.001, 10000});
    field("gyro_walk_scale", gyro_walk_scale, Range{0.001, 10000});
    field("accel_walk_scale", accel_walk_scale, Range{0.001, 10000});
  }
};

/// What of the calibration is refined, and how well it is known before (standard deviations of the priors).
struct CalibrationParams {
  bool refine_extrinsics = true;
  bool refine_camera = true;   ///< fx fy cx cy k1 k2
  bool refine_readout = true;  ///< of a rolling shutter
  bool refine_time_offset = true;
  bool refine_axes = true;        ///< of the IMU: scales and directions (ImuAxes.h)
  bool find_clock_offset = true;  ///< before the start; false: the stamps are right to `time_offset_sigma_s`
  bool find_stamp_jitter = true;  ///< stamps that are off each by its own amount are counted as noise of the IMU
  double extrinsic_rotation_sigma_rad = 0.005;
  double extrinsic_translation_sigma_m = 0.005;
  double focal_sigma_px = 1.0;
  double centre_sigma_px = 1.0;
  double distortion_sigma = 0.003;
  double readout_sigma_s = 0.0002;  ///< from an image's first row to its last
  double time_offset_sigma_s = 0.002;
  // what the axes of calibrated sensors are wrong by, in the window and in the refinement; see axesSigmas()
  double axes_scale_sigma = 0.001;  ///< of the accelerometer
  double axes_angle_sigma_rad = 0.0025;
  double gyro_axes_scale_sigma = 0.001;
  double gyro_axes_angle_sigma_rad = 0.001;
  double loss_width = 3;  ///< Cauchy width of each part's prior [standard deviations]; calibration.md says from when on

  template <class F>
  void fields(F&& field) {
    field("refine_extrinsics", refine_extrinsics);
    field("refine_camera", refine_camera);
    field("refine_readout", refine_readout);
    field("refine_time_offset", refine_time_offset);
    field("refine_axes", refine_axes);
    field("find_clock_offset", find_clock_offset);
    field("find_stamp_jitter", find_stamp_jitter);
    field("extrinsic_rotation_sigma_rad", extrinsic_rotation_sigma_rad, Range{1e-9, 1});
    field("extrinsic_translation_sigma_m", extrinsic_translation_sigma_m, Range{1e-9, 10});
    field("focal_sigma_px", focal_sigma_px, ReferencePixels{1e-9, 1000});
    field("centre_sigma_px", centre_sigma_px, ReferencePixels{1e-9, 1000});
    field("distortion_sigma", distortion_sigma, Range{1e-9, 10});
    field("readout_sigma_s", readout_sigma_s, Range{1e-9, 1});
    field("time_offset_sigma_s", time_offset_sigma_s, Range{1e-9, 1});
    field("axes_scale_sigma", axes_scale_sigma, Range{1e-9, 1});
    field("axes_angle_sigma_rad", axes_angle_sigma_rad, Range{1e-9, 1});
    field("gyro_axes_scale_sigma", gyro_axes_scale_sigma, Range{1e-9, 1});
    field("gyro_axes_angle_sigma_rad", gyro_axes_angle_sigma_rad, Range{1e-9, 1});
    field("loss_width", loss_width, Range{0.1, 1000000});
  }
};

/// When a track becomes part of the problem, and when it is thrown out.
struct LandmarkParams {
  int point_min_observations = 3;         ///< window frames
  double point_max_relative_sigma = 0.5;  ///< of the inverse depth when a track enters the problem
  double point_max_error_px = 3.0;        ///< mean reprojection error above which a track is an outlier
  double max_depth_m = 200;
  double min_depth_m = 0.1;
  int lasting_points = 15;         ///< that stay in the prior when their tracks outlast the window
  double lasting_walk_px = 1.5;    ///< how far their tracks slide on the surface [px/sqrt(s)]
  int line_min_observations = 4;   ///< window frames
  double line_max_error_px = 3.0;  ///< mean distance of the end points

  template <class F>
  void fields(F&& field) {
    field("point_min_observations", point_min_observations, Range{2, 1000});
    field("point_max_relative_sigma", point_max_relative_sigma, Range{0.0001, 100});
    field("point_max_error_px", point_max_error_px, Range{0.1, 1000});
    field("max_depth_m", max_depth_m, Range{0.1, 1000000});
    field("min_depth_m", min_depth_m, Range{0.001, 1000});
    field("lasting_points", lasting_points, Range{0, 1000});
    field("lasting_walk_px", lasting_walk_px, Range{0.001, 1000});
    field("line_min_observations", line_min_observations, Range{2, 1000});
    field("line_max_error_px", line_max_error_px, Range{0.1, 1000});
  }
};

/// Which lines are degenerate, and what becomes of them.
struct DegeneracyParams {
  std::string lines = "constrain";  ///< use: as they are [PL-VINS]; drop: not at all; constrain: tied to parallel ones
  std::string test = "observability";  ///< epipole: [Lim2021]; observability: from a line's information; both: either
  double max_sigma_direction_rad = 0.10;  ///< observability: above, the direction is unknown
  double max_sigma_distance = 0.10;       ///< observability: of the depth; above, the distance is unknown
  double max_epipole_angle_rad = 0.035;   ///< epipole: between the line's plane and the motion; below, degenerate
  double structural_sigma_rad = 0.01;     ///< how parallel the lines of a group are
  double structural_loss_width = 2.0;     ///< Cauchy width, in standard deviations
  double max_misfit = 2.0;                ///< of a line's planes with the group's direction, in standard deviations
  int min_group = 3;                      ///< lines that must agree, beyond those expected of random lines

  template <class F>
  void fields(F&& field) {
    field("lines", lines, OneOf{"use drop constrain"});
    field("test", test, OneOf{"epipole observability both"});
    field("max_sigma_direction_rad", max_sigma_direction_rad, Range{0.0001, 10});
    field("max_sigma_distance", max_sigma_distance, Range{0.0001, 100});
    field("max_epipole_angle_rad", max_epipole_angle_rad, Range{0, 1.5});
    field("structural_sigma_rad", structural_sigma_rad, Range{1e-5, 1});
    field("structural_loss_width", structural_loss_width, Range{0.1, 1000000});
    field("max_misfit", max_misfit, Range{0.1, 1000});
    field("min_group", min_group, Range{1, 1000});
  }
};

/// The way into the window; see Initializer.
struct InitializerParams {
  int min_frames = 10;          ///< window frames (estimator rate) before the first attempt
  int max_frames = 45;          ///< of the buffer; then older ones are dropped, or, waiting for the scale, some between
  double point_sigma_px = 0.7;  ///< of a tracked point, with the errors of the calibration, which is held [px]
  double point_loss_width = 1;  ///< Cauchy width in a start, in standard deviations
  double min_parallax_px = 12;  ///< rotation-compensated, median, over the buffer; below: static or waiting
  double max_error_px = 2.0;    ///< median reprojection error of an accepted start
  double max_scale_sigma = 0.04;       ///< relative standard deviation of the scale of an accepted start
  double patience_s = 2;               ///< where a buffer is longer, it may be larger in proportion,
  double late_scale_sigma = 0.1;       ///< at most this
  double max_bias_accel = 1.5;         ///< [m/s^2]
  double bias_gyro_sigma = 0.1;        ///< prior [rad/s]
  double bias_accel_sigma = 0.2;       ///< prior [m/s^2],
  double late_bias_accel_sigma = 0.5;  ///< and once a start was refused for its bias
  double static_disparity_px = 0.7;    ///< median motion of points over the buffer below which the vehicle rests
  double static_gyro_std = 0.03;       ///< [rad/s] and
  double static_accel_std = 0.4;       ///< [m/s^2]: standard deviations over the buffer at rest

  template <class F>
  void fields(F&& field) {
    field("min_frames", min_frames, Range{4, 1000});
    field("max_frames", max_frames, Range{4, 1000});
    field("point_sigma_px", point_sigma_px, Range{0.01, 100});
    field("point_loss_width", point_loss_width, Range{0.1, 1000000});
    field("min_parallax_px", min_parallax_px, ReferencePixels{0.1, 1000});
    field("max_error_px", max_error_px, Range{0.1, 1000});
    field("max_scale_sigma", max_scale_sigma, Range{0.0001, 100});
    field("patience_s", patience_s, Range{0.01, 1000});
    field("late_scale_sigma", late_scale_sigma, Range{0, 100});
    field("max_bias_accel", max_bias_accel, Range{0.001, 100});
    field("bias_gyro_sigma", bias_gyro_sigma, Range{1e-6, 10});
    field("bias_accel_sigma", bias_accel_sigma, Range{1e-6, 100});
    field("late_bias_accel_sigma", late_bias_accel_sigma, Range{0, 100});
    field("static_disparity_px", static_disparity_px, Range{0, 100});
    field("static_gyro_std", static_gyro_std, Range{0, 10});
    field("static_accel_std", static_accel_std, Range{0, 100});
  }
};

/// What counts as lost.
struct FailureParams {
  int min_points = 4;  ///< points and lines tracked into the newest frame; with fewer it counts as without images
  int max_blind_frames = 100;   ///< window frames in a row that the IMU may bridge: ten seconds
  double max_bias_accel = 2.5;  ///< [m/s^2] [Qin2018]
  double max_bias_gyro = 1.0;   ///< [rad/s] [Qin2018]
  double max_step_m = 2.0;      ///< difference between the predicted and the estimated position of a frame
  double max_step_rad = 0.5;

  template <class F>
  void fields(F&& field) {
    field("min_points", min_points, Range{1, 1000});
    field("max_blind_frames", max_blind_frames, Range{1, 100000});
    field("max_bias_accel", max_bias_accel, Range{0.001, 1000});
    field("max_bias_gyro", max_bias_gyro, Range{0.001, 100});
    field("max_step_m", max_step_m, Range{0.001, 1000000});
    field("max_step_rad", max_step_rad, Range{0.001, 10});
  }
};

struct EstimatorParams {
  int every_nth_frame = 2;              ///< frames that enter the window; the others get an IMU-propagated pose
  int keyframes = 11;                   ///< in the window, beside the newest frame [Qin2018: 10]
  double keyframe_parallax_px = 15;     ///< mean motion of the points since the last keyframe [Qin2018: 10]
  int keyframe_min_tracked = 20;        ///< fewer points shared with the last keyframe make a new one
  double max_keyframe_interval_s = 10;  ///< a keyframe at least this often, also at rest
  int max_iterations = 8;
  bool detect_rest = true;             ///< by points, IMU and speed; a frame at rest gets a zero-velocity observation
  double rest_disparity_px = 0.25;     ///< median motion between window frames below which rest is assumed
  double rest_speed = 0.05;            ///< estimated speed above which it is not [m/s]
  double rest_images_s = 1;            ///< a body whose IMU trembles rests, too, when for so long points have moved
  double rest_images_px = 1;           ///< by less than this (median): twice what tracks drift by in changing light
  double rest_velocity_sigma = 0.01;   ///< zero-velocity observation at rest [m/s]
  double rest_position_sigma = 0.005;  ///< by which the position may change in a rest [m]: 1 px, 2 m away
  FactorParams factors;
  CalibrationParams calibration;
  LandmarkParams landmarks;
  DegeneracyParams degeneracy;
  InitializerParams initializer;
  FailureParams failure;

  template <class F>
  void fields(F&& field) {
    field("every_nth_frame", every_nth_frame, Range{1, 100});
    field("keyframes", keyframes, Range{4, 100});
    field("keyframe_parallax_px", keyframe_parallax_px, ReferencePixels{0.1, 1000});
    field("keyframe_min_tracked", keyframe_min_tracked, Range{1, 10000});
    field("max_keyframe_interval_s", max_keyframe_interval_s, Range{0.1, 1000000});
    field("max_iterations", max_iterations, Range{1, 1000});
    field("detect_rest", detect_rest);
    field("rest_disparity_px", rest_disparity_px, Range{0, 100});
    field("rest_speed", rest_speed, Range{0, 100});
    field("rest_images_s", rest_images_s, Range{0.1, 1000});
    field("rest_images_px", rest_images_px, Range{0, 100});
    field("rest_velocity_sigma", rest_velocity_sigma, Range{1e-6, 10});
    field("rest_position_sigma", rest_position_sigma, Range{1e-6, 10});
    field("factors", factors);
    field("calibration", calibration);
    field("landmarks", landmarks);
    field("degeneracy", degeneracy);
    field("initializer", initializer);
    field("failure", failure);
  }
};

}  // namespace lintel
