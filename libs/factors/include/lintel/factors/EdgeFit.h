// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lintel {

/// The line that fits a bent edge best, by the edge's offsets across it at a few places: Gauss-Legendre nodes from -1
/// (start) to 1 (end) of the edge, exact for bends of the fourth order.
struct EdgeFit {
  static constexpr int kSamples = 3;
  static constexpr double kNodes[kSamples] = {-0.774596669241483377, 0, 0.774596669241483377};
  static constexpr double kWeights[kSamples] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

  /// How much the offset of sample `i` moves the line's end at `side` (-1: start, 1: end).
  static constexpr double share(int i, double side) { return kWeights[i] * (1 + 3 * side * kNodes[i]); }
};

}  // namespace lintel
