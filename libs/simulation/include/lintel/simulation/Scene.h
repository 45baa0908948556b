// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "lintel/geometry/Segment.h"

namespace lintel {

/// What a surface's texture shows; TexturePainter.h paints them.
enum class Pattern { kPaint, kPlaster, kTerrazzo, kWood, kCarton, kPoster };

/// A texture, repeated every `tile_m` in both directions of a patch.
struct Material {
  Pattern pattern = Pattern::kPaint;
  double albedo = 0.6;       ///< mean reflectance, 0 to 1
  double tile_m = 4;         ///< side of the square tile [m]
  int resolution_px = 1024;  ///< side of the tile, a power of two
  std::uint64_t seed = 0;
};

/// A parallelogram (or its half, a triangle): the points corner + a edge_u + b edge_v with a, b in [0, 1]. Seen from
/// the side that its normal edge_u x edge_v points to.
struct Patch {
  Eigen::Vector3d corner, edge_u, edge_v;  ///< world [m]
  bool triangle = false;                   ///< only the half with a + b <= 1
  int material = 0;                        ///< index into Scene::materials
  double tint = 1;                         ///< factor on the material's albedo
  Eigen::Vector2d texture_origin_m{0, 0};  ///< texture coordinates of the corner

  Eigen::Vector3d normal() const { return edge_u.cross(edge_v).normalized(); }
};

/// A straight edge that is really there: where surfaces meet or paint ends.
struct SceneLine {
  Segment3 segment_w;
  std::string kind;  ///< hull, beam, frame, box, …
};

/// A light that shines in all directions.
struct Lamp {
  Eigen::Vector3d p_w;
  double power = 1;       ///< irradiance at 1 m
  double radius_m = 0.3;  ///< size: shadows get soft
};

/// A still world.
struct Scene {
  std::vector<Patch> patches;
  std::vector<Material> materials;
  std::vector<SceneLine> lines;
  std::vector<Lamp> lamps;
  double ambient = 0.35;  ///< light from everywhere
};

}  // namespace lintel
