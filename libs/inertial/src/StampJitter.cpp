// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/StampJitter.h"

#include <algorithm>
#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr std::size_t kIntervals = 100, kLeastIntervals = 8;
constexpr double kLeastRate = 0.05;        // [rad/s]: slower turns show little of the time
constexpr double kLongest_s = 0.5;         // of an interval: in longer ones the gyroscope's errors count
constexpr double kLeastJitter_s = 0.0007;  // at 1 rad/s a third of a pixel at EuRoC's focal length, what tracks err by
constexpr double kSignificant = 10;        // standard deviations that the variance has where all error is noise
constexpr double kLargest_s = 0.02;

/// Angular rate, acceleration and velocity at one end of an interval: what the residuals change by with its time.
struct EndMotion {
  Eigen::Vector3d omega_b, a_bi, v_bi;  ///< in the body's axes at that end; the other two in those at the start
};

EndMotion motionAt(const InertialState& state, const ImuSample& sample, const InertialState& start,
                   const Preintegration& imu) {
  const Eigen::Quaterniond R_bi_w = start.T_w_b.q.conjugate();
  const Eigen::Vector3d a_w = state.T_w_b.q * (sample.accel - start.bias.accel) + imu.gravityW();
  return {sample.gyro - start.bias.gyro, R_bi_w * a_w, R_bi_w * state.v_w_b};
}

}  // namespace

void StampJitter::add(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  if (imu.samples().size() < 2 || imu.dt_s() <= 0 || imu.dt_s() > kLongest_s) return;
  const auto delta = imu.corrected(from.bias);
  const Eigen::Vector3d omega_i = delta.delta_R.conjugate() * (imu.samples().front().gyro - from.bias.gyro);
  const Eigen::Vector3d omega_j = imu.samples().back().gyro - from.bias.gyro, omega = 0.5 * (omega_i + omega_j);
  const double rate = omega.norm();
  if (!(rate >= kLeastRate)) return;
  const Eigen::Vector3d r = logRotation(delta.delta_R.conjugate() * from.T_w_b.q.conjugate() * to.T_w_b.q);
  if (!r.allFinite()) return;
  Interval interval;
  interval.along = r.dot(omega) / rate;
  interval.across2 = r.squaredNorm() - interval.along * interval.along;
  interval.angle = rate * imu.dt_s();
  interval.rates2 = omega_i.squaredNorm() + omega_j.squaredNorm();
  intervals_.push_back(interval);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
}

double StampJitter::sigma_s() const {
  if (intervals_.size() < kLeastIntervals) return 0;
  double along_angle = 0, angle2 = 0, along2 = 0, across2 = 0, rates2 = 0;
  for (const Interval& i : intervals_) along_angle += i.along * i.angle, angle2 += i.angle * i.angle;
  const double gain = along_angle / angle2;
  for (const Interval& i : intervals_) {
    along2 += std::pow(i.along - gain * i.angle, 2);
    across2 += 0.5 * i.across2;
    rates2 += i.rates2;
  }
  const double variance = (along2 - across2) / rates2;
  // n squares of noise along and 2 n halves of those across, all of the same variance
  const double chance = std::sqrt(3.0 / static_cast<double>(intervals_.size())) * across2 / rates2;
  if (variance < std::max(kLeastJitter_s * kLeastJitter_s, kSignificant * chance)) return 0;
  return std::min(std::sqrt(variance), kLargest_s);
}

void countStampJitter(double sigma_s, const InertialState& from, const InertialState& to, Preintegration& imu) {
  if (!(sigma_s > 0) || imu.samples().size() < 2) return imu.setStampNoise(0, Preintegration::Matrix9::Zero());
  const EndMotion i = motionAt(from, imu.samples().front(), from, imu),
                  j = motionAt(to, imu.samples().back(), from, imu);
  const auto delta = imu.corrected(from.bias);
  Eigen::Matrix<double, 9, 2> by_times;
  by_times.col(0) << -(delta.delta_R.conjugate() * i.omega_b), -i.a_bi - i.omega_b.cross(delta.delta_v),
      -i.v_bi - i.a_bi * imu.dt_s() - i.omega_b.cross(delta.delta_p);
  by_times.col(1) << j.omega_b, j.a_bi, j.v_bi;
  imu.setStampNoise(sigma_s, sigma_s * sigma_s * by_times * by_times.transpose());
}

}  // namespace lintel
