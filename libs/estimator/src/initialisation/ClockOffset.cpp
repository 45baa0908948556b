// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/ClockOffset.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "initialisation/EpipolarRotation.h"
#include "lintel/geometry/SmallMatrices.h"
#include "lintel/inertial/GyroPath.h"

namespace lintel {

namespace {

constexpr int kSteps = 20;  // of the grid, to either side: 5 ms, much less than a turn takes
constexpr double kStep_s = kLargestClockOffset_s / kSteps;
constexpr int kCoarse = 4;                 // steps at first, 20 ms: a fifth of the period of a hand that shakes
constexpr double kLeastCertain_s = 0.012;  // the range is sixteen times as wide
constexpr double kLeastTurn_px = 0.3;      // a turn that moves points by less than tracks err shows no offset
constexpr double kWidth_px = 2;            // of the robust loss
constexpr std::size_t kMostRays = 30;      // of a pair
constexpr std::size_t kLeastRays = 12;
constexpr std::size_t kLeastPairs = 10;
constexpr double kGaps_s[] = {0.1, 0.3};  // between the frames of a pair

std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

struct TimedPair {
  std::int64_t a_ns = 0, b_ns = 0;
  FramePair pair;
};

/// Points that both frames see, evenly chosen.
void addRays(const FrameTracks& a, const FrameTracks& b, const Eigen::Quaterniond& R_b_c, FramePair& pair) {
  std::vector<std::pair<std::size_t, std::size_t>> common;
  for (std::size_t i = 0, k = 0; i < a.points.size() && k < b.points.size();) {
    if (a.points[i].id == b.points[k].id) common.emplace_back(i, k);
    a.points[i].id <= b.points[k].id ? ++i : ++k;
  }
  const std::size_t step = std::max<std::size_t>(1, (common.size() + kMostRays - 1) / kMostRays);
  for (std::size_t i = 0; i < common.size(); i += step)
    pair.rays.emplace_back(R_b_c * a.points[common[i].first].ray.normalized(),
                           R_b_c * b.points[common[i].second].ray.normalized());
}

std::vector<TimedPair> timedPairs(const std::vector<FrameTracks>& frames, const GyroPath& path, const Rig& rig) {
  const std::int64_t margin = nanoseconds(kLargestClockOffset_s + kStep_s);
  std::vector<TimedPair> pairs;
  for (const double gap_s : kGaps_s)
    for (std::size_t a = 0, b = 0; a < frames.size(); ++a) {
      while (b < frames.size() && frames[b].t_ns - frames[a].t_ns < nanoseconds(0.9 * gap_s)) ++b;
      if (b >= frames.size() || frames[b].t_ns - frames[a].t_ns > nanoseconds(2 * gap_s)) continue;
      TimedPair timed{frames[a].t_ns, frames[b].t_ns, {}};
      if (!path.covers(timed.a_ns - margin, timed.b_ns + margin)) continue;
      timed.pair.d_theta_d_bias = -1e-9 * static_cast<double>(timed.b_ns - timed.a_ns) * Eigen::Matrix3d::Identity();
      addRays(frames[a], frames[b], rig.T_b_c.q, timed.pair);
      if (timed.pair.rays.size() >= kLeastRays) pairs.push_back(std::move(timed));
    }
  return pairs;
}

/// How well a clock offset fits; the bias is where the search has come to.
class Fit {
 public:
  Fit(const std::vector<TimedPair>& pairs, const GyroPath& path, double width_rad)
      : pairs_(pairs), path_(path), width_rad_(width_rad) {
    for (const TimedPair& pair : pairs) turned_.push_back(pair.pair);
  }

  EpipolarSystem at(double offset_s) {
    const std::int64_t offset = nanoseconds(offset_s);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      turned_[i].R_a_b = path_.at(pairs_[i].a_ns + offset).conjugate() * path_.at(pairs_[i].b_ns + offset);
    EpipolarSystem system;
    for (int round = 0; round < 3; ++round) {
      system = epipolarSystem(turned_, bias_, width_rad_);
      if (round < 2) bias_ -= solveLdlt(system.H, system.b);
    }
    return system;
  }

  const Eigen::Vector3d& bias() const { return bias_; }

  EpipolarSystem withoutGyro() {
    for (FramePair& pair : turned_) pair.R_a_b.setIdentity();
    return epipolarSystem(turned_, Eigen::Vector3d::Zero(), width_rad_);
  }

 private:
  const std::vector<TimedPair>& pairs_;
  const GyroPath& path_;
  double width_rad_;
  std::vector<FramePair> turned_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
};

/// Evaluates the grid coarsely, then every step around the smallest cost; its place.
int searchGrid(Fit& fit, std::map<int, EpipolarSystem>& grid) {
  const auto evaluate = [&](int k) {
    if (grid.count(k) == 0) grid[k] = fit.at(k * kStep_s);
  };
  const auto smallest = [&grid] {
    return std::min_element(grid.begin(), grid.end(),
                            [](const auto& x, const auto& y) { return x.second.cost < y.second.cost; })
        ->first;
  };
  for (int k = -kSteps; k <= kSteps; k += kCoarse) evaluate(k);
  const int coarse = smallest();
  for (int k = std::max(-kSteps, coarse - kCoarse); k <= std::min(kSteps, coarse + kCoarse); ++k) evaluate(k);
  return smallest();
}

}  // namespace

ClockOffset findClockOffset(const std::vector<FrameTracks>& frames, const ImuBatch& imu, const Rig& rig) {
  ClockOffset found;
  if (imu.size() < 2) return found;
  const GyroPath path(imu);
  const std::vector<TimedPair> pairs = timedPairs(frames, path, rig);
  if (pairs.size() < kLeastPairs) return found;
  const double focal = rig.camera.meanFocal(), width_rad = kWidth_px / focal;
  Fit fit(pairs, path, width_rad);
  std::map<int, EpipolarSystem> grid;  // by steps
  const int best_at = searchGrid(fit, grid);
  const EpipolarSystem& best = grid.at(best_at);
  found.rms_px = focal * std::sqrt(best.sum / best.weights);
  if (std::abs(best_at) == kSteps) return found;
  const double before = grid.at(best_at - 1).cost, after = grid.at(best_at + 1).cost,
               curvature = before + after - 2 * best.cost;
  if (!(curvature > 0)) return found;
  found.offset_s = kStep_s * (best_at + 0.5 * (before - after) / curvature);
  // cost / variance is a chi-square: its second derivative is twice the information. Points of one frame share errors
  // (rolling shutter, calibration): a pair counts as one observation, not every ray.
  const double rays = best.weights / static_cast<double>(pairs.size());
  const double variance = best.sum / best.weights * rays;
  found.sigma_s = kStep_s * std::sqrt(2 * variance / curvature);
  const EpipolarSystem there = fit.at(found.offset_s);
  found.bias_gyro = fit.bias();
  const EpipolarSystem still = fit.withoutGyro();
  found.rms_still_px = focal * std::sqrt(still.sum / still.weights);
  found.bias_gyro_sigma = (variance * there.H.inverse()).diagonal().cwiseSqrt();
  const double turn_px =
      std::sqrt(std::max(0.0, found.rms_still_px * found.rms_still_px - found.rms_px * found.rms_px));
  found.determined = found.sigma_s < kLeastCertain_s && turn_px > kLeastTurn_px;
  return found;
}

}  // namespace lintel
