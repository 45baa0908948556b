// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Alignment.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include <utility>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr std::pair<AlignmentKind, const char*> kNames[] = {{AlignmentKind::kNone, "none"},
                                                            {AlignmentKind::kSe3, "se3"},
                                                            {AlignmentKind::kYaw, "yaw"},
                                                            {AlignmentKind::kSim3, "sim3"}};

Eigen::Map<const Eigen::Matrix3Xd> columns(const std::vector<Eigen::Vector3d>& points) {
  return {points.front().data(), 3, static_cast<Eigen::Index>(points.size())};
}

Similarity alignYaw(const Eigen::Ref<const Eigen::Matrix3Xd>& from, const Eigen::Ref<const Eigen::Matrix3Xd>& to) {
  const Eigen::Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
  const Eigen::Matrix3Xd f = from.colwise() - from_mean, t = to.colwise() - to_mean;
  // sum |t - Rz f|^2 is smallest where cosine * C + sine * S is largest
  const double C = f.row(0).dot(t.row(0)) + f.row(1).dot(t.row(1));
  const double S = f.row(0).dot(t.row(1)) - f.row(1).dot(t.row(0));
  Similarity result;
  result.T_a_b.q = Eigen::AngleAxisd(std::atan2(S, C), Eigen::Vector3d::UnitZ());
  result.T_a_b.p = to_mean - result.T_a_b.q * from_mean;
  return result;
}

/// [Umeyama1991, eq. 38 to 43].
Similarity alignUmeyama(const Eigen::Ref<const Eigen::Matrix3Xd>& from, const Eigen::Ref<const Eigen::Matrix3Xd>& to,
                        bool with_scale) {
  const Eigen::Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
  const Eigen::Matrix3Xd f = from.colwise() - from_mean, t = to.colwise() - to_mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < f.cols(); ++i) covariance += t.col(i) * f.col(i).transpose();
  const SingularValues3 svd = singularValues(covariance / static_cast<double>(f.cols()));
  const Eigen::Vector3d signs(1, 1, svd.U.determinant() * svd.V.determinant() < 0 ? -1 : 1);
  Similarity result;
  // A scale needs movement: below, the ratio of the spreads is rounding noise.
  if (with_scale && f.norm() > 1e-9 * (1 + from.norm()))
    result.scale = svd.values.dot(signs) / (f.squaredNorm() / static_cast<double>(f.cols()));
  if (!(result.scale > 0)) {  // the partners do not move: the scale is zero
    result.scale = 0;
    result.T_a_b.p = to_mean;
    return result;
  }
  const Eigen::Matrix3d R_a_b = svd.U * signs.asDiagonal() * svd.V.transpose();
  result.T_a_b.q = Eigen::Quaterniond(R_a_b).normalized();
  result.T_a_b.p = to_mean - result.scale * (R_a_b * from_mean);
  return result;
}

}  // namespace

AlignmentKind alignmentKindOf(const std::string& name) {
  for (const auto& [kind, kind_name] : kNames)
    if (name == kind_name) return kind;
  throw std::invalid_argument("alignment '" + name + "' is none of none, se3, yaw, sim3");
}

std::string nameOf(AlignmentKind kind) {
  for (const auto& [known, name] : kNames)
    if (known == kind) return name;
  throw std::invalid_argument("not an AlignmentKind");
}

Similarity alignPositions(AlignmentKind kind, const std::vector<Eigen::Vector3d>& from_b,
                          const std::vector<Eigen::Vector3d>& to_a) {
  if (from_b.size() != to_a.size() || from_b.empty())
    throw std::invalid_argument("alignPositions needs as many positions on either side, and at least one");
  const auto from = columns(from_b), to = columns(to_a);
  switch (kind) {
    case AlignmentKind::kNone:
      return {};
    case AlignmentKind::kYaw:
      return alignYaw(from, to);
    case AlignmentKind::kSe3:
      return alignUmeyama(from, to, false);
    case AlignmentKind::kSim3:
      return alignUmeyama(from, to, true);
  }
  throw std::invalid_argument("not an AlignmentKind");
}

}  // namespace lintel
