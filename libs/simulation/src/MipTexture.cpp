// SPDX-License-Identifier: BSD-3-Clause
#include "MipTexture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lintel {

MipTexture::MipTexture(std::vector<std::uint8_t> values, int side, double tile_m)
    : per_m_(static_cast<float>(1 / tile_m)), texel_m_(static_cast<float>(tile_m / side)) {
  if (side < 1 || (side & (side - 1)) != 0 || values.size() != static_cast<std::size_t>(side) * side) {
    throw std::invalid_argument("MipTexture: side must be a power of two");
  }
  levels_.push_back({side, std::move(values)});
  while (levels_.back().side > 1) {
    const Level& fine = levels_.back();
    Level coarse{fine.side / 2, {}};
    coarse.values.reserve(static_cast<std::size_t>(coarse.side) * coarse.side);
    for (int y = 0; y < coarse.side; ++y) {
      for (int x = 0; x < coarse.side; ++x) {
        const std::uint8_t* p =
            &fine.values[static_cast<std::size_t>(2 * y) * fine.side + 2 * static_cast<std::size_t>(x)];
        coarse.values.push_back(static_cast<std::uint8_t>((p[0] + p[1] + p[fine.side] + p[fine.side + 1] + 2) / 4));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

float MipTexture::bilinear(const Level& level, float u, float v) const {
  const float x = u * static_cast<float>(level.side) - 0.5f, y = v * static_cast<float>(level.side) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y), ax = x - fx, ay = y - fy;
  const int mask = level.side - 1;  // wraps negative numbers too
  const int x0 = static_cast<int>(fx) & mask, y0 = static_cast<int>(fy) & mask, x1 = (x0 + 1) & mask,
            y1 = (y0 + 1) & mask;
  const std::uint8_t* row0 = &level.values[static_cast<std::size_t>(y0) * level.side];
  const std::uint8_t* row1 = &level.values[static_cast<std::size_t>(y1) * level.side];
  const auto between = [&](const std::uint8_t* row) {
    return static_cast<float>(row[x0]) + ax * static_cast<float>(row[x1] - row[x0]);
  };
  const float top = between(row0), bottom = between(row1);
  return (top + ay * (bottom - top)) * (1.0f / 128);
}

float MipTexture::at(float u_m, float v_m, float footprint_m) const {
  const float u = u_m * per_m_, v = v_m * per_m_;
  const float wanted = std::log2(std::max(footprint_m / texel_m_, 1.0f));
  const float clamped = std::min(wanted, static_cast<float>(levels_.size() - 1));
  const auto level = static_cast<std::size_t>(clamped);
  const float part = clamped - static_cast<float>(level), fine = bilinear(levels_[level], u, v);
  if (part < 1e-3f || level + 1 >= levels_.size()) return fine;
  return fine + part * (bilinear(levels_[level + 1], u, v) - fine);
}

}  // namespace lintel
