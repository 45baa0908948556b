// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "GroupNames.h"
#include "lintel/exporting/MapExport.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb& o) const { return r == o.r && g == o.g && b == o.b; }
  bool operator<(const Rgb& o) const { return packed() < o.packed(); }
  std::uint32_t packed() const { return std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b; }
};

constexpr Rgb kPointColour{120, 120, 120}, kKeyframeColour{30, 140, 60}, kTrajectoryColour{90, 115, 235};

/// A colour of the scale from low (dark violet) to high (yellow), `s` in [0, 1]; 32 steps, so that colour classes stay
/// few.
Rgb scaleColour(double s);

/// Gives each line its colour. Chosen to be seen on black as well as on white.
class LineColouring {
 public:
  /// `lines` set the range of a scale (2 to 98 % of what they show).
  LineColouring(LineColour mode, const std::vector<const MapLine*>& lines);

  Rgb operator()(const MapLine& line) const;

  /// What the colours mean: those that occur among `lines`, or the ends and middle of the scale.
  std::vector<std::pair<std::string, Rgb>> legend(const std::vector<const MapLine*>& lines,
                                                  const GroupNames& names) const;

 private:
  double shown(const MapLine& line) const;

  LineColour mode_;
  double low_ = 0, high_ = 1;
};

}  // namespace lintel
