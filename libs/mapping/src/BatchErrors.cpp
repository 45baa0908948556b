// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: what the adjustment leaves open.
#include <algorithm>
#include <cmath>

#include "BatchProblem.h"
#include "CameraErrors.h"
#include "ReducedSystem.h"
#include "lintel/core/FreeMemory.h"

namespace lintel {

namespace {

/// Residuals of one landmark follow each other in time, two of each view, and are alike from view to view: the same
/// shade beside an edge, the same corner in a patch. Their sum says as much as that of a fraction of independent ones.
class ViewStatistics {
 public:
  void add(const std::vector<Eigen::Vector2d>& residuals) {
    for (std::size_t i = 0; i < residuals.size(); ++i)
      for (std::size_t lag = 0; lag <= kLags && lag <= i; ++lag) {
        products_[lag] += residuals[i].dot(residuals[i - lag]);
        ++counts_[lag];
      }
    lost_ += kLandmarkFreedom;
  }

  /// Variance of a residual times the number of them that say as much as one independent one.
  double excess() const {
    if (2 * counts_[0] <= lost_) return 1;
    const double variance = products_[0] / (2 * counts_[0] - lost_);
    double time = 1;
    for (std::size_t lag = 1; lag <= kLags && counts_[lag] > 0; ++lag) {
      const double correlation = products_[lag] / counts_[lag] * counts_[0] / products_[0];
      if (!(correlation > kLeastCorrelation)) break;
      time += 2 * correlation;
    }
    return variance * time;
  }

