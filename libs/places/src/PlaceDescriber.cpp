// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/places/PlaceDescriber.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/features2d.hpp>

namespace lintel {

namespace {

constexpr float kStep = 1.2F;  // from level to level
constexpr int kLevels = 6, kBorder_px = 16, kCorners = 1200;
constexpr int kTrackSizes = 3, kSizeStep = 2;         // in which tracked points are described, in levels
constexpr int kColumns = 8, kRows = 6, kPerCell = 5;  // of the corners that are kept

/// Direction of gravity in the image [degrees].
float uprightAngle(const Camera& camera, const cv::Point2f& px, const Eigen::Vector3d& down_c) {
  Eigen::Vector3d ray;
  if (!camera.unproject({px.x, px.y}, ray)) return 0;
  ray.normalize();
  const Eigen::Vector2d d = camera.project(ray + 1e-3 * down_c) - camera.project(ray);
  const double angle = std::atan2(d.y(), d.x()) * 180 / M_PI;
  return std::isfinite(angle) ? static_cast<float>(angle < 0 ? angle + 360 : angle) : 0;
}

/// The strongest of each cell of the image.
void spread(const Camera& camera, std::vector<cv::KeyPoint>& corners) {
  std::sort(corners.begin(), corners.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::make_tuple(-a.response, a.octave, a.pt.y, a.pt.x) <
           std::make_tuple(-b.response, b.octave, b.pt.y, b.pt.x);
  });
  std::array<int, static_cast<std::size_t>(kColumns * kRows)> taken{};
  const auto isFull = [&](const cv::KeyPoint& k) {
    const int x = static_cast<int>(k.pt.x) * kColumns / camera.width,
              y = static_cast<int>(k.pt.y) * kRows / camera.height;
    const int cell = y * kColumns + x;
    return taken[static_cast<std::size_t>(cell)]++ >= kPerCell;
  };
  corners.erase(std::remove_if(corners.begin(), corners.end(), isFull), corners.end());
}

}  // namespace

int hammingDistance(const PlaceDescriptor& a, const PlaceDescriptor& b) {
  int n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += __builtin_popcountll(a[i] ^ b[i]);
  return n;
}

struct PlaceDescriber::Impl {
  Camera camera;
  cv::Ptr<cv::ORB> orb = cv::ORB::create(kCorners, kStep, kLevels, kBorder_px, 0, 2, cv::ORB::HARRIS_SCORE, 31, 10);
};

PlaceDescriber::PlaceDescriber(const Camera& camera) : impl_(std::make_unique<Impl>()) { impl_->camera = camera; }
PlaceDescriber::~PlaceDescriber() = default;
PlaceDescriber::PlaceDescriber(PlaceDescriber&&) noexcept = default;

PlaceView PlaceDescriber::describe(const Frame& frame, const std::vector<PointObservation>& tracked,
                                   const Eigen::Vector3d& down_c) const {
  const GrayImage& grey = *frame.image;
  const cv::Mat image(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.pixels.data()));
  std::vector<cv::KeyPoint> places;
  impl_->orb->detect(image, places);
  spread(impl_->camera, places);
  for (cv::KeyPoint& corner : places) corner.class_id = -1;
  for (int level = 0; level < kTrackSizes * kSizeStep; level += kSizeStep)
    for (std::size_t i = 0; i < tracked.size(); ++i) {
      const Eigen::Vector2f px = tracked[i].px.cast<float>();
      places.emplace_back(px.x(), px.y(), 31 * std::pow(kStep, static_cast<float>(level)), 0, 0, level,
                          static_cast<int>(i));
    }
  for (cv::KeyPoint& place : places) place.angle = uprightAngle(impl_->camera, place.pt, down_c);
  std::stable_sort(places.begin(), places.end(),
                   [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.octave < b.octave; });
  cv::Mat descriptors;
  impl_->orb->compute(image, places, descriptors);
  PlaceView view{frame.t_ns, {}};
  view.features.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    PlaceFeature feature;
    feature.px = {places[i].pt.x, places[i].pt.y};
    if (places[i].class_id >= 0) {
      feature.track = static_cast<std::int64_t>(tracked[static_cast<std::size_t>(places[i].class_id)].id);
      feature.level = static_cast<std::uint8_t>(places[i].octave / kSizeStep);
    }
    std::memcpy(feature.descriptor.data(), descriptors.ptr(static_cast<int>(i)), sizeof feature.descriptor);
    view.features.push_back(feature);
  }
  return view;
}

}  // namespace lintel
