// SPDX-License-Identifier: BSD-3-Clause
#include "ReducedSystem.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace lintel {

namespace {

std::map<FrameId, int> placeCameras(const SlidingWindow& window) {
  std::map<FrameId, int> places;
  for (const WindowFrame& frame : window.frames) places.emplace(frame.id, static_cast<int>(places.size()));
  return places;
}

constexpr double kLeastDamping = 1e-6;

}  // namespace

ReducedSystem::ReducedSystem(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first,
                             const std::set<BlockKey>& frozen)
    : window_(window), landmarks_(window, factors, placeCameras(window)) {
  for (const Factor& factor : factors)
    if (!LandmarkSystem::isVision(factor)) others_.push_back(factor);
  placeStates(factors, first, frozen);
}

void ReducedSystem::placeStates(const std::vector<Factor>& factors, const std::set<BlockKey>& first,
                                const std::set<BlockKey>& frozen) {
  std::set<BlockKey> all;
  for (const Factor& factor : factors)
    for (const BlockKey& key : factor.blocks)
      if (key.kind != BlockKey::kPoint && key.kind != BlockKey::kLine && frozen.count(key) == 0) all.insert(key);
  for (const bool wanted : {true, false})
    for (const BlockKey& key : all)
      if ((first.count(key) > 0) == wanted) states_.blocks.push_back(key);
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
  for (const Factor& factor : others_) {
    blocks.clear();
    for (const BlockKey& key : factor.blocks) blocks.push_back(window_.block(key));
    r.resize(factor.cost->num_residuals());
    factor.cost->Evaluate(blocks.data(), r.data(), nullptr);
    sum += 0.5 * r.squaredNorm();
  }
  return sum;
}

double ReducedSystem::linearise() {
  const Eigen::Index n = states_.offsets.back();
  states_.H.setZero(n, n);
  states_.b.setZero(n);
  double sum = 0;
  for (const Factor& factor : others_) {
    const auto* prior = dynamic_cast<const PriorFactor*>(factor.cost);
    sum += prior ? addPrior(factor, *prior) : addOther(factor);
  }
  views_ = views(true);
  return sum + landmarks_.linearise(views_);
}

double ReducedSystem::addOther(const Factor& factor) {
  const int rows = factor.cost->num_residuals();
  std::vector<const double*> blocks;
  std::vector<RowMajorMatrix> ambient;
  std::vector<double*> pointers;
  for (std::size_t i = 0; i < factor.blocks.size(); ++i) {
    blocks.push_back(window_.block(factor.blocks[i]));
    ambient.emplace_back(rows, factor.cost->parameter_block_sizes()[i]);
  }
  for (RowMajorMatrix& m : ambient) pointers.push_back(m.data());
  Eigen::VectorXd r(rows);
  factor.cost->Evaluate(blocks.data(), r.data(), pointers.data());
  std::vector<Eigen::MatrixXd> J;
  std::vector<Eigen::Index> at;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto manifold = manifoldOf(factor.blocks[i].kind);
    RowMajorMatrix plus(manifold->AmbientSize(), manifold->TangentSize());
    manifold->PlusJacobian(blocks[i], plus.data());
    J.emplace_back(ambient[i].lazyProduct(plus));
    at.push_back(offsetOf(factor.blocks[i]));
  }
  for (std::size_t i = 0; i < J.size(); ++i) {
    if (at[i] < 0) continue;
    states_.b.segment(at[i], J[i].cols()).noalias() += J[i].transpose() * r;
    for (std::size_t j = 0; j < J.size(); ++j)
      if (at[j] >= 0 && at[j] <= at[i])
        states_.H.block(at[i], at[j], J[i].cols(), J[j].cols()).noalias() += J[i].transpose() * J[j];
  }
  return 0.5 * r.squaredNorm();
}

/// A prior's information does not change, only the tangent spaces turn: H = C' A'A C.
double ReducedSystem::addPrior(const Factor& factor, const PriorFactor& prior) {
  std::vector<const double*> blocks;
  for (const BlockKey& key : factor.blocks) blocks.push_back(window_.block(key));
  const Eigen::VectorXd r = prior.constant() + prior.root() * prior.difference(blocks.data());
  const Eigen::VectorXd gradient = prior.root().transpose() * r;
  std::vector<Eigen::MatrixXd> C;
  std::vector<Eigen::Index> from, to;
  Eigen::Index end = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const PriorBlock& block = prior.blocks()[i];
    RowMajorMatrix plus(block.manifold->AmbientSize(), block.manifold->TangentSize());
    block.manifold->PlusJacobian(blocks[i], plus.data());
    C.emplace_back(block.manifold->differenceJacobian(blocks[i], block.linearisation.data()).lazyProduct(plus));
    from.push_back(end);
    to.push_back(offsetOf(factor.blocks[i]));
    end += C[i].cols();
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (to[i] < 0) continue;
    states_.b.segment(to[i], C[i].cols()) += C[i].transpose() * gradient.segment(from[i], C[i].cols());
    for (std::size_t j = 0; j < blocks.size(); ++j)
      if (to[j] >= 0 && to[j] <= to[i])
        states_.H.block(to[i], to[j], C[i].cols(), C[j].cols()) +=
            C[i].transpose() * prior.information().block(from[i], from[j], C[i].cols(), C[j].cols()) * C[j];
  }
  return 0.5 * r.squaredNorm();
}

