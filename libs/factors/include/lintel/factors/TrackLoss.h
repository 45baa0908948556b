// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace lintel {

/// Loss of all residuals of a track together, a point's or a line's in all images.
///
/// Tracks differ: one on a corner of a surface is good to a quarter of a pixel; one on two edges that cross at
/// different depths slides by pixels, in all images alike, which no loss of single residuals sees. So each track has a
/// variance of its own, unknown, scaled inverse chi-square with `freedom` degrees of freedom about the configured one:
/// its residuals then have a multivariate Student's t distribution,
///
///     cost = (freedom + redundancy) / 2 log(1 + squared / freedom).
class TrackLoss {
 public:
  /// `freedom` > 0: the smaller, the more tracks differ; infinite: not at all.
  explicit TrackLoss(double freedom) : freedom_(freedom) {}

  /// `squared`: sum of the track's squared residuals [standard deviations^2], single ones robust already, of
  /// `residuals` numbers of which the target's position takes `tangent`. Gives the cost, and in `weight` the factor on
  /// the weight of each residual: 1 for a track as good as its sigma says.
  double cost(double squared, int residuals, int tangent, double& weight) const {
    weight = 1;
    if (std::isinf(freedom_)) return 0.5 * squared;
    const double sum = freedom_ + std::max(1, residuals - tangent);
    weight = sum / (freedom_ + squared);
    return 0.5 * sum * std::log1p(squared / freedom_);
  }

 private:
  double freedom_;
};

}  // namespace lintel
