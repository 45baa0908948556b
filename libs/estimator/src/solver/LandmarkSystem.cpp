// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkSystem.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // eigenvalues below count as zero; residuals are in standard deviations
constexpr double kLeastDamping = 1e-6;   // times the damping: the least that is added to a diagonal

template <class Kind>
const StateManifold& manifold() {
  return *manifoldOf(std::is_same_v<Kind, PointKind> ? BlockKey::kPoint : BlockKey::kLine);
}

/// d landmark / d tangent applied to a linearisation's landmark Jacobian.
Eigen::Matrix<double, 2, kPointTangent> tangentJacobian(const PointLinearisation& l, const RowMajorMatrix& plus) {
  return l.d_point * plus.topLeftCorner<kPointSize, kPointTangent>();
}
Eigen::Matrix<double, 2, kLineTangent> tangentJacobian(const LineLinearisation& l, const RowMajorMatrix&) {
  return l.d_line;
}

/// Robust cost of a squared norm, and the weight of its residual.
double robust(const ceres::LossFunction* loss, double squared, double& weight) {
  weight = 1;
  if (!loss) return 0.5 * squared;
  double rho[3];
  loss->Evaluate(squared, rho);
  weight = rho[1];
  return 0.5 * rho[0];
}

double structuralCost(const Factor& structural, const double* const* blocks) {
  Eigen::Vector3d r;
  structural.cost->Evaluate(blocks, r.data(), nullptr);
  double weight;
  return robust(structural.loss, r.squaredNorm(), weight);
}

template <class Kind>
double costOf(const LandmarkBlock<Kind>& landmark, const std::vector<CameraView>& views, const double* correction,
              const CameraLayout& layout) {
  double sum = 0, weight;
  typename Kind::Linearisation l;
  for (const auto& s : landmark.sightings) {
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, landmark.block, false, l);
    sum += robust(landmark.loss, l.residual.squaredNorm(), weight);
  }
  if (landmark.structural) {
    const double* blocks[] = {landmark.block, layout.direction_blocks[static_cast<std::size_t>(landmark.direction)]};
    sum += structuralCost(*landmark.structural, blocks);
  }
  return sum;
}

/// Adds the residual that ties a line to its direction.
template <class Kind>
double addStructural(LandmarkBlock<Kind>& landmark, const CameraLayout& layout, CameraEquations& eq) {
  const double* direction = layout.direction_blocks[static_cast<std::size_t>(landmark.direction)];
  const double* blocks[] = {landmark.block, direction};
  Eigen::Vector3d r;
  Eigen::Matrix<double, 3, Kind::kSize, Eigen::RowMajor> J_line;
  Eigen::Matrix<double, 3, kDirectionSize, Eigen::RowMajor> J_direction;
  double* jacobians[] = {J_line.data(), J_direction.data()};
  landmark.structural->cost->Evaluate(blocks, r.data(), jacobians);
  double weight;
  const double cost = robust(landmark.structural->loss, r.squaredNorm(), weight);
  RowMajorMatrix plus(Kind::kSize, Kind::kTangent), plus_direction(kDirectionSize, kDirectionTangent);
  manifold<Kind>().PlusJacobian(landmark.block, plus.data());
  manifoldOf(BlockKey::kDirection)->PlusJacobian(direction, plus_direction.data());
  const Eigen::Matrix<double, 3, Kind::kTangent> J = J_line * plus;
  const Eigen::Matrix<double, 3, kDirectionTangent> Jd = J_direction * plus_direction;
  landmark.H += weight * J.transpose() * J;
  landmark.b += weight * J.transpose() * r;
  landmark.W_direction = weight * Jd.transpose() * J;
  const Eigen::Index at = layout.direction(landmark.direction);
  eq.H.block<kDirectionTangent, kDirectionTangent>(at, at) += weight * Jd.transpose() * Jd;
  eq.b.segment<kDirectionTangent>(at) += weight * Jd.transpose() * r;
  return cost;
}