std::vector<ReducedSystem::Chain> ReducedSystem::chains() const {
  const CameraLayout& layout = landmarks_.layout();
  std::vector<Chain> result;
  const auto add = [&](const BlockKey& key, Eigen::Index within, Eigen::Index row, Eigen::MatrixXd G) {
    if (const Eigen::Index at = offsetOf(key); at >= 0) result.push_back({row, at + within, std::move(G)});
  };
  for (int k = 0; k < layout.cameras; ++k) {
    const CameraView& view = views_[static_cast<std::size_t>(k)];
    const FrameId frame = window_.frames[static_cast<std::size_t>(k)].id;
    add({BlockKey::kPose, frame}, 0, layout.camera(k), view.d_pose);
    add({BlockKey::kExtrinsics, 0}, 0, layout.camera(k), view.d_extrinsics);
    add({BlockKey::kCorrection, 0}, kTimeOffsetAt, layout.camera(k), view.d_offset);
  }
  add({BlockKey::kCorrection, 0}, 0, layout.intrinsics(), Eigen::MatrixXd::Identity(kIntrinsicsSize, kIntrinsicsSize));
  for (const auto& [id, place] : layout.directions)
    add({BlockKey::kDirection, id}, 0, layout.direction(place),
        Eigen::MatrixXd::Identity(kDirectionTangent, kDirectionTangent));
  return result;
}

void ReducedSystem::addVision(const std::vector<Chain>& chains, const CameraEquations& vision, Eigen::MatrixXd& H,
                              Eigen::VectorXd& b) {
  const Eigen::MatrixXd full = vision.H.selfadjointView<Eigen::Lower>();
  Eigen::MatrixXd rows;
  for (const Chain& right : chains) {
    rows.noalias() = full.middleCols(right.row, right.G.rows()).lazyProduct(right.G);
    for (const Chain& left : chains)
      if (left.column >= right.column)
        H.block(left.column, right.column, left.G.cols(), right.G.cols()) +=
            left.G.transpose().lazyProduct(rows.middleRows(left.row, left.G.rows()));
    b.segment(right.column, right.G.cols()) += right.G.transpose() * vision.b.segment(right.row, right.G.rows());
  }
}

NormalEquations ReducedSystem::eliminate() {
  NormalEquations result = states_;
  addVision(chains(), landmarks_.eliminate(0), result.H, result.b);
  result.H.triangularView<Eigen::StrictlyUpper>() = result.H.transpose();
  return result;
}

bool ReducedSystem::solve(double damping) {
  const std::vector<Chain> all = chains();
  Eigen::MatrixXd H = states_.H;
  Eigen::VectorXd b = states_.b;
  addVision(all, landmarks_.eliminate(damping), H, b);
  const Eigen::VectorXd added = damping * H.diagonal().cwiseMax(kLeastDamping);
  H.diagonal() += added;
  const Eigen::LLT<Eigen::MatrixXd> llt(H);
  if (llt.info() != Eigen::Success) return false;
  step_ = -llt.solve(b);
  if (!step_.allFinite()) return false;
  states_move_ = (llt.matrixU() * step_).norm();

  const CameraLayout& layout = landmarks_.layout();
  Eigen::VectorXd camera_step = Eigen::VectorXd::Zero(layout.size());
  Eigen::VectorXd gradient = states_.b;
  for (const Chain& c : all) {
    camera_step.segment(c.row, c.G.rows()) += c.G * step_.segment(c.column, c.G.cols());
    gradient.segment(c.column, c.G.cols()) += c.G.transpose() * landmarks_.direct().b.segment(c.row, c.G.rows());
  }
  model_decrease_ = 0.5 * step_.dot(added.cwiseProduct(step_) - gradient) + landmarks_.backSubstitute(camera_step, damping);
  return true;
}

void ReducedSystem::apply() {
  saved_.clear();
  for (std::size_t i = 0; i < states_.blocks.size(); ++i) {
    const auto manifold = manifoldOf(states_.blocks[i].kind);
    double* block = window_.block(states_.blocks[i]);
    const auto at = static_cast<std::ptrdiff_t>(saved_.size());
    saved_.insert(saved_.end(), block, block + manifold->AmbientSize());
    manifold->Plus(saved_.data() + at, step_.data() + states_.offsets[i], block);
  }
  landmarks_.apply(saved_);
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
