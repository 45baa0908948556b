// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/ClockOffset.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "initialisation/ClockFit.h"
#include "lintel/core/Hypotheses.h"

namespace lintel {

namespace {

constexpr int kSteps = 20;  // of the grid, to either side: 5 ms, much less than a turn takes
constexpr double kStep_s = kLargestClockOffset_s / kSteps;
constexpr int kCoarse = 4;                 // steps at first, 20 ms: a fifth of the period of a hand that shakes
constexpr double kLeastCertain_s = 0.025;  // the range is eight times as wide
constexpr double kFineStep_s = 1e-3;       // at which the likelihood is summed up over the range
constexpr double kMostSpread_s = 0.03;     // of the offset over the whole range; 0.058 where all are as likely
constexpr double kLeastTurn_px = 0.3;      // a turn that moves points by less than tracks err shows no offset
constexpr double kWidth_px = 2;            // of the robust loss
constexpr std::size_t kLeastPairs = 10;
constexpr double kUnsynchronised = 4;  // standard deviations of the offset, beyond which the camera has no trigger
// How often a readout is another one than the given, and how often cameras without a trigger roll.
constexpr double kOtherShare = 0.1, kOtherShareUnsynchronised = 0.5;
// Of a readout that is as given: more than is taken for granted, so that where images do not tell it stays open.
constexpr double kSureAsGiven = 0.97;
constexpr double kLeastReadout_s = 0.002;  // standard deviation: the sum of what the model leaves out

/// Costs by steps of the offset.
class Grid {
 public:
  explicit Grid(ClockFit& fit) : fit_(fit) {}

  /// Evaluates the grid coarsely, then every step around the smallest cost; its place.
  int search() {
    for (int k = -kSteps; k <= kSteps; k += kCoarse) at(k);
    const int coarse = smallest();
    for (int k = std::max(-kSteps, coarse - kCoarse); k <= std::min(kSteps, coarse + kCoarse); ++k) at(k);
    return smallest();
  }

  /// The place of the smallest cost around a place.
  int descend(int from) {
    for (int k = from;; from = k) {
      for (int near = std::max(-kSteps, from - 1); near <= std::min(kSteps, from + 1); ++near) at(near);
      k = smallest();
      if (k == from) return k;
    }
  }

  /// The cost at an offset, by straight lines between those that were evaluated.
  double between(double offset_s) const {
    const double k = offset_s / kStep_s;
    const auto after = systems_.lower_bound(std::min(kSteps, static_cast<int>(std::ceil(k))));
    if (after == systems_.begin()) return after->second.cost;
    const auto before = std::prev(after);
    const double share = (k - before->first) / (after->first - before->first);
    return (1 - share) * before->second.cost + share * after->second.cost;
  }

  const EpipolarSystem& at(int k) {
    const auto found = systems_.find(k);
    return found != systems_.end() ? found->second : systems_.emplace(k, fit_.at(k * kStep_s)).first->second;
  }

 private:
  int smallest() const {
    return std::min_element(systems_.begin(), systems_.end(),
                            [](const auto& x, const auto& y) { return x.second.cost < y.second.cost; })
        ->first;
  }

