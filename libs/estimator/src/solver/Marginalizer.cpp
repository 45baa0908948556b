// SPDX-License-Identifier: BSD-3-Clause
#include "solver/Marginalizer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/SmallMatrices.h"
#include "solver/InformationRoot.h"

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // eigenvalues below are taken as zero, relative to a residual of one sigma

/// Symmetric pseudo-inverse; directions with less information than kNoInformation are left out.
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& m) {
  const auto eigen = symmetricEigen<Eigen::Dynamic>(0.5 * (m + m.transpose()));
  const Eigen::VectorXd inverse = eigen.values.unaryExpr([](double v) { return v > kNoInformation ? 1.0 / v : 0.0; });
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

/// H and b without the first `size` rows, their information passed on to the others; the same with a function K dx of
/// the states: what of it the others know.
void eliminate(NormalEquations& eq, WorldDrift::Rows& K, Eigen::Index size) {
  const Eigen::Index rest = eq.H.rows() - size;
  if (size == 0 || rest == 0) return;
  const auto Hbm = eq.H.block(size, 0, rest, size);
  const Eigen::MatrixXd gain = Hbm * pseudoInverse(eq.H.topLeftCorner(size, size));
  eq.b.tail(rest) -= gain * eq.b.head(size);
  eq.H.bottomRightCorner(rest, rest) -= gain * Hbm.transpose();
  K.rightCols(rest) -= K.leftCols(size) * gain.transpose();
}

/// States that walk, given by their rows: x' = x + noise of these variances, independent for each row. x' takes the
/// place of x in the equations.
void walk(Eigen::MatrixXd& H, Eigen::VectorXd& b, WorldDrift::Rows& K, const std::vector<Eigen::Index>& rows,
          const std::vector<double>& variances) {
  if (rows.empty()) return;
  const Eigen::VectorXd w =
      Eigen::VectorXd::Map(variances.data(), static_cast<Eigen::Index>(variances.size())).cwiseInverse();
  const Eigen::MatrixXd H_x = H(Eigen::all, rows);
  Eigen::MatrixXd known = H_x(rows, Eigen::all);
  known.diagonal() += w;
  const Eigen::LLT<Eigen::MatrixXd> llt(known);
  const Eigen::MatrixXd half = llt.matrixL().solve(H_x.transpose());  // half' half = H_x (H_xx + W)^-1 H_x'
  const Eigen::MatrixXd crossed = llt.matrixU().solve(half).transpose() * w.asDiagonal();
  const Eigen::VectorXd moved = llt.solve(Eigen::VectorXd(b(rows)));
  const Eigen::MatrixXd moved_K = llt.solve(K(Eigen::all, rows).transpose());  // n x 4
  H.selfadjointView<Eigen::Lower>().rankUpdate(half.transpose(), -1);
  H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
  b -= H_x * moved;
  K -= (H_x * moved_K).transpose();
  H(Eigen::all, rows) = crossed;
  H(rows, Eigen::all) = crossed.transpose();
  b(rows) = w.cwiseProduct(moved);
  K(Eigen::all, rows) = moved_K.transpose() * w.asDiagonal();
}

/// What a change of the scale about `centre_w` does to a block, in its tangent space.
Eigen::VectorXd scaleAction(const SlidingWindow& window, const BlockKey& key, const Eigen::Vector3d& centre_w) {
  Eigen::VectorXd action = Eigen::VectorXd::Zero(manifoldOf(key.kind)->TangentSize());
  if (key.kind == BlockKey::kPose) action.head<3>() = window.frame(key.id).T_w_b().p - centre_w;
  if (key.kind == BlockKey::kMotion) action.segment<3>(kVelocityAt) = velocityOf(window.frame(key.id).motion.data());
  if (key.kind == BlockKey::kPoint) {
    const PointTrack& track = window.points.at(key.id);
    PointBlock change = PointBlock::Zero();
    change.head<3>() = track.point.head<3>() + track.point[3] * (track.origin_w - centre_w);
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> tangent_by_point;
    manifoldOf(key.kind)->MinusJacobian(track.point.data(), tangent_by_point.data());
    action = tangent_by_point * change;
  }
  return action;
}

/// How the states from block `first` on move when the scale changes about the oldest frame that stays.
Eigen::VectorXd scaleDirection(const SlidingWindow& window, const NormalEquations& eq, std::size_t first) {
  const Eigen::Index start = eq.offsets[first];
  const Eigen::Vector3d centre_w = window.frames[1].T_w_b().p;
  Eigen::VectorXd direction(eq.H.rows() - start);
  for (std::size_t i = first; i < eq.blocks.size(); ++i)
    direction.segment(eq.offsets[i] - start, eq.offsets[i + 1] - eq.offsets[i]) =
        scaleAction(window, eq.blocks[i], centre_w);
  return direction;
}

/// All states move together by `direction` times an amount of this variance.
void walkTogether(const Eigen::VectorXd& direction, double variance, Eigen::MatrixXd& H, Eigen::VectorXd& b,
                  WorldDrift::Rows& K) {
  const Eigen::VectorXd Hd = H * direction;
  const double known = 1 / variance + direction.dot(Hd);
  b -= Hd * (direction.dot(b) / known);
  K -= K * direction * (Hd.transpose() / known);
  H -= Hd * (Hd.transpose() / known);
}

double walkOf(const BlockKey& key, const Staying& staying) {
  if (key.kind == BlockKey::kPoint) return staying.walk_rad;
  return key.kind == BlockKey::kMeanBias ? staying.bias_walk : 0;
}

GaugeAction actionOf(const BlockKey& key) {
  if (key.kind == BlockKey::kPoint) return GaugeAction::kPoint;
  if (key.kind == BlockKey::kPose) return GaugeAction::kPose;
  return key.kind == BlockKey::kMotion ? GaugeAction::kMotion : GaugeAction::kNone;
}

/// What the drift has in the columns of these equations.
WorldDrift::Rows takeColumns(WorldDrift& drift, const NormalEquations& eq) {
  WorldDrift::Rows K = WorldDrift::Rows::Zero(4, eq.H.cols());
  for (std::size_t i = 0; i < eq.blocks.size(); ++i) {
    const auto found = drift.by_state.find(eq.blocks[i]);
    if (found == drift.by_state.end()) continue;
    K.middleCols(eq.offsets[i], found->second.cols()) = found->second;
    drift.by_state.erase(found);
  }
  return K;
}

PriorBlock priorBlockOf(SlidingWindow& window, const BlockKey& key, bool absolute) {
  const auto manifold = manifoldOf(key.kind);
  PriorBlock block{manifold, Eigen::Map<const Eigen::VectorXd>(window.block(key), manifold->AmbientSize())};
  if (key.kind == BlockKey::kPoint) block.origin_w = window.points.at(key.id).origin_w;
  if (!absolute || key.kind == BlockKey::kPoint) block.action = actionOf(key);
  return block;
}

/// Whether a factor knows where in the world a pose is.
bool isAbsolute(const Factor& factor) {
  const auto* prior = dynamic_cast<const PriorFactor*>(factor.cost);
  return prior && prior->anchor() < 0 &&
         std::any_of(factor.blocks.begin(), factor.blocks.end(),
                     [](const BlockKey& key) { return key.kind == BlockKey::kPose; });
}

}  // namespace

