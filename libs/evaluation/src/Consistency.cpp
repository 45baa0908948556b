// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/Consistency.h"

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "lintel/core/TextRows.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// Symmetric, and no correlation above 1 but for rounded numbers: small angles of a first pose come from large ones,
/// whose rounding they keep.
bool isPossible(const PoseCovariance& covariance) {
  constexpr double kRounding = 1e-3, kRoundingOfLargest = 1e-5;
  const double largest[] = {covariance.diagonal().head<3>().maxCoeff(), covariance.diagonal().tail<3>().maxCoeff()};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) {
      const double most = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j)),
                   rounding = kRounding * most + kRoundingOfLargest * std::sqrt(largest[i / 3] * largest[j / 3]);
      if (!(std::abs(covariance(i, j)) <= most + rounding)) return false;
      if (!(std::abs(covariance(i, j) - covariance(j, i)) <= rounding)) return false;
    }
  return true;
}

PoseCovariance covarianceOf(const TextRows& rows) {
  const std::size_t columns = rows.fields().size();
  if (columns != 22 && columns != 37) rows.fail("a covariance should be a time and 21 or 36 numbers");
  PoseCovariance covariance;
  std::size_t column = 1;
  for (int i = 0; i < 6; ++i)
    for (int j = columns == 22 ? i : 0; j < 6; ++j) {
      const double value = rows.number(column++);
      covariance(i, j) = value;
      if (columns == 22) covariance(j, i) = value;
    }
  if (covariance.diagonal().minCoeff() < 0) rows.fail("a variance is negative");
  if (!isPossible(covariance)) rows.fail("is no covariance: larger beside the diagonal than the variances allow");
  return covariance;
}

/// Shift and turn about the vertical that lay an estimated pose on the true one.
class Anchor {
 public:
  Anchor(const Pose& estimate, const Pose& truth) : at_(estimate.p), from_(truth.p) {
    for (int i = 0; i < 3; ++i) {
      const double turned = logRotation(estimate.q * (yaw_ * truth.q).conjugate()).z();
      yaw_ = Eigen::Quaterniond(Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ())) * yaw_;
    }
  }

  /// The true pose in the estimate's world.
  Pose operator()(const Pose& truth) const { return {yaw_ * truth.q, at_ + yaw_ * (truth.p - from_)}; }

 private:
  Eigen::Vector3d at_, from_;
  Eigen::Quaterniond yaw_ = Eigen::Quaterniond::Identity();
};

/// Adds up squared errors of one kind.
class Summing {
 public:
  explicit Summing(int freedom) {
    const boost::math::chi_squared chi_squared(freedom);
    sum_.freedom = freedom;
    sum_.low = quantile(chi_squared, 0.025);
    sum_.high = quantile(chi_squared, 0.975);
  }

  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
    const double squared = error.dot(covariance.ldlt().solve(error));
    sum_.mean += squared;
    sum_.inside += squared >= sum_.low && squared <= sum_.high;
  }

  SquaredErrorSummary over(std::size_t count) const {
    SquaredErrorSummary result = sum_;
    result.mean /= static_cast<double>(count);
    result.inside /= static_cast<double>(count);
    return result;
  }

 private:
  SquaredErrorSummary sum_;
};

/// The true pose at a time between stamps: a quick turn is a milliradian away within half of 5 ms.
Pose truthAt(std::int64_t t_ns, const StampedPoses& groundtruth, std::size_t nearest) {
  const std::size_t from = groundtruth[nearest].first <= t_ns ? nearest : nearest - 1, to = from + 1;
  if (groundtruth[nearest].first == t_ns || from >= groundtruth.size() || to >= groundtruth.size())
    return groundtruth[nearest].second;
  const auto& [before_ns, before] = groundtruth[from];
  const auto& [after_ns, after] = groundtruth[to];
  return interpolate(before, after, static_cast<double>(t_ns - before_ns) / static_cast<double>(after_ns - before_ns));
}

bool beginsPiece(const PoseCovariance& covariance) { return covariance.diagonal().head<3>().isZero(0); }

}  // namespace

std::vector<PoseCovariance> readCovariances(const std::string& path, const StampedPoses& poses) {
  TextRows rows(path, throwError<EvaluationError>);
  std::vector<PoseCovariance> covariances;
  while (rows.next()) {
    const std::size_t i = covariances.size();
    if (i == poses.size() || rows.secondsAsNanoseconds(0) != poses[i].first)
      rows.fail("is not the time of pose " + std::to_string(i + 1) + "; give the covariances of this trajectory");
    covariances.push_back(fromEulerCovariance(covarianceOf(rows), poses[i].second.q));
  }
  if (covariances.size() < poses.size())
    throw EvaluationError(path + ": ends after " + std::to_string(covariances.size()) + " of " +
                          std::to_string(poses.size()) + " poses; give the covariances of this trajectory");
  return covariances;
}

Consistency evaluateConsistency(const StampedPoses& estimate, const std::vector<PoseCovariance>& covariances,
                                const StampedPoses& groundtruth, const TrajectoryErrorParams& params) {
  Consistency result;
  Summing position(3), yaw(1), roll_pitch(2);
  std::optional<Anchor> anchor;
  std::size_t next = 0;
  for (const PosePair& pair : associate(estimate, groundtruth, params.max_difference_s)) {
    const auto& [t_ns, T_w_b] = estimate[pair.estimate];
    const std::int64_t true_t_ns = groundtruth[pair.groundtruth].first;
    const Pose true_T_w_b = truthAt(t_ns, groundtruth, pair.groundtruth);
    for (; next <= pair.estimate; ++next)
      if (beginsPiece(covariances[next])) anchor.reset();
    if (!anchor) {
      anchor.emplace(T_w_b, true_T_w_b);
      ++result.pieces;
    }
    const PoseCovariance& covariance = covariances[pair.estimate];
    if (beginsPiece(covariance) || true_t_ns < params.from_ns || true_t_ns > params.to_ns) continue;
    const Pose truth = (*anchor)(true_T_w_b);
    const Eigen::Vector3d error_m = truth.p - T_w_b.p, turn_w = logRotation(truth.q * T_w_b.q.conjugate());
    const Eigen::Matrix3d R = T_w_b.R();
    const Eigen::Matrix3d turn_covariance = R * covariance.bottomRightCorner<3, 3>() * R.transpose();
    position.add(error_m, covariance.topLeftCorner<3, 3>());
    yaw.add(turn_w.tail<1>(), turn_covariance.bottomRightCorner<1, 1>());
    roll_pitch.add(turn_w.head<2>(), turn_covariance.topLeftCorner<2, 2>());
    result.series.push_back({t_ns, error_m, covariance.diagonal().head<3>().cwiseSqrt()});
    ++result.poses;
  }
  if (result.poses == 0) throw EvaluationError("no pose has both a covariance and a ground truth");
  result.position = position.over(result.poses);
  result.yaw = yaw.over(result.poses);
  result.roll_pitch = roll_pitch.over(result.poses);
  return result;
}

}  // namespace lintel
