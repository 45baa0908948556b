// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ReducedSystem.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "solver/SparseCholesky.h"

namespace lintel {

namespace {

std::map<FrameId, int> placeCameras(const SlidingWindow& window) {
  std::map<FrameId, int> places;
  for (const WindowFrame& frame : window.frames) places.emplace(frame.id, static_cast<int>(places.size()));
  return places;
}

constexpr double kLeastDamping = 1e-6;  // times the damping: the least that is added to a diagonal

}  // namespace

bool comesBefore(const BlockKey& a, const BlockKey& b) {
  const auto rank = [](const BlockKey& key) {
    const int kind = key.kind == BlockKey::kMotion ? -1 : static_cast<int>(key.kind);
    const bool of_frame = key.kind == BlockKey::kMotion || key.kind == BlockKey::kPose;
    return std::make_tuple(kind, of_frame ? ~key.id : key.id);  // the newest frame has the highest id
  };
  return rank(a) < rank(b);
}

ReducedSystem::ReducedSystem(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first,
                             const std::set<BlockKey>& frozen, const std::set<BlockKey>& staying)
    : window_(window), landmarks_(window, factors, placeCameras(window), staying) {
  placeStates(first, frozen);
}

void ReducedSystem::placeStates(const std::set<BlockKey>& first, const std::set<BlockKey>& frozen) {
  std::set<BlockKey> all = landmarks_.states(window_);
  for (const Factor* factor : landmarks_.others()) all.insert(factor->blocks.begin(), factor->blocks.end());
  for (const BlockKey& key : frozen) all.erase(key);
  states_.blocks.assign(all.begin(), all.end());
  std::sort(states_.blocks.begin(), states_.blocks.end(), comesBefore);
  std::stable_partition(states_.blocks.begin(), states_.blocks.end(),
                        [&first](const BlockKey& key) { return first.count(key) > 0; });
  Eigen::Index size = 0;
  for (const BlockKey& key : states_.blocks) {
    states_.offsets.push_back(size);
    size += manifoldOf(key.kind)->TangentSize();
  }
  states_.offsets.push_back(size);
}

Eigen::Index ReducedSystem::offsetOf(const BlockKey& key) const {
  const auto it = std::find(states_.blocks.begin(), states_.blocks.end(), key);
  return it == states_.blocks.end() ? -1 : states_.offsets[static_cast<std::size_t>(it - states_.blocks.begin())];
}

std::vector<CameraView> ReducedSystem::views(bool derivatives) const {
  std::vector<CameraView> result;
  for (const WindowFrame& frame : window_.frames)
    result.emplace_back(frame.pose.data(), window_.extrinsics.data(), window_.correction.data(),
                        landmarks_.motion(static_cast<int>(result.size())), derivatives);
  return result;
}

double ReducedSystem::cost() const {
  double sum = landmarks_.cost(views(false));
  std::vector<const double*> blocks;
  Eigen::VectorXd r;
  double weight;
  for (const Factor* factor : landmarks_.others()) {
    blocks.clear();
    for (const BlockKey& key : factor->blocks) blocks.push_back(window_.block(key));
    r.resize(factor->cost->num_residuals());
    factor->cost->Evaluate(blocks.data(), r.data(), nullptr);
    sum += robustCost(factor->loss, r.squaredNorm(), weight);
  }
  return sum;
}

CameraChain ReducedSystem::chain() const {
  const CameraLayout& layout = landmarks_.layout();
  StatePlaces places;
  for (const WindowFrame& frame : window_.frames) places.poses.push_back(offsetOf({BlockKey::kPose, frame.id}));
  places.extrinsics = offsetOf({BlockKey::kExtrinsics, 0});
  places.correction = offsetOf({BlockKey::kCorrection, 0});
  for (const BlockKey& key : layout.kept) places.kept.push_back(offsetOf(key));
  return {layout, views_, places};
}

void ReducedSystem::hold(const BlockKey& key, int first, int count) {
  const Eigen::Index at = offsetOf(key);
  for (int i = 0; at >= 0 && i < count; ++i) held_.push_back(at + first + i);
}

void ReducedSystem::leaveOutHeld(Eigen::MatrixXd& H, Eigen::VectorXd& b) const {
  constexpr double kKnown = 1e18;  // beside zeros: a sigma of 1e-9 that no rounding error gets from
  for (const Eigen::Index row : held_) {
    H.row(row).setZero();
    H.col(row).setZero();
    H(row, row) = kKnown;
    b[row] = 0;
  }
}

NormalEquations ReducedSystem::eliminate() {
  NormalEquations result = states_;
  chain().add(landmarks_.eliminate(0), result.H, result.b);
  leaveOutHeld(result.H, result.b);
  result.H.triangularView<Eigen::StrictlyUpper>() = result.H.transpose();
  return result;
}

bool ReducedSystem::solve(double damping) {
  const CameraChain chain = this->chain();
  Eigen::MatrixXd& H = factor_ = states_.H;
  Eigen::VectorXd b = states_.b;
  chain.add(landmarks_.eliminate(damping), H, b);
  leaveOutHeld(H, b);
  const Eigen::VectorXd added = damping * H.diagonal().cwiseMax(kLeastDamping);
  H.diagonal() += added;
  if (!factoriseSparse(H)) return false;
  step_ = -H.triangularView<Eigen::Lower>().solve(b);
  states_move_ = step_.norm();  // before the turn back from the factor's coordinates
  H.transpose().triangularView<Eigen::Upper>().solveInPlace(step_);
  if (!step_.allFinite()) return false;

  Eigen::VectorXd gradient = states_.b;
  chain.addGradient(landmarks_.direct().b, gradient);
  model_decrease_ = 0.5 * step_.dot(added.cwiseProduct(step_) - gradient) +
                    landmarks_.backSubstitute(chain.cameraStep(step_), damping);
  return true;
}

/// About the oldest frame's position: the change of scale that explains most of the positions' steps. A turn of them
/// all has no part in it.
ScaleStep ReducedSystem::scaleStep() const {
  const auto stepOf = [&](const WindowFrame& frame) -> Eigen::Vector3d {
    const Eigen::Index at = offsetOf({BlockKey::kPose, frame.id});
    return at < 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(step_.segment<3>(at));
  };
  const WindowFrame& oldest = window_.frames.front();
  const Eigen::Vector3d centre_w = oldest.T_w_b().p;
  double along = 0, square = 0;
  for (const WindowFrame& frame : window_.frames) {
    const Eigen::Vector3d p = frame.T_w_b().p - centre_w;
    along += p.dot(stepOf(frame) - stepOf(oldest));
    square += p.squaredNorm();
  }
  constexpr double kLeastChange = 1e-3;  // a linear step leaves a smaller one by a millionth
  if (!(std::abs(along) > kLeastChange * square)) return {centre_w, 0};
  // At rest, positions are noise, and so would be the change; without parallax, images do not see it either.
  constexpr double kLeastParallax_rad = 0.01;
  const double mean_square = square / static_cast<double>(window_.frames.size());
  const bool moves = std::sqrt(mean_square) > kLeastParallax_rad * landmarks_.medianDistance(centre_w);
  return {centre_w, moves ? along / square : 0};
}

void ReducedSystem::apply() {
  const ScaleStep scale = scaleStep();
  saved_.clear();
  for (std::size_t i = 0; i < states_.blocks.size(); ++i) {
    const BlockKey& key = states_.blocks[i];
    const auto manifold = manifoldOf(key.kind);
    double* block = window_.block(key);
    const auto at = static_cast<std::ptrdiff_t>(saved_.size());
    saved_.insert(saved_.end(), block, block + manifold->AmbientSize());
    const double* step = step_.data() + states_.offsets[i];
    if (isLandmark(key))
      scale.plus(key.kind, originOf(window_, key), saved_.data() + at, step, block);
    else
      manifold->Plus(saved_.data() + at, step, block);
  }
  landmarks_.apply(scale, saved_);
}

void ReducedSystem::revert() {
  std::size_t at = 0;
  for (const BlockKey& key : states_.blocks) {
    const auto size = static_cast<std::size_t>(manifoldOf(key.kind)->AmbientSize());
    std::copy_n(saved_.begin() + static_cast<std::ptrdiff_t>(at), size, window_.block(key));
    at += size;
  }
  landmarks_.revert(saved_, at);
}

}  // namespace lintel
