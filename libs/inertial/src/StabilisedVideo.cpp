// SPDX-License-Identifier: BSD-3-Clause
#include "StabilisedVideo.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr double kSlow_s = 1.5;  // turns over less are what stabilisation takes away
constexpr double kMostOffset_s = 0.1, kOffsetStep_s = 0.02;
constexpr std::size_t kLeastTurns = 100;  // five seconds at 20 Hz
constexpr int kSolves = 4;
constexpr double kLossWidth = 2;          // of the Cauchy loss, in standard deviations
constexpr double kFollows = 0.6;          // of the slow turns: a focal length that is wrong, and slow stabilisation
constexpr double kLess = 0.7, kSure = 4;  // of fast turns to slow ones; standard deviations

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

TurnShares sharesOf(const std::vector<TurnSample>& samples) {
  Vector5 parameters = Vector5::Zero();
  Matrix5 covariance = Matrix5::Zero();
  TurnShares shares;
  double scale = 0;  // of the standard deviations; 0: everything counts at first
  for (int solve = 0; solve < kSolves; ++solve) {
    Matrix5 H = 1e-9 * Matrix5::Identity();
    Vector5 b = Vector5::Zero();
    std::vector<double> errors;
    for (int pass = 0; pass < 2; ++pass) {
      for (const TurnSample& s : samples)
        for (int axis = 0; axis < 3; ++axis) {
          Vector5 x = Vector5::Zero();
          x[0] = s.slow[axis], x[1] = s.fast[axis], x[2 + axis] = s.dt;
          const double e = (s.y[axis] - x.dot(parameters)) / s.sigma[axis];
          if (pass == 1) {
            errors.push_back(std::abs(e));
            continue;
          }
          const double r = scale > 0 ? e / (kLossWidth * scale) : 0;
          const double weight = 1 / ((1 + r * r) * s.sigma[axis] * s.sigma[axis]);
          H += weight * x * x.transpose();
          b += weight * s.y[axis] * x;
        }
      if (pass == 0) parameters = H.ldlt().solve(b);
    }
    shares.missed = median(errors);
    scale = std::max(1.0, 1.48 * shares.missed);
    covariance = scale * scale * H.inverse();
  }
  shares.slow = parameters[0], shares.fast = parameters[1];
  shares.sigma_slow = std::sqrt(covariance(0, 0)), shares.sigma_fast = std::sqrt(covariance(1, 1));
  return shares;
}

}  // namespace

std::string stabilisationFault(const GyroPath& path, const Eigen::Quaterniond& R_b_c,
                               const std::vector<CameraTurn>& turns) {
  TurnShares best;
  for (double offset_s = -kMostOffset_s; offset_s < kMostOffset_s + 1e-9; offset_s += kOffsetStep_s) {
    const std::vector<TurnSample> samples = samplesOf(path, R_b_c, turns, offset_s);
    if (samples.size() < kLeastTurns) continue;
    if (const TurnShares shares = sharesOf(samples); shares.missed < best.missed) best = shares;
  }
  if (!(best.slow - kSure * best.sigma_slow > kFollows)) return {};
  if (!(best.fast + kSure * best.sigma_fast < kLess * best.slow)) return {};
  return formatted(
      "the images seem to be stabilised: over seconds they turn as the gyroscope does (%.2f times as much), within "
      "tenths of a second less (%.2f times): record without image stabilisation, and without a gimbal between camera "
      "and IMU",
      best.slow, best.fast);
}

}  // namespace lintel