std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped, const Staying& staying) {
  std::set<BlockKey> first = dropped;
  for (const Factor& factor : factors)
    for (const BlockKey& key : factor.blocks)
      if (isLandmark(key) && staying.points.count(key) == 0) first.insert(key);
  ReducedSystem system(window, factors, first, {}, staying.points);
  system.linearise();
  NormalEquations eq = system.eliminate();
  std::size_t kept = 0;
  while (kept < eq.blocks.size() && first.count(eq.blocks[kept]) > 0) ++kept;
  const Eigen::Index start = eq.offsets[kept], size = eq.H.rows() - start;
  WorldDrift::Rows K = takeColumns(window.drift, eq);
  if (size == 0) return std::nullopt;
  eliminate(eq, K, start);
  const bool absolute = std::any_of(factors.begin(), factors.end(), isAbsolute);
  std::vector<PriorBlock> blocks;
  Eigen::MatrixXd H = eq.H.bottomRightCorner(size, size).selfadjointView<Eigen::Lower>();
  Eigen::VectorXd b = eq.b.tail(size);
  K = K.rightCols(size).eval();
  std::vector<Eigen::Index> walking;
  std::vector<double> variances;
  for (std::size_t i = kept; i < eq.blocks.size(); ++i) {
    blocks.push_back(priorBlockOf(window, eq.blocks[i], absolute));
    const double sigma = walkOf(eq.blocks[i], staying);
    for (Eigen::Index row = eq.offsets[i]; sigma > 0 && row < eq.offsets[i + 1]; ++row) {
      walking.push_back(row - start);
      variances.push_back(sigma * sigma);
    }
  }
  walk(H, b, K, walking, variances);
  if (staying.scale_walk > 0)
    walkTogether(scaleDirection(window, eq, kept), staying.scale_walk * staying.scale_walk, H, b, K);
  for (std::size_t i = kept; i < eq.blocks.size(); ++i)
    window.drift.by_state[eq.blocks[i]] = K.middleCols(eq.offsets[i] - start, eq.offsets[i + 1] - eq.offsets[i]);
  LinearResidual root = informationRoot(H, b);
  WindowPrior prior;
  prior.blocks = {eq.blocks.begin() + static_cast<std::ptrdiff_t>(kept), eq.blocks.end()};
  prior.factor = std::make_shared<PriorFactor>(std::move(blocks), std::move(root.A), std::move(root.r_0));
  return prior;
}

}  // namespace lintel
