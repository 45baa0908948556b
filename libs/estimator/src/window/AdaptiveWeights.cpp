// SPDX-License-Identifier: BSD-3-Clause
#include "window/AdaptiveWeights.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr std::size_t kLeastResiduals = 30;  // the median of fewer is not reliable
constexpr double kMedianOfNorm = 1.1774;     // of two standard normal residuals (Rayleigh)
constexpr double kShare = 0.1;               // of a correction that one window brings, in logarithms
constexpr double kMostChange = 2;            // of the configured sigma

class Collector {
 public:
  Collector(int freedom) : freedom_(freedom) {}

  void add(const Eigen::Vector2d& residual, std::uint64_t landmark) {
    norms_.push_back(residual.norm());
    landmarks_.insert(landmark);
  }

  double scale() {
    const double residuals = 2 * static_cast<double>(norms_.size());
    const double redundant = residuals - freedom_ * static_cast<double>(landmarks_.size());
    if (norms_.size() < kLeastResiduals || redundant < static_cast<double>(kLeastResiduals)) return 1;
    return upperMedian(norms_) / kMedianOfNorm * std::sqrt(residuals / redundant);
  }

 private:
  int freedom_;
  std::vector<double> norms_;
  std::set<std::uint64_t> landmarks_;
};

double adapted(double now, double scale, double configured) {
  return std::clamp(now * std::pow(scale, kShare), configured / kMostChange, configured * kMostChange);
}

}  // namespace

ResidualScales residualScales(SlidingWindow& window, const std::vector<Factor>& factors) {
  Collector points(kPointTangent), lines(kLineTangent);
  std::vector<const double*> blocks;
  for (const Factor& factor : factors) {
    const BlockKey& landmark = factor.blocks.back();
    const bool point = dynamic_cast<const PointFactor*>(factor.cost) != nullptr;
    if (!point && dynamic_cast<const LineFactor*>(factor.cost) == nullptr) continue;
    blocks.clear();
    for (const BlockKey& key : factor.blocks) blocks.push_back(window.block(key));
    Eigen::Vector2d residual;
    factor.cost->Evaluate(blocks.data(), residual.data(), nullptr);
    (point ? points : lines).add(residual, landmark.id);
  }
  return {points.scale(), lines.scale()};
}

void adaptSigmas(const ResidualScales& scales, const FactorParams& configured, FactorParams& now) {
  now.point_sigma_px = adapted(now.point_sigma_px, scales.points, configured.point_sigma_px);
  now.line_sigma_px = adapted(now.line_sigma_px, scales.lines, configured.line_sigma_px);
}

}  // namespace lintel
