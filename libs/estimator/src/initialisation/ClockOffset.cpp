// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/ClockOffset.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "initialisation/EpipolarRotation.h"
#include "lintel/factors/RowMotion.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"
#include "lintel/inertial/GyroPath.h"

namespace lintel {

namespace {

constexpr int kSteps = 20;  // of the grid, to either side: 5 ms, much less than a turn takes
constexpr double kStep_s = kLargestClockOffset_s / kSteps;
constexpr int kCoarse = 4;                 // steps at first, 20 ms: a fifth of the period of a hand that shakes
constexpr double kLeastCertain_s = 0.025;  // the range is eight times as wide
constexpr double kLeastTurn_px = 0.3;      // a turn that moves points by less than tracks err shows no offset
constexpr double kWidth_px = 2;            // of the robust loss
constexpr std::size_t kMostRays = 30;      // of a pair
constexpr std::size_t kLeastRays = 12;
constexpr std::size_t kLeastPairs = 10;
constexpr double kGaps_s[] = {0.1, 0.3};  // between the frames of a pair
constexpr double kRateHalf_s = 0.005;     // of the span that a rate is taken over
constexpr double kOtherReadout_s = 0.02;  // standard deviation, where the given readout is wrong, and how often that
constexpr double kOtherShare = 0.1, kOtherShareUnsynchronised = 0.5;  // is so: cameras without a trigger often roll
constexpr double kUnsynchronised = 4;                                 // standard deviations of the offset
constexpr double kSureShare = 0.8;                                    // from which the given readout is kept
constexpr double kLeastReadout_s = 0.002;  // standard deviation: the sum of what the model leaves out
constexpr double kLongestReadout_s = 0.05;

std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

struct TimedPair {
  std::int64_t a_ns = 0, b_ns = 0;
  FramePair pair;
  std::vector<std::pair<double, double>> rows;  // of the rays: shares of the readout after a and b
};

/// Points that both frames see, evenly chosen.
void addRays(const FrameTracks& a, const FrameTracks& b, const Rig& rig, TimedPair& timed) {
  std::vector<std::pair<std::size_t, std::size_t>> common;
  for (std::size_t i = 0, k = 0; i < a.points.size() && k < b.points.size();) {
    if (a.points[i].id == b.points[k].id) common.emplace_back(i, k);
    a.points[i].id <= b.points[k].id ? ++i : ++k;
  }
  const std::size_t step = std::max<std::size_t>(1, (common.size() + kMostRays - 1) / kMostRays);
  for (std::size_t i = 0; i < common.size(); i += step) {
    const PointObservation &in_a = a.points[common[i].first], &in_b = b.points[common[i].second];
    timed.pair.rays.emplace_back(rig.T_b_c.q * in_a.ray.normalized(), rig.T_b_c.q * in_b.ray.normalized());
    timed.rows.emplace_back(rowShare(rig.camera, in_a.px), rowShare(rig.camera, in_b.px));
  }
}

std::vector<TimedPair> timedPairs(const std::vector<FrameTracks>& frames, const GyroPath& path, const Rig& rig) {
  const std::int64_t margin = nanoseconds(kLargestClockOffset_s + kStep_s + 0.5 * kLongestReadout_s);
  std::vector<TimedPair> pairs;
  for (const double gap_s : kGaps_s)
    for (std::size_t a = 0, b = 0; a < frames.size(); ++a) {
      while (b < frames.size() && frames[b].t_ns - frames[a].t_ns < nanoseconds(0.9 * gap_s)) ++b;
      if (b >= frames.size() || frames[b].t_ns - frames[a].t_ns > nanoseconds(2 * gap_s)) continue;
      TimedPair timed{frames[a].t_ns, frames[b].t_ns, {}, {}};
      if (!path.covers(timed.a_ns - margin, timed.b_ns + margin)) continue;
      timed.pair.d_theta_d_bias = -1e-9 * static_cast<double>(timed.b_ns - timed.a_ns) * Eigen::Matrix3d::Identity();
      addRays(frames[a], frames[b], rig, timed);
      if (timed.pair.rays.size() >= kLeastRays) pairs.push_back(std::move(timed));
    }
  return pairs;
}

/// How many pairs of the same length cover a moment, on average.
double overlap(const std::vector<TimedPair>& pairs) {
  double covered_ns = 0;
  std::int64_t first_ns = pairs.front().a_ns, last_ns = first_ns;
  for (const TimedPair& pair : pairs) {
    covered_ns += static_cast<double>(pair.b_ns - pair.a_ns);
    first_ns = std::min(first_ns, pair.a_ns), last_ns = std::max(last_ns, pair.b_ns);
  }
  return std::max(1.0, covered_ns / static_cast<double>(last_ns - first_ns) / std::size(kGaps_s));
}

/// How a frame's rays turn into its time.
class Unrolling {
 public:
  Unrolling(const GyroPath& path, std::int64_t t_ns) : path_(path), t_ns_(t_ns), R_b0_b_(path.at(t_ns)) {
    const std::int64_t half = nanoseconds(kRateHalf_s);
    omega_b_ = logRotation(path.at(t_ns - half).conjugate() * path.at(t_ns + half)) / (2 * kRateHalf_s);
  }