template <class Kind>
double lineariseOne(LandmarkBlock<Kind>& landmark, const std::vector<CameraView>& views, const double* correction,
                    const CameraLayout& layout, CameraEquations& eq) {
  landmark.H.setZero();
  landmark.b.setZero();
  landmark.W_intrinsics.setZero();
  RowMajorMatrix plus(Kind::kSize, Kind::kTangent);
  manifold<Kind>().PlusJacobian(landmark.block, plus.data());
  const Eigen::Index intrinsics = layout.intrinsics();
  double sum = 0, weight;
  typename Kind::Linearisation l;
  for (auto& s : landmark.sightings) {
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, landmark.block, true, l);
    sum += robust(landmark.loss, l.residual.squaredNorm(), weight);
    const double root = std::sqrt(weight);
    const Eigen::Matrix<double, 2, Kind::kTangent> J = root * tangentJacobian(l, plus);
    const CameraJacobian Jc = root * l.d_camera;
    const IntrinsicsJacobian Ji = root * l.d_intrinsics;
    const Eigen::Vector2d r = root * l.residual;
    landmark.H.noalias() += J.transpose() * J;
    landmark.b.noalias() += J.transpose() * r;
    landmark.W_intrinsics.noalias() += Ji.transpose() * J;
    s.W.noalias() = Jc.transpose() * J;
    const Eigen::Index at = layout.camera(s.camera);
    eq.H.block<kCameraTangent, kCameraTangent>(at, at).noalias() += Jc.transpose() * Jc;
    eq.H.block<kIntrinsicsSize, kCameraTangent>(intrinsics, at).noalias() += Ji.transpose() * Jc;
    eq.H.block<kIntrinsicsSize, kIntrinsicsSize>(intrinsics, intrinsics).noalias() += Ji.transpose() * Ji;
    eq.b.segment<kCameraTangent>(at).noalias() += Jc.transpose() * r;
    eq.b.segment<kIntrinsicsSize>(intrinsics).noalias() += Ji.transpose() * r;
  }
  if (landmark.structural) sum += addStructural(landmark, layout, eq);
  return sum;
}

double costOf(const DirectionSighting& s, const std::vector<CameraView>& views, const double* correction,
              const CameraLayout& layout) {
  VanishingLinearisation l;
  double weight;
  s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction,
                      layout.direction_blocks[static_cast<std::size_t>(s.direction)], false, l);
  return robust(s.loss, l.residual * l.residual, weight);
}

double lineariseOne(const DirectionSighting& s, const std::vector<CameraView>& views, const double* correction,
                    const CameraLayout& layout, CameraEquations& eq) {
  const double* direction = layout.direction_blocks[static_cast<std::size_t>(s.direction)];
  VanishingLinearisation l;
  double weight;
  s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, direction, true, l);
  const double cost = robust(s.loss, l.residual * l.residual, weight);
  RowMajorMatrix plus(kDirectionSize, kDirectionTangent);
  manifoldOf(BlockKey::kDirection)->PlusJacobian(direction, plus.data());
  const Eigen::Matrix<double, 1, kDirectionTangent> Jd = l.d_direction * plus;
  const Eigen::Index camera = layout.camera(s.camera), intrinsics = layout.intrinsics(),
                     at = layout.direction(s.direction);
  const auto& Jc = l.d_camera;
  const auto& Ji = l.d_intrinsics;
  eq.H.block<kCameraTangent, kCameraTangent>(camera, camera) += weight * Jc.transpose() * Jc;
  eq.H.block<kIntrinsicsSize, kCameraTangent>(intrinsics, camera) += weight * Ji.transpose() * Jc;
  eq.H.block<kIntrinsicsSize, kIntrinsicsSize>(intrinsics, intrinsics) += weight * Ji.transpose() * Ji;
  eq.H.block<kDirectionTangent, kCameraTangent>(at, camera) += weight * Jd.transpose() * Jc;
  eq.H.block<kDirectionTangent, kIntrinsicsSize>(at, intrinsics) += weight * Jd.transpose() * Ji;
  eq.H.block<kDirectionTangent, kDirectionTangent>(at, at) += weight * Jd.transpose() * Jd;
  eq.b.segment<kCameraTangent>(camera) += weight * l.residual * Jc.transpose();
  eq.b.segment<kIntrinsicsSize>(intrinsics) += weight * l.residual * Ji.transpose();
  eq.b.segment<kDirectionTangent>(at) += weight * l.residual * Jd.transpose();
  return cost;
}

