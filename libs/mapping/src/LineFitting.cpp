// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/LineFitting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Evidence.h"
#include "LineViews.h"
#include "lintel/core/Quantiles.h"
#include "lintel/factors/LineDistances.h"
#include "lintel/geometry/PlaneIntersection.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallLeastSquares.h"

namespace lintel {

namespace {

/// A view in the form that the fit uses.
struct LineFitView {
  Eigen::Matrix3d R_c_w;
  Eigen::Vector3d p_w_c, ends[2];
  double weight = 0;
  bool wide = false;
};

/// H is that of the views only; b and the cost hold the tie's part too.
struct LineNormal : NormalEquations4 {
  Eigen::Matrix4d H_tie = Eigen::Matrix4d::Zero();
};

std::vector<LineFitView> fitViews(const KeyframeCameras& cameras, const LineRecord& line) {
  std::vector<const LineView*> fitted;
  for (const LineView& v : line.views)
    if (v.inlier && cameras.contains(v.keyframe)) fitted.push_back(&v);
  thinOut(fitted, kMostFitted);
  std::vector<LineFitView> views;
  views.reserve(fitted.size());
  for (const LineView* v : fitted)
    views.push_back({cameras.R_c_w(v->keyframe),
                     cameras.T_w_c(v->keyframe).p,
                     {cameras.ray(v->start_px.cast<double>()), cameras.ray(v->end_px.cast<double>())},
                     cameras.camera().meanFocal() / std::max(0.1, static_cast<double>(v->sigma_px)),
                     cameras.camera().wide()});
  return views;
}

/// What lines are fitted to.
struct FitData {
  std::vector<LineFitView> views;
  std::optional<LineTie> tie;
  double loss_width = 1;
};

/// The logarithm of a product of factors above 1: a logarithm now and then instead of one for each.
class LogProduct {
 public:
  void multiply(double factor) {
    product_ *= factor;
    if (product_ > 1e150) log_ += std::log(product_), product_ = 1;
  }
  double log() const { return log_ + std::log(product_); }

