// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/ClockFit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lintel/estimator/ClockOffset.h"
#include "lintel/factors/RowMotion.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr std::size_t kMostRays = 30;  // of a pair
constexpr std::size_t kLeastRays = 12;
constexpr double kGaps_s[] = {0.1, 0.3};  // between the frames of a pair
constexpr double kMore_s = 0.005;         // beyond the largest offset, where minima are bracketed
constexpr double kRateHalf_s = 0.005;     // of the span that a rate is taken over
constexpr double kLongestReadout_s = 0.05;
// Of an adjustment of the bias. In pairs of 0.3 s a change of the last moves far points by a hundredth of a pixel.
constexpr int kMostSteps = 20;
constexpr double kSettled_rad_s = 1e-4;

std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

double longestReadout_s(double given_s) { return std::max(kLongestReadout_s, std::abs(given_s)); }

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

/// Turns the rays of a pair to their frames' times; with the derivatives by the readout where it is free.
void unroll(const TimedPair& timed, const Unrolling& in_a, const Unrolling& in_b, double readout_s, bool free,
            FramePair& turned) {
  turned.d_rays_d_readout.clear();
  for (std::size_t i = 0; i < timed.rows.size(); ++i) {
    const auto& [row_a, row_b] = timed.rows[i];
    const auto& [ray_a, ray_b] = timed.pair.rays[i];
    const Eigen::Quaterniond turn_a = in_a.turn(row_a * readout_s), turn_b = in_b.turn(row_b * readout_s);
    turned.rays[i] = {turn_a * ray_a, turn_b * ray_b};
    if (free)
      turned.d_rays_d_readout.emplace_back(turn_a * (row_a * in_a.omega_b().cross(ray_a)),
                                           turn_b * (row_b * in_b.omega_b().cross(ray_b)));
  }
}

}  // namespace

std::vector<TimedPair> timedPairs(const std::vector<FrameTracks>& frames, const GyroPath& path, const Rig& rig) {
  const std::int64_t margin = nanoseconds(kLargestClockOffset_s + kMore_s + 0.5 * longestReadout_s(rig.readout_s()));
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

ClockFit::ClockFit(const std::vector<TimedPair>& pairs, const ImuBatch& imu, double readout_s, double width_rad)
    : pairs_(pairs), imu_(imu), given_s_(readout_s), width_rad_(width_rad), overlap_(overlap(pairs)) {
  holdReadout();
}

void ClockFit::holdReadout() {
  free_ = false, readout_s_ = given_s_;
  turned_.clear();
  for (const TimedPair& pair : pairs_) turned_.push_back(pair.pair);
}

EpipolarSystem ClockFit::at(double offset_s) {
  for (int steps = 0;; ++steps) {
    turn(nanoseconds(offset_s));
    EpipolarSystem system = epipolarSystem(turned_, Eigen::Vector3d::Zero(), width_rad_);
    if (free_) addPrior(system);
    const Eigen::Vector4d change = solveLdlt(system.H, system.b);
    if (steps == kMostSteps || change.head<3>().norm() < kSettled_rad_s) return system;
    step(change);
  }
}

EpipolarSystem ClockFit::withoutGyro() {
  for (FramePair& pair : turned_) pair.R_a_b.setIdentity();
  return epipolarSystem(turned_, Eigen::Vector3d::Zero(), width_rad_);
}

/// With the bias in the path: what it turns depends on how the body turns meanwhile, and on the rows' times.
void ClockFit::turn(std::int64_t offset_ns) {
  const GyroPath path(imu_, bias_);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::int64_t a_ns = pairs_[i].a_ns + offset_ns, b_ns = pairs_[i].b_ns + offset_ns;
    turned_[i].R_a_b = path.at(a_ns).conjugate() * path.at(b_ns);
    if (free_ || readout_s_ != 0) unroll(pairs_[i], {path, a_ns}, {path, b_ns}, readout_s_, free_, turned_[i]);
  }
}

void ClockFit::addPrior(EpipolarSystem& system) const {
  const double weight = varianceOfRows(system) / (kOtherReadout_s * kOtherReadout_s);
  system.H(3, 3) += weight;
  system.b(3) += weight * (readout_s_ - given_s_);
}

void ClockFit::step(const Eigen::Vector4d& change) {
  bias_ -= change.head<3>();
  const double longest_s = longestReadout_s(given_s_);
  if (free_) readout_s_ = std::clamp(readout_s_ - change(3), -longest_s, longest_s);
}

}  // namespace lintel
