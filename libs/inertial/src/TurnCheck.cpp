// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/TurnCheck.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "StabilisedVideo.h"
#include "TurnFault.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"
#include "lintel/inertial/GyroPath.h"

namespace lintel {

namespace {

constexpr std::size_t kMostTurns = 12000;  // ten minutes at 20 Hz
constexpr int kEnoughVisible = 1200;       // a minute
constexpr double kSyncNoise_rad = 5e-4;    // of a step: exposure, timing, noise of the gyroscope
constexpr double kVisible = 4;             // standard deviations
constexpr int kLeastCompared = 60;         // visible turns: three seconds at 20 Hz
constexpr double kSilent_rad_s = 1e-3;     // less than any gyroscope's noise: values that do not change
// What is visible is at least four standard deviations: noise leaves a sixth of it open at most (median, 0.67 / 4), and
// two things that have nothing to do with one another all of it.
constexpr double kNoiseMisses = 0.17, kLargestMissed = 0.5;
constexpr double kUnrelatedMisses = 0.8;  // of turns that have nothing in common it is 1
constexpr double kClearlyLess = 0.5;
constexpr double kShown = 10;  // standard deviations of an entry of M: noise alone reaches 3, the right offset 100
constexpr double kSearchedBefore_s = 0.1;  // by ClockOffset, before the start
constexpr double kLongestSearch_s = 10, kShareOfSpan = 0.5, kSearchStep_s = 0.04;
constexpr int kRounds = 4;
constexpr double kWidth = 3;  // of the robust loss, in standard deviations

struct Sample {
  Eigen::Vector4d x;  // the gyroscope's turn, axes of the camera; duration
  Eigen::Vector3d y, sigma;
};

bool tells(const TurnFit& fit) { return fit.compared >= kLeastCompared; }

/// Whether the images' turns depend on the gyroscope's at all.
bool related(const TurnFit& fit) { return (fit.M.array().abs() > kShown * fit.sigma.array()).any(); }

/// Whether the camera turns visibly about an axis, and goes on to or did before: wrong turns come one by one.
bool turns(const std::vector<Sample>& samples, std::size_t k, int axis, double bias) {
  const auto turned = [&](std::size_t i) {
    const double angle = samples[i].y[axis] - bias * samples[i].x[3];
    return std::abs(angle) > kVisible * samples[i].sigma[axis] ? angle : 0;
  };
  const double now = turned(k);
  return (k > 0 && turned(k - 1) * now > 0) || (k + 1 < samples.size() && turned(k + 1) * now > 0);
}

}  // namespace

void TurnCheck::add(const ImuBatch& imu, const CameraTurn& turn) {
  if (turns_.size() >= kMostTurns || visible_ >= kEnoughVisible) return;
  for (const ImuSample& sample : imu)
    if (imu_.empty() || sample.t_ns > imu_.back().t_ns) imu_.push_back(sample);
  if (!turn.known()) return;
  turns_.push_back(turn);
  visible_ += (turn.rotation.cwiseAbs() - kVisible * turn.sigma).maxCoeff() > 0;
}

TurnFit TurnCheck::fit(double offset_s) const { return fitAlong(GyroPath(imu_), offset_s); }

TurnFit TurnCheck::fitAlong(const GyroPath& path, double offset_s) const {
  TurnFit fit;
  fit.offset_s = offset_s;
  const std::int64_t offset = std::llround(1e9 * offset_s);
  std::vector<Sample> samples;
  for (const CameraTurn& turn : turns_) {
    if (!path.covers(turn.from_ns + offset, turn.to_ns + offset)) continue;
    const Eigen::Quaterniond R_b0_b1 = path.at(turn.from_ns + offset).conjugate() * path.at(turn.to_ns + offset);
    Sample s;
    s.x << R_b_c_.conjugate() * logRotation(R_b0_b1), 1e-9 * static_cast<double>(turn.to_ns - turn.from_ns);
    s.y = turn.rotation;
    s.sigma = (turn.sigma.array().square() + kSyncNoise_rad * kSyncNoise_rad).sqrt();
    samples.push_back(s);
  }
  std::vector<double> missed;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector4d parameters = Eigen::Vector4d::Zero();
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    double scale = 0;  // of the standard deviations; 0: everything counts at first
    for (int round = 0; round < kRounds; ++round) {
      Eigen::Matrix4d H = 1e-12 * Eigen::Matrix4d::Identity();
      Eigen::Vector4d b = Eigen::Vector4d::Zero();
      std::vector<double> sizes;
      sizes.reserve(samples.size());
      for (const Sample& s : samples) {
        const double e = (s.y[axis] - s.x.dot(parameters)) / s.sigma[axis];
        const double r = scale > 0 ? e / (kWidth * scale) : 0;
        const double weight = 1 / ((1 + r * r) * s.sigma[axis] * s.sigma[axis]);
        H += weight * s.x * s.x.transpose();
        b += weight * s.x * s.y[axis];
      }
      parameters = solveLdlt(H, b);
      for (const Sample& s : samples) sizes.push_back(std::abs(s.y[axis] - s.x.dot(parameters)) / s.sigma[axis]);
      scale = sizes.empty() ? 1 : std::max(1.0, 1.48 * median(sizes));
      covariance = scale * scale * H.inverse();
    }
    fit.M.row(axis) = parameters.head<3>().transpose();
    fit.sigma.row(axis) = covariance.diagonal().head<3>().cwiseSqrt().transpose();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (!turns(samples, k, axis, parameters[3])) continue;
      const Sample& s = samples[k];
      missed.push_back(std::abs((s.y[axis] - s.x.dot(parameters)) / (s.y[axis] - s.x[3] * parameters[3])));
    }
  }
  fit.compared = static_cast<int>(missed.size());
  if (!missed.empty()) fit.missed = median(missed);
  return fit;
}