  /// The rotation from the body when the row was exposed to that at the frame's time.
  Eigen::Quaterniond turn(double row_s) const { return R_b0_b_.conjugate() * path_.at(t_ns_ + nanoseconds(row_s)); }
  const Eigen::Vector3d& omega_b() const { return omega_b_; }

 private:
  const GyroPath& path_;
  std::int64_t t_ns_;
  Eigen::Quaterniond R_b0_b_;
  Eigen::Vector3d omega_b_;
};

/// How well a clock offset fits; the bias, and the readout where it is free, are where the search has come to.
class Fit {
 public:
  Fit(const std::vector<TimedPair>& pairs, const GyroPath& path, double readout_s, double width_rad)
      : pairs_(pairs), path_(path), given_s_(readout_s), width_rad_(width_rad), overlap_(overlap(pairs)) {
    holdReadout();
  }

  void freeReadout() { free_ = true; }

  void holdReadout() {
    free_ = false, readout_s_ = given_s_;
    turned_.clear();
    for (const TimedPair& pair : pairs_) turned_.push_back(pair.pair);
  }

  EpipolarSystem at(double offset_s) {
    EpipolarSystem system;
    for (int round = 0; round < 3; ++round) {
      if (round == 0 || free_) turn(nanoseconds(offset_s));
      system = epipolarSystem(turned_, bias_, width_rad_);
      if (free_) addPrior(system);
      if (round < 2) step(solveLdlt(system.H, system.b));
    }
    return system;
  }

  /// Of a residual for what all rows of a frame share. The points of one frame share errors (calibration): a pair
  /// counts as one observation, not every ray; pairs that overlap share the gyroscope's noise, and count as one.
  double variance(const EpipolarSystem& system) const { return overlap_ * varianceOfRows(system); }

  /// For what differs between the rows of a frame, which the gyroscope's noise does not.
  double varianceOfRows(const EpipolarSystem& system) const { return system.sum / static_cast<double>(pairs_.size()); }

  const Eigen::Vector3d& bias() const { return bias_; }
  double readout_s() const { return readout_s_; }

  EpipolarSystem withoutGyro() {
    for (FramePair& pair : turned_) pair.R_a_b.setIdentity();
    return epipolarSystem(turned_, Eigen::Vector3d::Zero(), width_rad_);
  }

 private:
  void turn(std::int64_t offset_ns) {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const std::int64_t a_ns = pairs_[i].a_ns + offset_ns, b_ns = pairs_[i].b_ns + offset_ns;
      turned_[i].R_a_b = path_.at(a_ns).conjugate() * path_.at(b_ns);
      if (free_ || readout_s_ != 0) unroll(pairs_[i], {path_, a_ns}, {path_, b_ns}, turned_[i]);
    }
  }

  void unroll(const TimedPair& timed, const Unrolling& in_a, const Unrolling& in_b, FramePair& turned) const {
    turned.d_rays_d_readout.clear();
    for (std::size_t i = 0; i < timed.rows.size(); ++i) {
      const auto& [row_a, row_b] = timed.rows[i];
      const auto& [ray_a, ray_b] = timed.pair.rays[i];
      const Eigen::Quaterniond turn_a = in_a.turn(row_a * readout_s_), turn_b = in_b.turn(row_b * readout_s_);
      turned.rays[i] = {turn_a * ray_a, turn_b * ray_b};
      if (free_)
        turned.d_rays_d_readout.emplace_back(turn_a * (row_a * in_a.omega_b().cross(ray_a)),
                                             turn_b * (row_b * in_b.omega_b().cross(ray_b)));
    }
  }

  void addPrior(EpipolarSystem& system) const {
    const double weight = varianceOfRows(system) / (kOtherReadout_s * kOtherReadout_s);
    system.H(3, 3) += weight;
    system.b(3) += weight * (readout_s_ - given_s_);
  }

