// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace lintel {

/// A square texture with its pyramid, so that a look-up averages over the footprint of a pixel.
class MipTexture {
 public:
  /// `values`: side*side, side a power of two.
  MipTexture(std::vector<std::uint8_t> values, int side, double tile_m);

  /// The value (1 = the material's albedo) at texture coordinates in metres (repeating), averaged over `footprint_m`.
  float at(float u_m, float v_m, float footprint_m) const;

 private:
  struct Level {
    int side = 0;
    std::vector<std::uint8_t> values;
  };
  float bilinear(const Level& level, float u, float v) const;

  std::vector<Level> levels_;
  float per_m_;  // tiles per metre
  float texel_m_;
};

}  // namespace lintel