/// S with S S^T = H^-1; a pseudo-inverse where H has no information.
template <int T>
Eigen::Matrix<double, T, T> inverseRoot(Eigen::Matrix<double, T, T> H, double damping) {
  using Matrix = Eigen::Matrix<double, T, T>;
  if (damping > 0) {
    for (int i = 0; i < T; ++i) H(i, i) += damping * std::max(H(i, i), kLeastDamping);
    const Eigen::LLT<Matrix> llt(H);
    if (llt.info() == Eigen::Success) return llt.matrixU().solve(Matrix::Identity());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(H);
  const auto root =
      solver.eigenvalues().unaryExpr([](double v) { return v > kNoInformation ? 1 / std::sqrt(v) : 0.0; });
  return solver.eigenvectors() * root.asDiagonal();
}

template <class Kind>
void eliminateOne(LandmarkBlock<Kind>& landmark, double damping, const CameraLayout& layout, CameraEquations& eq) {
  constexpr int T = Kind::kTangent;
  landmark.inverse_root = inverseRoot<T>(landmark.H, damping);
  const Eigen::Matrix<double, T, T>& S = landmark.inverse_root;
  const Eigen::Matrix<double, T, 1> y = S.transpose() * landmark.b;
  const Eigen::Index intrinsics = layout.intrinsics();
  landmark.Y_intrinsics.noalias() = landmark.W_intrinsics * S;
  const auto& Yi = landmark.Y_intrinsics;
  for (std::size_t i = 0; i < landmark.sightings.size(); ++i) {
    auto& a = landmark.sightings[i];
    a.Y.noalias() = a.W * S;
    const Eigen::Index at = layout.camera(a.camera);
    for (std::size_t j = 0; j <= i; ++j) {
      const auto& other = landmark.sightings[j];
      eq.H.block<kCameraTangent, kCameraTangent>(at, layout.camera(other.camera)).noalias() -=
          a.Y * other.Y.transpose();
    }
    eq.H.block<kIntrinsicsSize, kCameraTangent>(intrinsics, at).noalias() -= Yi * a.Y.transpose();
    eq.b.segment<kCameraTangent>(at).noalias() -= a.Y * y;
  }
  eq.H.block<kIntrinsicsSize, kIntrinsicsSize>(intrinsics, intrinsics).noalias() -= Yi * Yi.transpose();
  eq.b.segment<kIntrinsicsSize>(intrinsics).noalias() -= Yi * y;
  if (!landmark.structural) return;
  landmark.Y_direction = landmark.W_direction * S;
  const auto& Yd = landmark.Y_direction;
  const Eigen::Index at = layout.direction(landmark.direction);
  for (const auto& a : landmark.sightings)
    eq.H.block<kDirectionTangent, kCameraTangent>(at, layout.camera(a.camera)) -= Yd * a.Y.transpose();
  eq.H.block<kDirectionTangent, kIntrinsicsSize>(at, intrinsics) -= Yd * Yi.transpose();
  eq.H.block<kDirectionTangent, kDirectionTangent>(at, at) -= Yd * Yd.transpose();
  eq.b.segment<kDirectionTangent>(at) -= Yd * y;
}

template <class Kind>
double backSubstituteOne(LandmarkBlock<Kind>& landmark, const Eigen::VectorXd& camera_step, double damping,
                         const CameraLayout& layout) {
  constexpr int T = Kind::kTangent;
  Eigen::Matrix<double, T, 1> y = landmark.inverse_root.transpose() * landmark.b;
  for (const auto& s : landmark.sightings)
    y += s.Y.transpose() * camera_step.segment<kCameraTangent>(layout.camera(s.camera));
  y += landmark.Y_intrinsics.transpose() * camera_step.segment<kIntrinsicsSize>(layout.intrinsics());
  if (landmark.structural)
    y +=
        landmark.Y_direction.transpose() * camera_step.segment<kDirectionTangent>(layout.direction(landmark.direction));
  landmark.step = -landmark.inverse_root * y;
  const auto damped = damping * landmark.H.diagonal().cwiseMax(kLeastDamping);
  return 0.5 * landmark.step.dot(damped.cwiseProduct(landmark.step) - landmark.b);
}

}  // namespace

bool LandmarkSystem::isVision(const Factor& factor) {
  return std::any_of(factor.blocks.begin(), factor.blocks.end(),
                     [](const BlockKey& key) {
                       return key.kind == BlockKey::kPoint || key.kind == BlockKey::kLine ||
                              key.kind == BlockKey::kDirection;
                     }) &&
         dynamic_cast<const PriorFactor*>(factor.cost) == nullptr;
}

int LandmarkSystem::directionOf(SlidingWindow& window, const BlockKey& key) {
  const auto [it, is_new] = layout_.directions.emplace(key.id, static_cast<int>(layout_.directions.size()));
  if (is_new) layout_.direction_blocks.push_back(window.block(key));
  return it->second;
}

