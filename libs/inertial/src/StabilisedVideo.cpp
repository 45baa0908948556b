// SPDX-License-Identifier: BSD-3-Clause
#include "StabilisedVideo.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/GyroPath.h"

namespace lintel {

namespace {

constexpr double kSlow_s = 1.5;  // turns over less are what stabilisation takes away
constexpr double kMostOffset_s = 0.1, kOffsetStep_s = 0.02;
constexpr std::size_t kLeastTurns = 100;  // five seconds at 20 Hz
constexpr int kSolves = 4;
constexpr double kLossWidth = 2;  // of the Cauchy loss, in standard deviations
constexpr double kFollows = 0.6;  // least share of slow turns that is seen: with a focal length too short by a third
constexpr double kLess = 0.7;     // largest share of fast turns that is seen, of that of slow ones
constexpr double kSure = 4;       // standard deviations of both
// White noise of the gyroscope makes the share of fast turns smaller by about its part in them.
constexpr double kMostNoise = 0.1;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// y = slow s + fast (x - s) + bias dt, with the gyroscope's turn x and what it would be at the mean rate of kSlow_s,
/// s.
struct TurnSample {
  Eigen::Vector3d y, sigma, slow, fast;
  double dt;
};

/// How much of slow and fast turns of the gyroscope the images show.
struct TurnShares {
  double slow = 0, fast = 0, sigma_slow = 0, sigma_fast = 0;
  double missed =
      std::numeric_limits<double>::infinity();  ///< median error, in standard deviations of the images' turns
};

std::vector<TurnSample> samplesOf(const GyroPath& path, const Eigen::Quaterniond& R_b_c,
                                  const std::vector<CameraTurn>& turns, double offset_s) {
  const auto ns = [](double s) { return static_cast<std::int64_t>(std::llround(1e9 * s)); };
  std::vector<TurnSample> samples;
  for (const CameraTurn& turn : turns) {
    const std::int64_t from_ns = turn.from_ns + ns(offset_s), to_ns = turn.to_ns + ns(offset_s);
    const std::int64_t middle_ns = from_ns + (to_ns - from_ns) / 2, half_ns = ns(0.5 * kSlow_s);
    if (!path.covers(middle_ns - half_ns, middle_ns + half_ns)) continue;
    const Eigen::Quaterniond before = path.at(middle_ns - half_ns), to_camera = path.at(from_ns) * R_b_c;
    TurnSample sample;
    sample.dt = 1e-9 * static_cast<double>(to_ns - from_ns);
    const Eigen::Vector3d over = before * logRotation(before.conjugate() * path.at(middle_ns + half_ns));
    sample.slow = to_camera.conjugate() * over * (sample.dt / kSlow_s);
    sample.fast = R_b_c.conjugate() * logRotation(path.at(from_ns).conjugate() * path.at(to_ns)) - sample.slow;
    sample.y = turn.rotation, sample.sigma = turn.sigma.cwiseMax(5e-4);
    samples.push_back(sample);
  }
  return samples;
}

Vector5 rowOf(const TurnSample& s, int axis) {
  Vector5 row = Vector5::Zero();
  row[0] = s.slow[axis], row[1] = s.fast[axis], row[2 + axis] = s.dt;
  return row;
}

/// Of all samples and axes, in standard deviations of the images' turns.
std::vector<double> errorsOf(const std::vector<TurnSample>& samples, const Vector5& parameters) {
  std::vector<double> errors;
  for (const TurnSample& s : samples)
    for (int axis = 0; axis < 3; ++axis)
      errors.push_back(std::abs(s.y[axis] - rowOf(s, axis).dot(parameters)) / s.sigma[axis]);
  return errors;
}

TurnShares sharesOf(const std::vector<TurnSample>& samples) {
  Vector5 parameters = Vector5::Zero();
  Matrix5 covariance = Matrix5::Zero();
  TurnShares shares;
  double scale = std::numeric_limits<double>::infinity();  // of the errors: everything counts at first
  for (int solve = 0; solve < kSolves; ++solve) {
    Matrix5 H = 1e-9 * Matrix5::Identity();
    Vector5 b = Vector5::Zero();
    for (const TurnSample& s : samples)
      for (int axis = 0; axis < 3; ++axis) {
        const Vector5 row = rowOf(s, axis);
        const double r = (s.y[axis] - row.dot(parameters)) / s.sigma[axis] / (kLossWidth * scale);
        const double weight = 1 / ((1 + r * r) * s.sigma[axis] * s.sigma[axis]);
        H += weight * row * row.transpose();
        b += weight * s.y[axis] * row;
      }
    const Matrix5 inverse = H.inverse();
    parameters = inverse * b;
    std::vector<double> errors = errorsOf(samples, parameters);
    shares.missed = median(errors);
    scale = std::max(1.0, 1.48 * shares.missed);
    covariance = scale * scale * inverse;
  }
  shares.slow = parameters[0], shares.fast = parameters[1];
  shares.sigma_slow = std::sqrt(covariance(0, 0)), shares.sigma_fast = std::sqrt(covariance(1, 1));
  return shares;
}

/// The part of the gyroscope's noise in the mean square of fast turns, if all that differs between a sample and the
/// mean of its neighbours were white noise.
double noiseIn(const ImuBatch& imu, const std::vector<TurnSample>& samples) {
  double differences2 = 0, turns2 = 0, dt = 0;
  for (std::size_t i = 1; i + 1 < imu.size(); ++i)
    differences2 += (imu[i].gyro - 0.5 * (imu[i - 1].gyro + imu[i + 1].gyro)).squaredNorm() / 1.5;
  for (const TurnSample& s : samples) turns2 += s.fast.squaredNorm(), dt += s.dt;
  const auto n = static_cast<double>(imu.size());
  const double period_s = 1e-9 * static_cast<double>(imu.back().t_ns - imu.front().t_ns) / n;
  return differences2 / n * period_s * dt / turns2;
}

}  // namespace

std::string stabilisationFault(const ImuBatch& imu, const Eigen::Quaterniond& R_b_c,
                               const std::vector<CameraTurn>& turns) {
  const GyroPath path(imu);
  TurnShares best;
  double noise = 1;
  for (double offset_s = -kMostOffset_s; offset_s < kMostOffset_s + 1e-9; offset_s += kOffsetStep_s) {
    const std::vector<TurnSample> samples = samplesOf(path, R_b_c, turns, offset_s);
    if (samples.size() < kLeastTurns) continue;
    const TurnShares shares = sharesOf(samples);
    if (shares.missed < best.missed) best = shares, noise = noiseIn(imu, samples);
  }
  if (!(noise < kMostNoise)) return {};
  if (!(best.slow - kSure * best.sigma_slow > kFollows)) return {};
  if (!(best.fast + kSure * best.sigma_fast < kLess * best.slow)) return {};
  return formatted(
      "the images seem to be stabilised: over seconds they turn as the gyroscope does (%.2f times as much), within "
      "tenths of a second less (%.2f times): record without image stabilisation, and without a gimbal between camera "
      "and IMU",
      best.slow, best.fast);
}

}  // namespace lintel
