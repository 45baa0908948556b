// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

namespace lintel {

/// How far points are from the surfaces of a scene, e.g. from `mav0/scene0/scene.ply`. May be used from several
/// threads.
class SurfaceDistance {
 public:
  /// Reads a mesh (PLY and the other formats of assimp). Throws std::runtime_error naming the file.
  explicit SurfaceDistance(const std::string& mesh_file);
  ~SurfaceDistance();

  std::size_t triangles() const;

  /// Distance to the nearest surface [m]; infinite beyond 10 m.
  double operator()(const Eigen::Vector3d& p_w) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
