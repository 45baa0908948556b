// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "lintel/simulation/Scene.h"

namespace lintel {

/// Where a ray met the scene.
struct RayHit {
  int patch = -1;      ///< -1: nothing
  float a = 0, b = 0;  ///< place on the patch, 0 to 1
  float distance = 0;  ///< along the ray in lengths of its direction
};

/// Intersections of rays with a scene's patches. The only place that uses Embree's rays. Safe to use from several
/// threads.
class RayCaster {
 public:
  static constexpr int kPacket = 8;
  struct Packet {
    std::array<float, kPacket> x, y, z;
  };

  explicit RayCaster(const Scene& scene);
  ~RayCaster();

  /// The nearest hits of `kPacket` rays from one origin. Directions need not be of length 1.
  void cast(const Eigen::Vector3f& origin, const Packet& directions, std::array<RayHit, kPacket>& hits) const;

  /// Whether something is between the two points, their ends up to `tolerance_m` left out.
  bool occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance_m) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace lintel