bool TurnCheck::gyroIsSilent() const {
  Eigen::Vector3d low = imu_.front().gyro, high = low;
  for (const ImuSample& sample : imu_) {
    low = low.cwiseMin(sample.gyro);
    high = high.cwiseMax(sample.gyro);
  }
  return (high - low).maxCoeff() < kSilent_rad_s;
}

TurnFit TurnCheck::bestFit() const {
  const GyroPath path(imu_);
  TurnFit best = fitAlong(path, 0);
  if (imu_.empty()) return best;
  const double span_s = 1e-9 * static_cast<double>(imu_.back().t_ns - imu_.front().t_ns);
  const double reach_s = std::min(kLongestSearch_s, kShareOfSpan * span_s);
  const auto compare = [&](double offset_s) {
    const TurnFit there = fitAlong(path, offset_s);
    if (tells(there) && related(there) && there.missed < best.missed) best = there;
  };
  for (double offset_s = kSearchStep_s; offset_s < reach_s; offset_s += kSearchStep_s)
    for (const double side : {-1.0, 1.0}) compare(side * offset_s);
  const double coarse_s = best.offset_s;
  for (const double fine : {-0.5, -0.25, 0.25, 0.5}) compare(coarse_s + fine * kSearchStep_s);
  return best;
}

bool TurnCheck::agree() const {
  const TurnFit here = fit();
  return tells(here) && here.missed < kLargestMissed && fault(Suspicion::kSome).empty();
}

std::string TurnCheck::fault(Suspicion suspicion, double corrected_s) const {
  const TurnFit here = fit();
  if (!tells(here)) return {};
  if (gyroIsSilent())
    return "the gyroscope shows no turn at all while the images turn: check that its values are recorded";
  if (here.missed < kNoiseMisses) return faultOf(here, R_b_c_, suspicion);
  const bool alone = suspicion == Suspicion::kNone;
  const auto orStabilised = [&](const std::string& fault) {
    if (alone && fault.empty()) return fault;
    const std::string stabilised = stabilisationFault(imu_, R_b_c_, turns_);
    return stabilised.empty() ? fault : stabilised;
  };
  if (alone && here.missed <= kLargestMissed) return orStabilised(faultOf(here, R_b_c_, suspicion));
  const TurnFit best = bestFit();
  const bool clocks = std::abs(best.offset_s) > kSearchedBefore_s && best.missed < kClearlyLess * here.missed;
  if (!clocks && here.missed < (alone ? kUnrelatedMisses : kLargestMissed))
    return orStabilised(faultOf(here, R_b_c_, suspicion));
  if (!clocks || best.missed > kLargestMissed) {
    return orStabilised(formatted(
        "images and gyroscope do not turn together (%.0f %% of the images' turns are not in it): check that both "
        "are of the same recording, their stamps (unit, rate, order), and the gyroscope's axes and unit",
        std::min(100.0, 100 * here.missed)));
  }
  const std::string text =
      formatted("the clocks of images and IMU differ: an image with stamp t shows the world at t %+.2f s of the IMU",
                best.offset_s + corrected_s);
  const std::string more = faultOf(best, R_b_c_, suspicion);
  return text + (more.empty() ? "" : "; " + more);
}

}  // namespace lintel
