// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/geometry/Pose.h"
#include "lintel/simulation/Random.h"
#include "lintel/simulation/SceneLibrary.h"

namespace lintel {

/// Puts a scene together from parts, each with its true edges. Parts that would be in the way of the path are left out.
class SceneAssembler {
 public:
  explicit SceneAssembler(const SceneRequest& request);

  const Eigen::AlignedBox3d& hull() const { return request_.hull; }
  RandomStream& random() { return random_; }
  double uniform(double low, double high) { return random_.uniform(low, high); }

  /// Adds a texture with a seed of its own; returns its index.
  int material(Pattern pattern, double albedo, double tile_m = 4, int resolution_px = 1024);

  /// A bare surface, no edges. Its texture starts at a random place.
  void patch(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int material,
             double tint = 1, bool triangle = false);

  /// A picture of its own over the whole parallelogram, with its four edges.
  void poster(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double albedo,
              const std::string& kind);

  void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const std::string& kind);

  /// A box of `size` centred at T_w_l; twelve edges. Returns false if it is too near the path and was left out.
  bool box(const Pose& T_w_l, const Eigen::Vector3d& size, int material, const std::string& kind, double tint = 1);
  /// The same, parallel to the axes, by its lowest and highest corner.
  bool box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material, const std::string& kind,
           double tint = 1);

  /// A square bar between two points.
  bool bar(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double thickness, int material, const std::string& kind,
           double tint = 1);

  /// A wedge: a ramp rising along l's x from 0 to size.z; nine edges.
  bool ramp(const Pose& T_w_l, const Eigen::Vector3d& size, int material, const std::string& kind);

  /// Walls, floor and ceiling round the hull; `skew_rad` turns and tilts the walls at random so that nothing is
  /// parallel. With `floor_material` -1 there is no floor (the scene lays its own). Twelve edges.
  void shell(int wall_material, int floor_material, int ceiling_material, double skew_rad);

  void lamp(const Eigen::Vector3d& p_w, double power) { scene_.lamps.push_back({p_w, power, 0.35}); }
  void ambient(double level) { scene_.ambient = level; }

  Scene finish() { return std::move(scene_); }

 private:
  bool inTheWay(const Pose& T_w_l, const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;

  SceneRequest request_;
  RandomStream random_;
  Scene scene_;
};

}  // namespace lintel
