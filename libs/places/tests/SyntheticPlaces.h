// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <unordered_map>
#include <vector>

#include "lintel/geometry/Rotation.h"
#include "lintel/places/PlaceSearch.h"

namespace lintel::test {

inline Camera placeCamera() {
  Camera camera{752, 480, 458, 457, 367, 248, 0, 0, 0, 0};
  return camera;
}

/// A landmark of the world: where it is, and its descriptor.
struct Landmark {
  Eigen::Vector3d p_w;
  PlaceDescriptor look;
};

/// Landmarks on walls around a square of 8 m, and a camera that flies along its sides, looking outwards. The
/// descriptors in the views differ from the landmarks' by some bits; the tracks of two visits differ.
class SyntheticPlaces {
 public:
  explicit SyntheticPlaces(unsigned seed = 3) : random_(seed) {
    for (int i = 0; i < 900; ++i) {
      const double along = between(-7, 7), out = between(6.5, 8);
      const Eigen::Vector3d p(along, out, between(-1, 3));
      landmarks_.push_back({Eigen::AngleAxisd(M_PI / 2 * (i % 4), Eigen::Vector3d::UnitZ()) * p, anyLook()});
    }
  }

  PlaceDescriptor anyLook() { return {word(), word(), word(), word()}; }

  /// The camera at `side` (0 to 4, whole numbers are corners): z forward, y down.
  static Pose poseAt(double side) {
    const Eigen::AngleAxisd turn(-M_PI / 2 * std::floor(side), Eigen::Vector3d::UnitZ());
    Eigen::Matrix3d R;
    R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    const double x = 8 * (side - std::floor(side)) - 4;
    return {Eigen::Quaterniond(Eigen::Matrix3d(turn * R)), turn * Eigen::Vector3d(x, 2.5, 1)};
  }

  /// Adds a keyframe at the true pose `T_w_c`; `drift` takes true to estimated coordinates. Points get the tracks
  /// `first_track` + landmark, and are added to points_w in estimated coordinates.
  void add(double t_s, const Pose& T_w_c, const Pose& drift, TrackId first_track, const std::vector<Landmark>& seen,
           double travelled_m) {
    views.push_back(std::make_unique<PlaceView>());
    PlaceView& view = *views.back();
    view.t_ns = static_cast<std::int64_t>(1e9 * t_s);
    const Pose T_c_w = T_w_c.inverse();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector3d p_c = T_c_w * seen[i].p_w;
      if (p_c.z() < 0.5 || !camera.contains(camera.project(p_c))) continue;
      PlaceFeature feature;
      feature.px = camera.project(p_c).cast<float>();
      feature.track = static_cast<std::int64_t>(first_track + i);
      feature.level = 1;
      feature.descriptor = blurred(seen[i].look);
      view.features.push_back(feature);
      points_w[first_track + i] = drift * seen[i].p_w;
    }
    keyframes.push_back({drift * T_w_c, 0, travelled_m, &view});
  }

  const std::vector<Landmark>& landmarks() const { return landmarks_; }

  const Camera camera = placeCamera();
  std::vector<std::unique_ptr<PlaceView>> views;
  std::vector<PlaceKeyframe> keyframes;
  std::unordered_map<TrackId, Eigen::Vector3d> points_w;

 private:
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_() % 100000) / 1e5; }
  std::uint64_t word() { return std::uint64_t{random_()} << 32U | random_(); }
  /// With 12 bits changed.
  PlaceDescriptor blurred(PlaceDescriptor look) {
    for (int i = 0; i < 12; ++i) {
      const std::size_t bit = random_() % 256;
      look[bit / 64] ^= std::uint64_t{1} << bit % 64;
    }
    return look;
  }

  std::mt19937 random_;
  std::vector<Landmark> landmarks_;
};

}  // namespace lintel::test
