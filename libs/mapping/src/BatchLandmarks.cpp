// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: the residuals of points, lines and groups.
#include <algorithm>
#include <cmath>

#include "BatchProblem.h"
#include "CarriedView.h"
#include "Evidence.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

constexpr std::size_t kJoinedViews = 12;

/// Holds the length of a homogeneous point, which is not observable. Instead of a manifold: all landmarks then have
/// tangents of four and residuals of two, for which Ceres has code of fixed size (and hence the second, empty
/// residual).
class UnitLength final : public ceres::SizedCostFunction<2, kPointSize> {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    constexpr double kWeight = 100;  // holds the length to about a hundredth; no other residual depends on it
    const Eigen::Map<const PointBlock> x(parameters[0]);
    residuals[0] = kWeight * (x.squaredNorm() - 1);
    residuals[1] = 0;
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 2, kPointSize, Eigen::RowMajor>> J(jacobians[0]);
      J << 2 * kWeight * x.transpose(), Eigen::RowVector4d::Zero();
    }
    return true;
  }
};

/// The part of a SharedDirectionFactor's residual across the group's direction, in two coordinates: along that
/// direction it has none. All residuals of landmarks then have two rows, for which Ceres has code of fixed size.
class FlatDirectionFactor final : public ceres::SizedCostFunction<2, kLineSize, kDirectionSize> {
 public:
  FlatDirectionFactor(double weight, const Eigen::Vector3d& direction_w)
      : factor_(weight), across_(tangentBasis(direction_w).transpose()) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Vector3d r;
    Eigen::Matrix<double, 3, kLineSize, Eigen::RowMajor> by_line;
    Eigen::Matrix<double, 3, kDirectionSize, Eigen::RowMajor> by_direction;
    double* all[] = {by_line.data(), by_direction.data()};
    factor_.Evaluate(parameters, r.data(), jacobians ? all : nullptr);
    Eigen::Vector2d::Map(residuals) = across_ * r;
    if (jacobians && jacobians[0])
      Eigen::Map<Eigen::Matrix<double, 2, kLineSize, Eigen::RowMajor>>{jacobians[0]} = across_ * by_line;
    if (jacobians && jacobians[1])
      Eigen::Map<Eigen::Matrix<double, 2, kDirectionSize, Eigen::RowMajor>>{jacobians[1]} = across_ * by_direction;
    return true;
  }

 private:
  SharedDirectionFactor factor_;
  Eigen::Matrix<double, 2, 3> across_;
};

/// At most `most` of the views that agree: a landmark couples every two keyframes that have a view here.
template <class View>
std::vector<const View*> spreadViews(const std::vector<View>& views, std::size_t most) {
  std::vector<const View*> inliers;
  for (const View& v : views)
    if (v.inlier) inliers.push_back(&v);
  thinOut(inliers, most);
  return inliers;
}

}  // namespace

template <class Target>
void BatchProblem::addView(ImageFactor<Target>& factor, ceres::LossFunction& loss, std::size_t keyframe,
                           double* landmark) {
  if (isAnchor(keyframe)) {
    problem_->AddResidualBlock(&factor, &loss, at(poseAt(keyframe)), at(extrinsics_at_), at(correctionAt(keyframe)),
                               landmark);
    return;
  }
  carried_views_.push_back({&factor, &loss, keyframe, landmark});
  const auto [a, b] = anchors_[keyframe];
  own_factors_.push_back(std::make_unique<CarriedView<Target>>(factor, carriages_[keyframe]));
  problem_->AddResidualBlock(own_factors_.back().get(), &loss, at(poseAt(a)), at(extrinsics_at_),
                             at(correctionAt(keyframe)), landmark, at(poseAt(b)), at(carriageScaleAt(keyframe)));
}

/// A joined point needs few views beside those of its visits: each couples keyframes that are far apart in time.
std::size_t BatchProblem::mostViewsOf(const PointRecord& point) const {
  const bool joined = point.extra_sigma_px > 0;
  return joined && (most_views_ < 2 || most_views_ > kJoinedViews) ? kJoinedViews : most_views_;
}

void BatchProblem::addPoints() {
  own_factors_.push_back(std::make_unique<UnitLength>());
  ceres::CostFunction* unit_length = own_factors_.back().get();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointRecord& point = material_.points[points_[i]];
    landmark_residuals_.push_back(static_cast<std::size_t>(problem_->NumResidualBlocks()));
    const Eigen::Vector3d origin_w = originOf(point.views.front().keyframe);
    problem_->AddResidualBlock(unit_length, nullptr, at(points_at_ + i * kPointSize));
    for (const PointView* view : spreadViews(point.views, mostViewsOf(point))) {
      const PointView& v = *view;
      const auto k = static_cast<std::size_t>(keyframe_places_[v.keyframe]);
      point_factors_.emplace_back(v.px.cast<double>(), calibrated_.camera, motions_[k], origin_w,
                                  std::hypot(estimator_.factors.point_sigma_px, point.extra_sigma_px));
      addView(point_factors_.back(), point_loss_, k, at(points_at_ + i * kPointSize));
    }
  }
}

void BatchProblem::addLines() {
  const CorrectionBlock correction = Eigen::Map<const CorrectionBlock>(at(correction_at_));
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const LineRecord& line = material_.lines[lines_[i]];
    landmark_residuals_.push_back(static_cast<std::size_t>(problem_->NumResidualBlocks()));
    const Eigen::Vector3d origin_w = originOf(line.views.front().keyframe);
    for (const LineView* view : spreadViews(line.views, most_views_)) {
      const LineView& v = *view;
      const auto k = static_cast<std::size_t>(keyframe_places_[v.keyframe]);
      const auto [start, end] =
          makeLineEnds(calibrated_.camera, v.start_px.cast<double>(), v.end_px.cast<double>(), correction);
      line_factors_.emplace_back(start, end, motions_[k], origin_w,
                                 estimator_.factors.line_sigma_px * std::max(0.1, static_cast<double>(v.sigma_px)));
      addView(line_factors_.back(), line_loss_, k, at(lines_at_ + i * kLineSize));
    }
  }
}

void BatchProblem::addGroups() {
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (const std::size_t line : groups_[g].lines) {
      const auto place = std::lower_bound(lines_.begin(), lines_.end(), line);
      if (place == lines_.end() || *place != line) continue;
      const auto i = static_cast<std::size_t>(place - lines_.begin());
      own_factors_.push_back(std::make_unique<FlatDirectionFactor>(1 / groups_[g].sigma_rad, groups_[g].direction_w));
      problem_->AddResidualBlock(own_factors_.back().get(), &structural_loss_, at(lines_at_ + i * kLineSize),
                                 at(directions_at_ + g * kDirectionSize));
    }
}

}  // namespace lintel
