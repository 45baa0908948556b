// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: what the adjustment leaves open.
#include <algorithm>
#include <cmath>

#include "BatchProblem.h"
#include "CameraErrors.h"
#include "ReducedSystem.h"

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

}  // namespace

std::vector<CameraErrors> BatchProblem::drawErrors() {
  std::vector<double*> blocks;
  std::vector<int> tiles{kPoseTangent};
  for (std::size_t i = 0; i < points_.size(); ++i) blocks.push_back(at(points_at_ + i * kPointSize));
  for (std::size_t i = 0; i < lines_.size(); ++i) blocks.push_back(at(lines_at_ + i * kLineSize));
  blocks.push_back(at(extrinsics_at_));
  for (std::size_t i = 0; i < stretches(); ++i) {
    blocks.push_back(at(correctionOf(i)));
    tiles.push_back(kCorrectionSize);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    blocks.push_back(at(directions_at_ + g * kDirectionSize));
    tiles.push_back(kDirectionTangent);
  }
  std::vector<std::size_t> anchors;
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    if (!isAnchor(k)) continue;
    anchors.push_back(k);
    blocks.insert(blocks.end(), {at(poseAt(k)), at(motionAt(k))});
    tiles.push_back(kPoseTangent + kMotionSize);
  }
  for (std::size_t i = 0; i < meanBiases(); ++i) {
    blocks.push_back(at(meanBiasOf(i)));
    tiles.push_back(kMeanBiasSize);
  }
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  options.num_threads = 1;
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  if (!problem_->Evaluate(options, nullptr, &residuals, nullptr, &jacobian)) return {};
  ReducedSystem system(points_.size() + lines_.size(), tiles);
  system.add(jacobian, viewWeights(jacobian, residuals));
  return cameraErrors(system.draw(kErrorDraws), anchors);
}

/// Those of all keyframes, from draws of calibration, directions and anchors.
std::vector<CameraErrors> BatchProblem::cameraErrors(const Eigen::MatrixXd& drawn,
                                                     const std::vector<std::size_t>& anchors) const {
  if (drawn.size() == 0) return {};
  std::vector<Pose> T_w_b;
  std::vector<std::int64_t> t_ns;
  for (const RetiredKeyframe& keyframe : material_.keyframes)
    T_w_b.push_back(keyframe.T_w_b), t_ns.push_back(keyframe.t_ns);
  BodyErrors body(T_w_b, t_ns);
  Eigen::Index row = kPoseTangent + static_cast<Eigen::Index>(stretches()) * kCorrectionSize +
                     static_cast<Eigen::Index>(groups_.size()) * kDirectionTangent;
  for (const std::size_t k : anchors) {
    body.set(k, drawn.middleRows<kPoseTangent>(row));
    row += kPoseTangent + kMotionSize;
  }
  body.interpolate(anchors);
  body.align();
  return body.ofCamera(material_.rig.T_b_c, drawn.topRows<kPoseTangent>());
}

std::vector<double> BatchProblem::viewWeights(const ceres::CRSMatrix& jacobian,
                                              const std::vector<double>& residuals) const {
  const auto points = static_cast<int>(points_.size()), landmarks = points + static_cast<int>(lines_.size());
  const int first = 4 * landmarks;
  // A view's rows are those with a landmark and a camera.
  std::vector<int> landmark_of(residuals.size(), -1);
  for (int row = 0; row < jacobian.num_rows; ++row) {
    int landmark = -1;
    bool camera = false;
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      if (jacobian.cols[i] < first) landmark = jacobian.cols[i] / 4;
      camera |= jacobian.cols[i] >= first && jacobian.cols[i] < first + kPoseTangent;
    }
    if (camera) landmark_of[static_cast<std::size_t>(row)] = landmark;
  }
  std::vector<std::vector<Eigen::Vector2d>> views(static_cast<std::size_t>(landmarks));
  for (std::size_t row = 0; row + 1 < residuals.size(); ++row) {
    if (landmark_of[row] < 0) continue;
    views[static_cast<std::size_t>(landmark_of[row])].emplace_back(residuals[row], residuals[row + 1]);
    ++row;
  }
  ViewStatistics of_points, of_lines;
  for (int i = 0; i < landmarks; ++i) (i < points ? of_points : of_lines).add(views[static_cast<std::size_t>(i)]);
  const double point_weight = 1 / of_points.excess(), line_weight = 1 / of_lines.excess();
  std::vector<double> weights(residuals.size(), 1.0);
  for (std::size_t row = 0; row < residuals.size(); ++row)
    if (landmark_of[row] >= 0) weights[row] = landmark_of[row] < points ? point_weight : line_weight;
  return weights;
}

}  // namespace lintel