  ClockFit& fit_;
  std::map<int, EpipolarSystem> systems_;
};

/// A parabola through the costs around the smallest: offset, standard deviation; false where that is no minimum.
bool findMinimum(const ClockFit& fit, int place, Grid& grid, ClockOffset& found) {
  if (std::abs(place) == kSteps) return false;
  const EpipolarSystem& best = grid.at(place);
  const double before = grid.at(place - 1).cost, after = grid.at(place + 1).cost,
               curvature = before + after - 2 * best.cost;
  if (!(curvature > 0)) return false;
  found.offset_s = kStep_s * (place + 0.5 * (before - after) / curvature);
  // cost / variance is a chi-square: its second derivative is twice the information
  found.sigma_s = kStep_s * std::sqrt(2 * fit.variance(best) / curvature);
  return true;
}

/// Standard deviation of the offset over the whole range, each offset weighed by its likelihood. Noise makes the costs
/// of neighbouring offsets differ, so that a parabola fits a minimum into a flat cost.
double spread_s(double variance, double lowest, const Grid& grid) {
  double sum = 0, mean_s = 0, squares = 0;
  const int steps = static_cast<int>(std::lround(kLargestClockOffset_s / kFineStep_s));
  for (int i = -steps; i <= steps; ++i) {
    const double offset_s = i * kFineStep_s, likelihood = std::exp(0.5 * (lowest - grid.between(offset_s)) / variance);
    sum += likelihood;
    mean_s += likelihood * offset_s;
    squares += likelihood * offset_s * offset_s;
  }
  mean_s /= sum;
  return std::sqrt(std::max(0.0, squares / sum - mean_s * mean_s));
}

/// How likely it is that the readout is as given: `other` has another one, which is in the middle of what is likely
/// then.
double shareAsGiven(const ClockOffset& given, const ClockOffset& other) {
  const bool unsynchronised = given.readout_s == 0 && std::abs(given.offset_s) > kUnsynchronised * given.sigma_s;
  const double share = unsynchronised ? kOtherShareUnsynchronised : kOtherShare,
               more_s = other.readout_s - given.readout_s,
               as_given = (1 - share) * normalDensity(more_s, other.readout_sigma_s),
               otherwise = share * normalDensity(more_s, std::hypot(kOtherReadout_s, other.readout_sigma_s));
  return as_given / (as_given + otherwise);
}

/// Offset and readout together: what is likelier, and a standard deviation that covers both where the given readout is
/// not clearly right; else nothing changes.
bool findReadout(int place, ClockFit& fit, ClockOffset& found) {
  fit.freeReadout();
  Grid grid(fit);
  ClockOffset other = found;
  if (!findMinimum(fit, grid.descend(place), grid, other)) return false;
  fit.at(other.offset_s + other.sigma_s);
  const double beside_s = fit.readout_s();
  const EpipolarSystem there = fit.at(other.offset_s);
  other.readout_s = fit.readout_s();
  const double own_sigma_s = std::sqrt(fit.varianceOfRows(there) * there.H.inverse()(3, 3));
  other.readout_sigma_s = std::hypot(own_sigma_s, beside_s - other.readout_s, kLeastReadout_s);
  const double share = shareAsGiven(found, other);
  if (share > kSureAsGiven) return false;
  std::tie(found.offset_s, found.sigma_s) =
      likelierAndSigma(share, found.offset_s, found.sigma_s, other.offset_s, other.sigma_s);
  std::tie(found.readout_s, found.readout_sigma_s) =
      likelierAndSigma(share, found.readout_s, 0, other.readout_s, other.readout_sigma_s);
  return true;
}

}  // namespace

ClockOffset findClockOffset(const std::vector<FrameTracks>& frames, const ImuBatch& imu, const Rig& rig) {
  ClockOffset found;
  found.readout_s = rig.readout_s();
  if (imu.size() < 2) return found;
  const std::vector<TimedPair> pairs = timedPairs(frames, GyroPath(imu), rig);
  if (pairs.size() < kLeastPairs) return found;
  const double focal = rig.camera.meanFocal(), width_rad = kWidth_px / focal;
  ClockFit fit(pairs, imu, rig.readout_s(), width_rad);
  Grid grid(fit);
  const int place = grid.search();
  const auto rmsOf = [focal](const EpipolarSystem& system) { return focal * std::sqrt(system.sum / system.weights); };
  found.rms_px = rmsOf(grid.at(place));
  if (!findMinimum(fit, place, grid, found)) return found;
  const double range_sigma_s = spread_s(fit.variance(grid.at(place)), grid.at(place).cost, grid);
  if (found.sigma_s < kLeastCertain_s && !findReadout(place, fit, found)) fit.holdReadout();
  const EpipolarSystem there = fit.at(found.offset_s);
  found.rms_px = rmsOf(there);
  found.bias_gyro = fit.bias();
  const double still_px = rmsOf(fit.withoutGyro()),
               turn_px = std::sqrt(std::max(0.0, still_px * still_px - found.rms_px * found.rms_px));
  const bool bracketed = std::abs(found.offset_s) + std::max(found.sigma_s, range_sigma_s) <
                         kLargestClockOffset_s;  // costs beyond may be smaller
  found.determined =
      bracketed && range_sigma_s < kMostSpread_s && found.sigma_s < kLeastCertain_s && turn_px > kLeastTurn_px;
  found.sigma_s = std::max(found.sigma_s, range_sigma_s);
  return found;
}

}  // namespace lintel
