// SPDX-License-Identifier: BSD-3-Clause
#include "ParamsCheck.h"

#include <sstream>
#include <stdexcept>
#include <string>

namespace lintel {
namespace {

/// `!(in range)` also catches NaN.
void require(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << "front end: " << name << " = " << value << ", must be from " << low << " to " << high;
  throw std::invalid_argument(text.str());
}

void checkLines(const LineTrackerParams& p) {
  if (p.mode != "flow" && p.mode != "descriptor")
    throw std::invalid_argument("front end: lines.mode = " + p.mode + ", must be flow or descriptor");
  if (p.detector != "edge_drawing" && p.detector != "lsd")
    throw std::invalid_argument("front end: lines.detector = " + p.detector + ", must be edge_drawing or lsd");
  require("lines.gradient_threshold", p.gradient_threshold, 1, 255);
  require("lines.detect_every_n", p.detect_every_n, 1, 1000);
  require("lines.max_lines", p.max_lines, 1, 10000);
  require("lines.sightings_before_use", p.sightings_before_use, 1, 1000);
  require("lines.min_length_px", p.min_length_px, 20, 10000);
  require("lines.keep_length_px", p.keep_length_px, 16, p.min_length_px);
  require("lines.window_px", p.window_px, 5, 51);
  require("lines.flow_levels", p.flow_levels, 1, 8);
  require("lines.max_iterations", p.max_iterations, 1, 1000);
  require("lines.min_samples", p.min_samples, 3, 100);
  require("lines.max_samples", p.max_samples, p.min_samples, 100);
  require("lines.max_jump_px", p.max_jump_px, 0.5, 1000);
  require("lines.refine_px", p.refine_px, 0.5, 8);
  require("lines.grow_px", p.grow_px, 0, 1000);
  require("lines.merge_angle_rad", p.merge_angle_rad, 0.001, 1);
  require("lines.merge_distance_px", p.merge_distance_px, 0.1, 100);
  require("lines.max_frames_without_detection", p.max_frames_without_detection, 0, 1000000);
  require("lines.border_px", p.border_px, 1, 100);
  require("lines.descriptor_distance", p.descriptor_distance, 0, 256);
}

}  // namespace

void checkParams(const Rig& rig, const FrontEndParams& params) {
  require("camera width", rig.camera.width, 64, 20000);
  require("camera height", rig.camera.height, 64, 20000);
  require("camera fx", rig.camera.fx, 1, 1e6);
  require("camera fy", rig.camera.fy, 1, 1e6);
  require("pyramid.levels", params.pyramid.levels, 1, 8);
  require("pyramid.clip_limit", params.pyramid.clip_limit, 0.1, 1000);
  if (params.features != "points" && params.features != "points_lines")
    throw std::invalid_argument("features = " + params.features + ", must be points or points_lines");
  const PointTrackerParams& p = params.points;
  require("points.max_points", p.max_points, 1, 10000);
  require("points.min_distance_px", p.min_distance_px, 1, 1000);
  require("points.min_quality", p.min_quality, 0, 1);
  require("points.detect_every_n", p.detect_every_n, 1, 1000);
  require("points.window_px", p.window_px, 5, 51);
  require("points.max_iterations", p.max_iterations, 1, 1000);
  require("points.forward_backward_px", p.forward_backward_px, 0.001, 100);
  require("points.epipolar_px", p.epipolar_px, 0.01, 1000);
  require("points.drift_px", p.drift_px, 0.01, 1000);
  require("points.drift_frames", p.drift_frames, 2, 1000);
  require("points.border_px", p.border_px, 0, 100);
  require("points.initial_gyro_bias_sigma", p.initial_gyro_bias_sigma, 1e-6, 10);
  checkLines(params.lines);
}

void checkFrame(const Rig& rig, const Frame& frame) {
  const std::string at = "front end: frame " + std::to_string(frame.t_ns);
  if (!frame.image) throw std::invalid_argument(at + " has no image");
  const GrayImage& image = *frame.image;
  if (image.width != rig.camera.width || image.height != rig.camera.height ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw std::invalid_argument(at + " is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                                ", the rig's camera is " + std::to_string(rig.camera.width) + "x" +
                                std::to_string(rig.camera.height));
}

}  // namespace lintel