 private:
  static constexpr std::size_t kLags = 20;
  static constexpr double kLeastCorrelation = 0.05, kLandmarkFreedom = 3.5;
  double products_[kLags + 1] = {}, counts_[kLags + 1] = {}, lost_ = 0;
};

constexpr std::size_t kMostBlocks = 10000;  // of residuals whose Jacobian is in memory at a time

}  // namespace

/// Blocks whose errors are drawn, behind those of the landmarks; `tiles`: their tangents in the tiles of ReducedSystem.
std::vector<double*> BatchProblem::blocksOfErrors(const std::vector<std::size_t>& anchors, std::vector<int>& tiles) {
  std::vector<double*> blocks;
  for (std::size_t i = 0; i < points_.size(); ++i) blocks.push_back(at(points_at_ + i * kPointSize));
  for (std::size_t i = 0; i < lines_.size(); ++i) blocks.push_back(at(lines_at_ + i * kLineSize));
  blocks.push_back(at(extrinsics_at_));
  tiles.push_back(kPoseTangent);
  for (std::size_t i = 0; i < stretches(); ++i) {
    blocks.push_back(at(correctionOf(i)));
    tiles.push_back(kCorrectionSize);
  }
  for (const std::size_t k : anchors) {
    blocks.insert(blocks.end(), {at(poseAt(k)), at(motionAt(k))});
    tiles.insert(tiles.end(), {kPoseTangent, kMotionSize});  // poses meet in many tiles, motions in few
  }
  for (std::size_t i = 0; i < meanBiases(); ++i) {
    blocks.push_back(at(meanBiasOf(i)));
    tiles.push_back(kMeanBiasSize);
  }
  blocks.push_back(at(axes_at_));
  tiles.push_back(kAxesSize);
  for (std::size_t i = 0; i < carriageScales(); ++i) {
    blocks.push_back(at(carriageScaleOf(i)));
    tiles.push_back(kCarriageScaleSize);
  }
  return blocks;
}

std::vector<CameraErrors> BatchProblem::drawErrors() {
  std::vector<std::size_t> anchors;
  for (std::size_t k = 0; k < anchors_.size(); ++k)
    if (isAnchor(k)) anchors.push_back(k);
  std::vector<int> tiles;
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocksOfErrors(anchors, tiles);
  options.num_threads = 1;
  const std::size_t points = points_.size(), landmarks = points + lines_.size();
  ReducedSystem system(landmarks, tiles);
  std::vector<ceres::ResidualBlockId> residuals;
  problem_->GetResidualBlocks(&residuals);
  const auto add = [&](std::size_t from, std::size_t to, double weight) {
    if (from == to) return true;
    options.residual_blocks.assign(residuals.begin() + static_cast<std::ptrdiff_t>(from),
                                   residuals.begin() + static_cast<std::ptrdiff_t>(to));
    ceres::CRSMatrix jacobian;
    if (!problem_->Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) return false;
    system.add(jacobian, weight);
    return true;
  };
  const auto [point_weight, line_weight] = viewWeights(residuals);
  if (!add(0, landmark_residuals_.front(), 1)) return {};
  for (std::size_t i = 0; i < landmarks;) {  // a part of the points or of the lines at a time
    const std::size_t end = i < points ? points : landmarks;
    std::size_t j = i + 1;
    while (j < end && landmark_residuals_[j + 1] - landmark_residuals_[i] <= kMostBlocks) ++j;
    if (!add(landmark_residuals_[i], landmark_residuals_[j], i < points ? point_weight : line_weight)) return {};
    i = j;
  }
  release();
  return cameraErrors(system.draw(kErrorDraws), anchors);
}

/// All residuals: what follows needs the memory.
void BatchProblem::release() {
  problem_.reset();
  carried_views_.clear();
  own_factors_.clear();
  point_factors_.clear();
  line_factors_.clear();
  anchor_imu_factors_.clear();
  returnFreeMemory();
}

/// Those of all keyframes, from draws of calibration and anchors.
std::vector<CameraErrors> BatchProblem::cameraErrors(const Eigen::MatrixXd& drawn,
                                                     const std::vector<std::size_t>& anchors) const {
  if (drawn.size() == 0) return {};
  std::vector<Pose> T_w_b;
  std::vector<std::int64_t> t_ns;
  for (const RetiredKeyframe& keyframe : material_.keyframes)
    T_w_b.push_back(keyframe.T_w_b), t_ns.push_back(keyframe.t_ns);
  BodyErrors body(T_w_b, t_ns);
  Eigen::Index row = kPoseTangent + static_cast<Eigen::Index>(stretches()) * kCorrectionSize;
  for (const std::size_t k : anchors) {
    body.set(k, drawn.middleRows<kPoseTangent>(row));
    row += kPoseTangent + kMotionSize;
  }
  body.interpolate(anchors);
  body.align();
  return body.ofCamera(material_.rig.T_b_c, drawn.topRows<kPoseTangent>());
}

/// How much a view of a point and one of a line count.
std::pair<double, double> BatchProblem::viewWeights(const std::vector<ceres::ResidualBlockId>& blocks) const {
  const std::size_t first = landmark_residuals_.front();
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks.assign(blocks.begin() + static_cast<std::ptrdiff_t>(first),
                                 blocks.begin() + static_cast<std::ptrdiff_t>(landmark_residuals_.back()));
  options.num_threads = 1;
  std::vector<double> residuals;
  if (options.residual_blocks.empty() || !problem_->Evaluate(options, nullptr, &residuals, nullptr, nullptr))
    return {1, 1};
  ViewStatistics of_points, of_lines;
  for (std::size_t i = 0; i + 1 < landmark_residuals_.size(); ++i) {
    const bool is_point = i < points_.size();
    std::vector<Eigen::Vector2d> views;
    // the first of a point holds its length
    for (std::size_t k = landmark_residuals_[i] + (is_point ? 1 : 0); k < landmark_residuals_[i + 1]; ++k)
      views.emplace_back(Eigen::Vector2d::Map(&residuals[2 * (k - first)]));
    (is_point ? of_points : of_lines).add(views);
  }
  return {1 / of_points.excess(), 1 / of_lines.excess()};
}

}  // namespace lintel
