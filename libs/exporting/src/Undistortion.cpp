// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/exporting/Undistortion.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

namespace lintel {
namespace {

constexpr float kNowhere = -10;  ///< outside every image

/// Where the pinhole camera sees what is at a pixel of the other one; nothing outside its image.
std::optional<Eigen::Vector2d> moved(const Eigen::Vector2d& px, const Camera& camera, const Camera& pinhole) {
  Eigen::Vector3d ray;
  if (!camera.unproject(px, ray) || !pinhole.projects(ray)) return std::nullopt;
  const Eigen::Vector2d to = pinhole.project(ray);
  return pinhole.contains(to) ? std::optional(to) : std::nullopt;
}

void movePoint(MapPoint& point, const Camera& camera, const Camera& pinhole) {
  std::vector<MapPointObservation> seen;
  for (MapPointObservation observation : point.observations)
    if (const auto px = moved(observation.px, camera, pinhole)) {
      observation.px = *px;
      seen.push_back(observation);
    }
  point.observations = std::move(seen);
}

void moveLine(MapLine& line, const Camera& camera, const Camera& pinhole) {
  std::vector<MapLineObservation> seen;
  for (MapLineObservation observation : line.observations) {
    const auto start = moved(observation.start_px, camera, pinhole), end = moved(observation.end_px, camera, pinhole);
    if (!start || !end) continue;
    observation.start_px = *start;
    observation.end_px = *end;
    seen.push_back(observation);
  }
  line.observations = std::move(seen);
}

}  // namespace

Camera pinholeOf(const Camera& camera) {
  Camera pinhole = camera;
  const double scale = camera.meanFocal() / (0.5 * (camera.fx + camera.fy));
  pinhole.fx *= scale;
  pinhole.fy *= scale;
  pinhole.model = LensModel::kRadialTangential;
  pinhole.lens = {};
  return pinhole;
}

LineMap undistorted(LineMap map) {
  const Camera camera = map.rig.camera, pinhole = pinholeOf(camera);
  map.rig.camera = pinhole;
  for (MapPoint& point : map.points) movePoint(point, camera, pinhole);
  for (MapLine& line : map.lines) moveLine(line, camera, pinhole);
  return map;
}

ImageUndistorter::ImageUndistorter(const Camera& camera, const Camera& pinhole)
    : width_(camera.width), height_(camera.height), to_width_(pinhole.width), to_height_(pinhole.height) {
  for (int y = 0; y < to_height_; ++y)
    for (int x = 0; x < to_width_; ++x) {
      const Eigen::Vector3d ray = pinhole.ray({x, y});
      const bool seen = camera.projects(ray);
      const Eigen::Vector2d px = seen ? camera.project(ray) : Eigen::Vector2d::Constant(kNowhere);
      from_x_.push_back(static_cast<float>(px.x()));
      from_y_.push_back(static_cast<float>(px.y()));
    }
}

GrayImage ImageUndistorter::operator()(const GrayImage& image) const {
  if (image.width != width_ || image.height != height_)
    throw std::invalid_argument("ImageUndistorter: an image of another size than the camera's");
  GrayImage result{
      to_width_, to_height_,
      std::vector<std::uint8_t>(static_cast<std::size_t>(to_width_) * static_cast<std::size_t>(to_height_))};
  const auto map = [&](const std::vector<float>& values) {
    return cv::Mat(to_height_, to_width_, CV_32FC1, const_cast<float*>(values.data()));
  };
  const cv::Mat from(height_, width_, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat to(to_height_, to_width_, CV_8UC1, result.pixels.data());
  cv::remap(from, to, map(from_x_), map(from_y_), cv::INTER_LINEAR);
  return result;
}

}  // namespace lintel
