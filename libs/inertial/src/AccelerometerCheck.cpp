// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/AccelerometerCheck.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr std::int64_t kMean_ns = 500'000'000, kSpan_ns = 5'000'000'000, kLargestGap_ns = 100'000'000;
// Bias and scale error of cheap sensors reach 0.5 m/s^2, changes of speed within a second 1 m/s.
constexpr double kSizeTolerance = 0.2;  // of gravity
constexpr double kLeastGravity = 0.5;   // m/s^2: less is noise and motion alone
constexpr double kSilent = 1e-3;        // m/s^2: less than any accelerometer's noise
constexpr double kTurned_rad = 1;       // by which gravity must have moved in the sensor's axes
// Squared deviations with the right axes come from motion; with wrong ones a tilt of 10 degrees adds 3 (m/s^2)^2.
constexpr double kClearlyBetter = 1.5;
constexpr int kLeastCompared = 20;
constexpr std::size_t kLeastSpans = 2;

/// A way in which the axes may be mixed up: axis i of the body shows sign[i] times what the file's column[i] has. All
/// signs changed is the same again.
struct Axes {
  std::array<int, 3> column;
  std::array<int, 3> sign;
};

std::vector<Axes> allAxes() {
  std::vector<Axes> all;
  std::array<int, 3> column{0, 1, 2};
  do {
    for (const std::array<int, 3> sign : {std::array<int, 3>{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}})
      all.push_back({column, sign});
  } while (std::next_permutation(column.begin(), column.end()));
  return all;  // the first is as it should be
}

const std::vector<Axes>& assignments() {
  static const std::vector<Axes> all = allAxes();
  return all;
}

}  // namespace

AccelerometerCheck::AccelerometerCheck(double gravity_m_s2)
    : gravity_m_s2_(gravity_m_s2), misfits_(assignments().size(), 0.0) {}

void AccelerometerCheck::add(const ImuBatch& batch, const Eigen::Vector3d& bias_gyro) {
  for (const ImuSample& sample : batch) {
    if (last_ns_ != 0 && sample.t_ns <= last_ns_) continue;
    if (last_ns_ == 0 || sample.t_ns - last_ns_ > kLargestGap_ns) {
      means_.clear();
      sum_.setZero();
      count_ = 0;
      mean_start_ns_ = span_start_ns_ = sample.t_ns;
      R_.setIdentity();
    } else {
      R_ = (R_ * expRotation((sample.gyro - bias_gyro) * 1e-9 * static_cast<double>(sample.t_ns - last_ns_)))
               .normalized();
    }
    if (last_ns_ != 0)
      turned_rad_ += (sample.gyro - bias_gyro).norm() * 1e-9 * static_cast<double>(sample.t_ns - last_ns_);
    lowest_ = lowest_.cwiseMin(sample.accel);
    highest_ = highest_.cwiseMax(sample.accel);
    last_ns_ = sample.t_ns;
    const Eigen::Matrix3d R = R_.toRotationMatrix();
    sum_ += Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data()) * sample.accel.transpose();
    ++count_;
    if (sample.t_ns - mean_start_ns_ >= kMean_ns) closeMean();
    if (sample.t_ns - span_start_ns_ >= kSpan_ns) closeSpan();
  }
}

void AccelerometerCheck::closeMean() {
  means_.push_back(sum_ / count_);
  sum_.setZero();
  count_ = 0;
  mean_start_ns_ = last_ns_;
  if (means_.size() % 2 != 0) return;
  const Eigen::Matrix<double, 9, 3> second = 0.5 * (means_.back() + means_[means_.size() - 2]);
  sizes_.push_back(
      Eigen::Vector3d(second.block<3, 1>(0, 0) + second.block<3, 1>(3, 1) + second.block<3, 1>(6, 2)).norm());
}

void AccelerometerCheck::closeSpan() {
  for (std::size_t k = 0; k < misfits_.size(); ++k) {
    const auto& [column, sign] = assignments()[k];
    std::vector<Eigen::Vector3d> turned;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& m : means_) {
      turned.emplace_back(sign[0] * m.block<3, 1>(0, column[0]) + sign[1] * m.block<3, 1>(3, column[1]) +
                          sign[2] * m.block<3, 1>(6, column[2]));
      mean += turned.back() / static_cast<double>(means_.size());
    }
    if (k == 0) span_sizes_.push_back(mean.norm());
    for (const Eigen::Vector3d& f : turned) misfits_[k] += (f - mean).squaredNorm();
  }
  compared_ += static_cast<int>(means_.size());
  means_.clear();
  span_start_ns_ = last_ns_;
  R_.setIdentity();
}

double AccelerometerCheck::gravity() const {
  std::vector<double> sizes = sizes_;
  return sizes.empty() ? 0 : median(sizes);
}

std::string AccelerometerCheck::sizeFault() const {
  if (sizes_.empty()) return {};
  if ((highest_ - lowest_).maxCoeff() < kSilent && turned_rad_ > kTurned_rad)
    return "the accelerometer's values do not change although the IMU turns: check that they are recorded";
  const auto isGravity = [&](double size) { return std::abs(size / gravity_m_s2_ - 1) < kSizeTolerance; };
  const double seen = gravity();
  if (isGravity(seen)) return {};
  // Means over a second hold some of a violent motion, those over five hardly any.
  std::vector<double> sizes = span_sizes_;
  if (seen > gravity_m_s2_ && sizes.size() >= kLeastSpans && isGravity(median(sizes))) return {};
  std::string fault = formatted("the accelerometer shows %.2f m/s^2 where gravity is %.2f", seen, gravity_m_s2_);
  if (std::abs(seen - 1) < kSizeTolerance)
    fault += ": its values are in g, not in m/s^2";
  else if (seen < kLeastGravity)
    fault += ": gravity has been taken out of its values; the raw ones are needed";
  else
    fault += ": check its unit (m/s^2, gravity included)";
  return fault;
}

double AccelerometerCheck::axesMisfit() const {
  if (compared_ < kLeastCompared) return 1;
  const double best = *std::min_element(misfits_.begin(), misfits_.end());
  return best > 0 ? misfits_[0] / best : 1;
}

std::string AccelerometerCheck::axesFault() const {
  if (!(axesMisfit() > kClearlyBetter)) return {};
  const auto& [column, sign] =
      assignments()[static_cast<std::size_t>(std::min_element(misfits_.begin(), misfits_.end()) - misfits_.begin())];
  std::string order;
  for (std::size_t i = 0; i < 3; ++i) order += std::string(i ? ", " : "") + (sign[i] < 0 ? "-" : "") + "xyz"[column[i]];
  return "the accelerometer's axes do not turn with the gyroscope's: x, y, z seem to be its columns " + order;
}

}  // namespace lintel
