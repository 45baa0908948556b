// SPDX-License-Identifier: BSD-3-Clause
#include "solver/CameraChain.h"

namespace lintel {

namespace {

using CameraBlock = Eigen::Matrix<double, kCameraTangent, kCameraTangent>;

/// A block of a symmetric matrix of which only the lower triangle is there.
CameraBlock cameraBlock(const CameraEquations& cameras, Eigen::Index row, Eigen::Index column) {
  if (row > column) return cameras.H.block<kCameraTangent, kCameraTangent>(row, column);
  if (row < column) return cameras.H.block<kCameraTangent, kCameraTangent>(column, row).transpose();
  return cameras.H.block<kCameraTangent, kCameraTangent>(row, row).selfadjointView<Eigen::Lower>();
}

/// Adds a block to the lower triangle, wherever it lies; nothing where a state is a constant.
template <class Matrix>
void put(const Eigen::MatrixBase<Matrix>& block, Eigen::Index row, Eigen::Index column, Eigen::MatrixXd& H) {
  if (row < 0 || column < 0) return;
  if (row >= column)
    H.block<Matrix::RowsAtCompileTime, Matrix::ColsAtCompileTime>(row, column, block.rows(), block.cols()) += block;
  else
    H.block<Matrix::ColsAtCompileTime, Matrix::RowsAtCompileTime>(column, row, block.cols(), block.rows()) +=
        block.transpose();
}

}  // namespace

CameraChain::CameraChain(const CameraLayout& layout, const std::vector<CameraView>& views, const StatePlaces& places)
    : layout_(layout), views_(views), poses_(places.poses) {
  for (const CameraView& view : views) shared_.emplace_back() << view.d_extrinsics, view.d_offset;
  if (places.extrinsics >= 0) addPiece({0, kPoseTangent, places.extrinsics});
  if (places.correction >= 0) {
    addPiece({kPoseTangent, 1, places.correction + kTimeOffsetAt});
    addPiece({kShared, kSightingCorrection, places.correction});
  }
  for (std::size_t i = 0; i < places.kept.size(); ++i) {
    const Eigen::Index from = layout.kept_offsets[i], size = layout.kept_offsets[i + 1] - from;
    if (places.kept[i] >= 0) addPiece({kShared + kSightingCorrection + from, size, places.kept[i]});
  }
}

/// Joined with the one before where it goes on with it on both sides: fewer and larger blocks.
void CameraChain::addPiece(const Piece& piece) {
  if (!tail_.empty() && tail_.back().at + tail_.back().size == piece.at &&
      tail_.back().state + tail_.back().size == piece.state)
    tail_.back().size += piece.size;
  else
    tail_.push_back(piece);
}

void CameraChain::add(const CameraEquations& cameras, Eigen::MatrixXd& H, Eigen::VectorXd& b) const {
  addPoses(cameras, H);
  addTail(cameras, H);
  addGradient(cameras.b, b);
}

void CameraChain::addPoses(const CameraEquations& cameras, Eigen::MatrixXd& H) const {
  for (int c = 0; c < layout_.cameras; ++c)
    for (int r = c; r < layout_.cameras; ++r) {
      const auto row = static_cast<std::size_t>(r), column = static_cast<std::size_t>(c);
      const CameraBlock right = cameraBlock(cameras, layout_.camera(r), layout_.camera(c)) * views_[column].d_pose;
      const CameraBlock block = views_[row].d_pose.transpose() * right;
      put(block, poses_[row], poses_[column], H);
    }
}

void CameraChain::addTail(const CameraEquations& cameras, Eigen::MatrixXd& H) const {
  const Eigen::Index rest = layout_.correction(), n = layout_.size() - rest;
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(tailSize(), tailSize());
  Eigen::Matrix<double, Eigen::Dynamic, kPoseTangent> by_pose(tailSize(), kPoseTangent);
  square.bottomRightCorner(n, n) = cameras.H.bottomRightCorner(n, n);
  for (int k = 0; k < layout_.cameras; ++k) {
    const auto place = static_cast<std::size_t>(k);
    SharedJacobian seen = SharedJacobian::Zero();  // this camera's rows, times the others' chains
    for (int j = 0; j < layout_.cameras; ++j)
      seen.noalias() +=
          cameraBlock(cameras, layout_.camera(k), layout_.camera(j)) * shared_[static_cast<std::size_t>(j)];
    const auto below = cameras.H.block(rest, layout_.camera(k), n, kCameraTangent);
    by_pose.topRows<kShared>() = seen.transpose() * views_[place].d_pose;
    by_pose.bottomRows(n) = below.lazyProduct(views_[place].d_pose);
    for (const Piece& piece : tail_) put(by_pose.middleRows(piece.at, piece.size), piece.state, poses_[place], H);
    square.topLeftCorner<kShared, kShared>() += shared_[place].transpose() * seen;
    square.bottomLeftCorner(n, static_cast<Eigen::Index>(kShared)) += below.lazyProduct(shared_[place]);
  }
  for (const Piece& row : tail_)
    for (const Piece& column : tail_)
      if (row.at >= column.at) put(square.block(row.at, column.at, row.size, column.size), row.state, column.state, H);
}

void CameraChain::addGradient(const Eigen::VectorXd& b_cameras, Eigen::VectorXd& b) const {
  Eigen::VectorXd tail(tailSize());
  tail.head<kShared>().setZero();
  tail.tail(layout_.size() - layout_.correction()) = b_cameras.tail(layout_.size() - layout_.correction());
  for (int k = 0; k < layout_.cameras; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const Eigen::Matrix<double, kCameraTangent, 1> own = b_cameras.segment<kCameraTangent>(layout_.camera(k));
    if (poses_[place] >= 0) b.segment<kPoseTangent>(poses_[place]) += views_[place].d_pose.transpose() * own;
    tail.head<kShared>() += shared_[place].transpose() * own;
  }
  for (const Piece& piece : tail_) b.segment(piece.state, piece.size) += tail.segment(piece.at, piece.size);
}

Eigen::VectorXd CameraChain::cameraStep(const Eigen::VectorXd& step) const {
  Eigen::VectorXd tail = Eigen::VectorXd::Zero(tailSize()), result(layout_.size());
  for (const Piece& piece : tail_) tail.segment(piece.at, piece.size) = step.segment(piece.state, piece.size);
  for (int k = 0; k < layout_.cameras; ++k) {
    const auto place = static_cast<std::size_t>(k);
    Eigen::Matrix<double, kCameraTangent, 1> own = shared_[place] * tail.head<kShared>();
    if (poses_[place] >= 0) own += views_[place].d_pose * step.segment<kPoseTangent>(poses_[place]);
    result.segment<kCameraTangent>(layout_.camera(k)) = own;
  }
  result.tail(layout_.size() - layout_.correction()) = tail.tail(layout_.size() - layout_.correction());
  return result;
}

}  // namespace lintel