 private:
  double product_ = 1, log_ = 0;
};

/// The tie's residuals: what d has across the shared direction, r = B_tie^T d / sigma [Lim2021, structural constraint],
/// and the distances of its points across the line, r = B^T (p - m) / sigma.
void addTie(const LineTie& tie, const Eigen::Vector3d& m, const Eigen::Vector3d& d, LineNormal& normal) {
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(d);
  const auto add = [&](const Eigen::Vector2d& r, const Eigen::Matrix<double, 2, 4>& J) {
    normal.cost += 0.5 * r.squaredNorm();
    normal.H_tie += J.transpose() * J;
    normal.b += J.transpose() * r;
  };
  const Eigen::Matrix<double, 3, 2> across = tangentBasis(tie.direction_w) / tie.sigma_rad;
  Eigen::Matrix<double, 2, 4> J;
  J << Eigen::Matrix2d::Zero(), across.transpose() * B;
  add(across.transpose() * d, J);
  for (const PointOnLine& point : tie.points) {
    const Eigen::Vector3d arm = point.p_w - m;
    J << -Eigen::Matrix2d::Identity(), -d.dot(arm) * Eigen::Matrix2d::Identity();
    add(B.transpose() * arm / point.sigma_m, J / point.sigma_m);
  }
}

LineNormal normalEquations(const FitData& data, const LineEstimate& line) {
  const Eigen::Vector3d &m = line.middle_w, &d = line.direction_w;
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(d);
  const double width2 = data.loss_width * data.loss_width;
  LineNormal normal;
  LogProduct loss;
  if (data.tie) addTie(*data.tie, m, d, normal);
  for (const LineFitView& v : data.views) {
    const Eigen::Vector3d arm = m - v.p_w_c;
    const LineDistances distances(v.ends, v.R_c_w * arm.cross(d), v.weight, v.wide);
    Eigen::Matrix<double, 3, 4> d_l;  // of l in the camera by (a, b)
    for (int k = 0; k < 2; ++k) {
      d_l.col(k) = v.R_c_w * B.col(k).cross(d);
      d_l.col(2 + k) = v.R_c_w * arm.cross(B.col(k));
    }
    Eigen::Matrix<double, 2, 4> J;
    for (int k = 0; k < 2; ++k) J.row(k) = distances.d_l[k] * d_l;
    const double s = distances.residual.squaredNorm() / width2;  // Cauchy
    loss.multiply(1 + s);
    normal.add(J, distances.residual, 1 / (1 + s));
  }
  normal.cost += 0.5 * width2 * loss.log();
  return normal;
}

/// Start from all observation planes, and the tie's direction and points.
bool startFromPlanes(const FitData& data, LineEstimate& line) {
  std::vector<ObservationPlane> planes;
  for (const LineFitView& v : data.views) {
    const Eigen::Vector3d cross = v.ends[0].cross(v.ends[1]);
    if (cross.norm() >= 1e-9) planes.push_back({v.R_c_w.transpose() * cross.normalized(), v.p_w_c});
  }
  LineConstraints constraints;
  if (data.tie) {
    constraints.direction_w = data.tie->direction_w;
    for (const PointOnLine& p : data.tie->points) constraints.points_w.push_back(p.p_w);
  }
  const auto start = intersectPlanes(planes, data.views.front().p_w_c, constraints);
  if (!start) return false;
  line.middle_w = start->point_w;
  line.direction_w = start->direction_w;
  return true;
}

/// Moves the middle to where the views are, along the line. The median: one view at a grazing angle must not count.
bool centre(const std::vector<LineFitView>& views, LineEstimate& line, double& distance_m) {
  constexpr double kLeastSine2 = 1e-6;  // of the angle between ray and line: 0.06 degrees
  std::vector<double> places, distances;
  for (const LineFitView& v : views) {
    const Eigen::Vector3d ray_w = (v.R_c_w.transpose() * (v.ends[0] + v.ends[1])).normalized();
    const NearestToRay nearest = nearestToRay(line, v.p_w_c, ray_w);
    if (nearest.sine2 < kLeastSine2 || nearest.depth_m <= 0) continue;
    places.push_back(nearest.along_m);
    distances.push_back(nearest.depth_m);
  }
  if (2 * places.size() < views.size() || places.empty()) return false;
  line.middle_w += upperMedian(places) * line.direction_w;
  distance_m = upperMedian(distances);
  return true;
}

/// Returns the cost where it ended.
double refine(const FitData& data, LineEstimate& line) {
  LevenbergParams levenberg;
  levenberg.trace_damping = 1e-12;
  const auto linearise = [&](const LineEstimate& l) {
    NormalEquations4 sum;
    sum.cost = std::numeric_limits<double>::infinity();
    if (!l.middle_w.allFinite() || !l.direction_w.allFinite()) return sum;
    const LineNormal normal = normalEquations(data, l);
    sum = normal;
    sum.H += normal.H_tie;
    return sum;
  };
  const auto moved = [](const LineEstimate& l, const Eigen::Vector4d& step) {
    const Eigen::Matrix<double, 3, 2> B = tangentBasis(l.direction_w);
    LineEstimate result;
    result.middle_w = l.middle_w + B * step.head<2>();
    result.direction_w = (l.direction_w + B * step.tail<2>()).normalized();
    return result;
  };
  return levenbergMarquardt(levenberg, line, linearise, moved).cost;
}

/// The covariance of (a, b), in a unit of metres that makes positions as large as directions.
Eigen::Matrix4d scaledCovariance(const Eigen::Matrix4d& information, double scale_m) {
  Eigen::Vector4d unit;
  unit << scale_m, scale_m, 1, 1;
  return unit.asDiagonal() * covarianceOf(unit.asDiagonal() * information * unit.asDiagonal()) * unit.asDiagonal();
}

/// Marks outliers; mean error of the others.
void judgeViews(const KeyframeCameras& cameras, const LineFitParams& params, LineRecord& line) {
  double sum = 0;
  int inliers = 0;
  for (LineView& v : line.views) {
    const double error =
        cameras.contains(v.keyframe) ? viewError(cameras, line.estimate, v) : std::numeric_limits<double>::infinity();
    v.inlier = error <= params.max_error_px;
    if (v.inlier) sum += error, ++inliers;
  }
  line.error_px = inliers > 0 ? sum / inliers : 0;
}

}  // namespace

double LineEstimate::sigmaDirection() const { return worstSigma(covariance.bottomRightCorner<2, 2>()); }

double LineEstimate::sigmaPosition(double along_m) const {
  Eigen::Matrix<double, 2, 4> J;
  J << Eigen::Matrix2d::Identity(), along_m * Eigen::Matrix2d::Identity();
  return worstSigma(J * covariance * J.transpose());
}

bool fitLine(const KeyframeCameras& cameras, const LineFitParams& params, LineRecord& line) {
  const bool had_estimate = line.known;
  line.known = false;
  for (LineView& v : line.views) v.inlier = true;
  for (int pass = 0; pass < 3; ++pass) {
    const FitData data{fitViews(cameras, line), line.tie, params.loss_width};
    const std::vector<LineFitView>& views = data.views;
    if (views.size() < 2 || keyframesOf(line) < 2) return false;
    LineEstimate candidate;
    double cost = std::numeric_limits<double>::infinity();
    if (had_estimate || pass > 0) {
      candidate = line.estimate;
      cost = refine(data, candidate);
    }
    const double freedom = std::max(1.0, 2.0 * static_cast<double>(views.size()) - 4.0);
    const bool good = 2 * cost <= freedom;  // residuals agree with the sigmas: no other start is tried
    if (LineEstimate other; pass == 0 && !good && startFromPlanes(data, other)) {
      const double other_cost = refine(data, other);
      if (other_cost < cost) candidate = other, cost = other_cost;
    }
    if (!std::isfinite(cost) || !centre(views, candidate, line.distance_m)) return false;
    const LineNormal normal = normalEquations(data, candidate);
    // Views further off than their sigmas say make the line less known; and they share errors that do not average out.
    const double spread = std::max(1.0, 2 * normal.cost / freedom);
    const double common = 1 + params.systematic * params.systematic * static_cast<double>(views.size());
    candidate.covariance =
        scaledCovariance(normal.H / (spread * common) + normal.H_tie, std::max(line.distance_m, 0.1));
    line.estimate = candidate;
    const std::vector<LineView> before = line.views;
    judgeViews(cameras, params, line);
    const bool same = std::equal(before.begin(), before.end(), line.views.begin(),
                                 [](const LineView& a, const LineView& b) { return a.inlier == b.inlier; });
    if (same) break;
  }
  line.known = keyframesOf(line) >= 2 && line.distance_m >= params.min_depth_m;
  return line.known;
}

}  // namespace lintel