  void step(const Eigen::Vector4d& change) {
    bias_ -= change.head<3>();
    if (free_) readout_s_ = std::clamp(readout_s_ - change(3), -kLongestReadout_s, kLongestReadout_s);
  }

  const std::vector<TimedPair>& pairs_;
  const GyroPath& path_;
  double given_s_, width_rad_, overlap_, readout_s_ = 0;
  bool free_ = false;
  std::vector<FramePair> turned_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
};

/// Costs by steps of the offset.
class Grid {
 public:
  explicit Grid(Fit& fit) : fit_(fit) {}

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

  Fit& fit_;
  std::map<int, EpipolarSystem> systems_;
};

/// A parabola through the costs around the smallest: offset, standard deviation; false where that is no minimum.
bool findMinimum(const Fit& fit, int place, Grid& grid, ClockOffset& found) {
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

/// How likely a value is that is off by x, of a normal distribution, but for a common factor.
double likelihood(double x, double sigma) { return std::exp(-0.5 * x * x / (sigma * sigma)) / sigma; }

/// How likely it is that the readout is as given: `other` has another one, which is in the middle of what is likely
/// then.
double shareAsGiven(const ClockOffset& given, const ClockOffset& other) {
  const bool unsynchronised = given.readout_s == 0 && std::abs(given.offset_s) > kUnsynchronised * given.sigma_s;
  const double share = unsynchronised ? kOtherShareUnsynchronised : kOtherShare,
               more_s = other.readout_s - given.readout_s,
               as_given = (1 - share) * likelihood(more_s, other.readout_sigma_s),
               otherwise = share * likelihood(more_s, std::hypot(kOtherReadout_s, other.readout_sigma_s));
  return as_given / (as_given + otherwise);
}

/// Offset and readout together: what is likelier, and a standard deviation that covers both where the given readout is
/// not clearly right; else nothing changes.
bool findReadout(int place, Fit& fit, ClockOffset& found) {
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
  if (share > kSureShare) return false;
  std::tie(found.offset_s, found.sigma_s) =
      likelierAndSigma(share, found.offset_s, found.sigma_s, other.offset_s, other.sigma_s);
  std::tie(found.readout_s, found.readout_sigma_s) =
      likelierAndSigma(share, found.readout_s, 0, other.readout_s, other.readout_sigma_s);
  return true;
}

}  // namespace

std::pair<double, double> likelierAndSigma(double share_a, double a, double sigma_a, double b, double sigma_b) {
  if (share_a < 0.5) return likelierAndSigma(1 - share_a, b, sigma_b, a, sigma_a);
  return {a, std::sqrt(share_a * sigma_a * sigma_a + (1 - share_a) * (sigma_b * sigma_b + (a - b) * (a - b)))};
}

ClockOffset findClockOffset(const std::vector<FrameTracks>& frames, const ImuBatch& imu, const Rig& rig) {
  ClockOffset found;
  found.readout_s = rig.readout_s();
  if (imu.size() < 2) return found;
  const GyroPath path(imu);
  const std::vector<TimedPair> pairs = timedPairs(frames, path, rig);
  if (pairs.size() < kLeastPairs) return found;
  const double focal = rig.camera.meanFocal(), width_rad = kWidth_px / focal;
  Fit fit(pairs, path, rig.readout_s(), width_rad);
  Grid grid(fit);
  const int place = grid.search();
  const auto rmsOf = [focal](const EpipolarSystem& system) { return focal * std::sqrt(system.sum / system.weights); };
  found.rms_px = rmsOf(grid.at(place));
  if (!findMinimum(fit, place, grid, found)) return found;
  if (found.sigma_s < kLeastCertain_s && !findReadout(place, fit, found)) fit.holdReadout();
  const EpipolarSystem there = fit.at(found.offset_s);
  found.rms_px = rmsOf(there);
  found.bias_gyro = fit.bias();
  found.bias_gyro_sigma = (fit.variance(there) * there.H.inverse()).diagonal().head<3>().cwiseSqrt();
  found.rms_still_px = rmsOf(fit.withoutGyro());
  const double turn_px =
      std::sqrt(std::max(0.0, found.rms_still_px * found.rms_still_px - found.rms_px * found.rms_px));
  found.determined = found.sigma_s < kLeastCertain_s && turn_px > kLeastTurn_px;
  return found;
}

}  // namespace lintel