LandmarkSystem::LandmarkSystem(SlidingWindow& window, const std::vector<Factor>& factors,
                               const std::map<FrameId, int>& camera_of)
    : correction_(window.correction.data()), motions_(camera_of.size()), seeing_(camera_of.size(), false) {
  layout_.cameras = static_cast<int>(camera_of.size());
  std::map<TrackId, std::size_t> point_at, line_at;
  const auto blockOf = [&](auto& landmarks, std::map<TrackId, std::size_t>& places, const BlockKey& key) -> auto& {
    const auto [it, is_new] = places.emplace(key.id, landmarks.size());
    if (is_new) {
      landmarks.emplace_back().block = window.block(key);
      landmarks.back().sightings.reserve(camera_of.size());
    }
    return landmarks[it->second];
  };
  for (const Factor& factor : factors) {
    if (!isVision(factor)) continue;
    if (factor.blocks.front().kind == BlockKey::kPose)
      seeing_[static_cast<std::size_t>(camera_of.at(factor.blocks.front().id))] = true;
    if (const BlockKey& key = factor.blocks.back(); factor.blocks.front().kind == BlockKey::kLine) {  // structural
      auto& line = blockOf(lines_, line_at, factor.blocks.front());
      line.structural = &factor;
      line.direction = directionOf(window, key);
    } else if (key.kind == BlockKey::kDirection) {
      const int camera = camera_of.at(factor.blocks.front().id);
      vanishing_.push_back(
          {static_cast<const VanishingFactor*>(factor.cost), factor.loss, camera, directionOf(window, key)});
      motions_[static_cast<std::size_t>(camera)] = vanishing_.back().factor->motion();
    } else if (const int camera = camera_of.at(factor.blocks.front().id); key.kind == BlockKey::kPoint) {
      auto& point = blockOf(points_, point_at, key);
      point.loss = factor.loss;
      point.sightings.push_back({static_cast<const PointFactor*>(factor.cost), camera});
      motions_[static_cast<std::size_t>(camera)] = point.sightings.back().factor->motion();
    } else {
      auto& line = blockOf(lines_, line_at, key);
      line.loss = factor.loss;
      line.sightings.push_back({static_cast<const LineFactor*>(factor.cost), camera});
      motions_[static_cast<std::size_t>(camera)] = line.sightings.back().factor->motion();
    }
  }
}

std::set<BlockKey> LandmarkSystem::states(const SlidingWindow& window) const {
  std::set<BlockKey> states;
  for (std::size_t k = 0; k < seeing_.size(); ++k)
    if (seeing_[k])
      states.insert({{BlockKey::kPose, window.frames[k].id}, {BlockKey::kExtrinsics, 0}, {BlockKey::kCorrection, 0}});
  for (const auto& [id, place] : layout_.directions) states.insert({BlockKey::kDirection, id});
  return states;
}

double LandmarkSystem::cost(const std::vector<CameraView>& views) const {
  double sum = 0;
  each([&](const auto& landmark) { sum += costOf(landmark, views, correction_, layout_); });
  for (const DirectionSighting& s : vanishing_) sum += costOf(s, views, correction_, layout_);
  return sum;
}

double LandmarkSystem::linearise(const std::vector<CameraView>& views) {
  direct_.H.setZero(layout_.size(), layout_.size());
  direct_.b.setZero(layout_.size());
  double sum = 0;
  each([&](auto& landmark) { sum += lineariseOne(landmark, views, correction_, layout_, direct_); });
  for (const DirectionSighting& s : vanishing_) sum += lineariseOne(s, views, correction_, layout_, direct_);
  return sum;
}

CameraEquations LandmarkSystem::eliminate(double damping) {
  CameraEquations eq = direct_;
  each([&](auto& landmark) { eliminateOne(landmark, damping, layout_, eq); });
  return eq;
}

double LandmarkSystem::backSubstitute(const Eigen::VectorXd& camera_step, double damping) {
  double decrease = 0;
  each([&](auto& landmark) { decrease += backSubstituteOne(landmark, camera_step, damping, layout_); });
  return decrease;
}

void LandmarkSystem::apply(std::vector<double>& saved) {
  const auto move = [&](auto& landmark, BlockKey::Kind kind, int size) {
    saved.insert(saved.end(), landmark.block, landmark.block + size);
    manifoldOf(kind)->Plus(saved.data() + saved.size() - static_cast<std::size_t>(size), landmark.step.data(),
                           landmark.block);
  };
  for (auto& point : points_) move(point, BlockKey::kPoint, kPointSize);
  for (auto& line : lines_) move(line, BlockKey::kLine, kLineSize);
}

std::size_t LandmarkSystem::revert(const std::vector<double>& saved, std::size_t at) {
  const auto restore = [&](auto& landmark, int size) {
    std::copy_n(saved.begin() + static_cast<std::ptrdiff_t>(at), size, landmark.block);
    at += static_cast<std::size_t>(size);
  };
  for (auto& point : points_) restore(point, kPointSize);
  for (auto& line : lines_) restore(line, kLineSize);
  return at;
}

}  // namespace lintel
