// SPDX-License-Identifier: BSD-3-Clause
#include "LightMap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lintel {

namespace {

constexpr double kCell_m = 0.2;
constexpr int kMostCells = 96;

int nodes(double length_m) { return std::clamp(static_cast<int>(std::ceil(length_m / kCell_m)) + 1, 2, kMostCells); }

/// Points over a lamp's ball: the corners of a tetrahedron and their opposites.
std::array<Eigen::Vector3d, 8> lampPoints(const Lamp& lamp) {
  std::array<Eigen::Vector3d, 8> points;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    points[i] = lamp.p_w + lamp.radius_m / std::sqrt(3.0) * corner;
  }
  return points;
}

double lightAt(const Scene& scene, const Eigen::Vector3d& p, const Eigen::Vector3d& normal, const RayCaster& rays) {
  double light = scene.ambient * (0.8 + 0.2 * normal.z() + 0.12 * normal.x() + 0.06 * normal.y());  // facets differ
  const Eigen::Vector3d before = p + 0.01 * normal;
  for (const Lamp& lamp : scene.lamps) {
    for (const Eigen::Vector3d& source : lampPoints(lamp)) {
      const Eigen::Vector3d way = source - before;
      const double distance = way.norm(), cosine = normal.dot(way) / distance;
      if (cosine <= 0 || rays.occluded(before, source, 0.005)) continue;
      light += lamp.power / 8 * cosine / (0.5 + distance * distance);
    }
  }
  return light;
}

}  // namespace

LightMap::LightMap(const Scene& scene, const Patch& patch, const RayCaster& rays)
    : columns_(nodes(patch.edge_u.norm())), rows_(nodes(patch.edge_v.norm())) {
  const Eigen::Vector3d normal = patch.normal();
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      // a little inside: nodes on an edge would lie in the neighbouring surface
      const double a = std::clamp(static_cast<double>(c) / (columns_ - 1), 0.05, 0.95);
      const double b = std::clamp(static_cast<double>(r) / (rows_ - 1), 0.05, 0.95);
      values_.push_back(
          static_cast<float>(lightAt(scene, patch.corner + a * patch.edge_u + b * patch.edge_v, normal, rays)));
    }
  }
}

float LightMap::at(float a, float b) const {
  const float x = std::clamp(a, 0.0f, 1.0f) * static_cast<float>(columns_ - 1);
  const float y = std::clamp(b, 0.0f, 1.0f) * static_cast<float>(rows_ - 1);
  const int x0 = std::min(static_cast<int>(x), columns_ - 2), y0 = std::min(static_cast<int>(y), rows_ - 2);
  const float ax = x - static_cast<float>(x0), ay = y - static_cast<float>(y0);
  const int place = y0 * columns_ + x0;
  const float* row0 = &values_[static_cast<std::size_t>(place)];
  const float* row1 = row0 + columns_;
  const float top = row0[0] + ax * (row0[1] - row0[0]), bottom = row1[0] + ax * (row1[1] - row1[0]);
  return top + ay * (bottom - top);
}

}  // namespace lintel
