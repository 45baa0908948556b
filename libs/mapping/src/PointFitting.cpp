// SPDX-License-Identifier: BSD-3-Clause
#include "PointFitting.h"

#include <cmath>
#include <limits>

#include "Evidence.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallLeastSquares.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

struct PointFitView {
  Eigen::Matrix3d R_c_w;
  Eigen::Vector3d p_w_c, seen;
};

/// The point is X / w from `origin_w`, |(X, w)| free: with w = 1 / distance far points stay well behaved. Here as
/// (bearing change, inverse distance): X = u + B a, w.
struct Homogeneous {
  Eigen::Vector3d X = Eigen::Vector3d::UnitZ();
  double w = 0;
};

/// The cost is infinite when the point is not in front of all cameras.
NormalEquations4 normalEquations(const Camera& camera, const std::vector<PointFitView>& views,
                                 const Eigen::Vector3d& origin_w, const Homogeneous& point, double weight,
                                 double loss_width) {
  NormalEquations4 normal;
  const double width2 = loss_width * loss_width;
  for (const PointFitView& v : views) {
    const Eigen::Vector3d baseline = v.R_c_w * (origin_w - v.p_w_c), g = v.R_c_w * point.X + point.w * baseline;
    if (camera.depth(g, v.seen) < 1e-3) {
      normal.cost = std::numeric_limits<double>::infinity();
      return normal;
    }
    // the residual in two directions across the ray: x and y, or a basis of the plane tangent to the sphere
    const Eigen::Vector3d n = camera.rayTo(g);
    const Eigen::Matrix<double, 3, 2> B = camera.wide() ? tangentBasis(n) : Eigen::Matrix<double, 3, 2>::Identity();
    const Eigen::Vector2d r = weight * (B.transpose() * (n - v.seen));
    Eigen::Matrix<double, 2, 3> d_g = B.transpose();
    if (!camera.wide()) d_g.col(2) = -n.head<2>();
    d_g *= weight / camera.depth(g, n);
    Eigen::Matrix<double, 2, 4> J;
    J << d_g * v.R_c_w, d_g * baseline;
    const double s = r.squaredNorm() / width2, w = 1 / (1 + s);
    normal.cost += 0.5 * width2 * std::log1p(s);
    normal.add(J, r, w);
  }
  // the scale of (X, w) is free: hold |X|
  Eigen::Vector4d along;
  along << point.X.normalized(), 0;
  normal.H += normal.H.trace() * along * along.transpose();
  return normal;
}

std::vector<PointFitView> fitViews(const KeyframeCameras& cameras, const PointRecord& point) {
  std::vector<const PointView*> fitted;
  for (const PointView& v : point.views)
    if (v.inlier) fitted.push_back(&v);
  thinOut(fitted, kMostFitted);
  std::vector<PointFitView> views;
  views.reserve(fitted.size());
  for (const PointView* v : fitted)
    views.push_back({cameras.R_c_w(v->keyframe), cameras.T_w_c(v->keyframe).p, cameras.ray(v->px.cast<double>())});
  return views;
}

double linearInverseDistance(const std::vector<PointFitView>& views, const Eigen::Vector3d& origin_w,
                             const Eigen::Vector3d& ray_w) {
  double ab = 0, bb = 0;  // x_j x (ray + w baseline) = 0
  for (const PointFitView& v : views) {
    const Eigen::Vector3d x = v.seen.normalized();
    const Eigen::Vector3d a = x.cross(v.R_c_w * ray_w), b = x.cross(v.R_c_w * (origin_w - v.p_w_c));
    ab += a.dot(b);
    bb += b.squaredNorm();
  }
  return bb > 0 ? -ab / bb : 0;
}

bool estimate(const Camera& camera, const std::vector<PointFitView>& views, const PointFitParams& params,
              PointRecord& point) {
  const Eigen::Vector3d origin_w = views.front().p_w_c;
  Homogeneous h;
  h.X = (views.front().R_c_w.transpose() * views.front().seen).normalized();
  h.w = std::clamp(linearInverseDistance(views, origin_w, h.X), 1 / params.max_depth_m, 1 / params.min_depth_m);
  if (point.known) {  // the former estimate may be the better start
    const Eigen::Vector3d arm = point.p_w - origin_w;
    if (arm.norm() > params.min_depth_m) h = {arm.normalized(), 1 / arm.norm()};
  }
  const double weight = camera.meanFocal() / params.sigma_px;
  LevenbergParams levenberg;
  levenberg.max_iterations = 12;
  const auto linearise = [&](const Homogeneous& p) {
    return normalEquations(camera, views, origin_w, p, weight, params.loss_width);
  };
  const auto moved = [](const Homogeneous& p, const Eigen::Vector4d& step) {
    Homogeneous result{p.X + step.head<3>(), p.w + step[3]};
    const double size = result.X.norm();
    result.X /= size, result.w /= size;
    return result;
  };
  const NormalEquations4 end = levenbergMarquardt(levenberg, h, linearise, moved);
  if (!std::isfinite(end.cost)) return false;
  if (h.w < 1 / params.max_depth_m) return false;
  point.p_w = origin_w + h.X / h.w;
  const double variance = solveLdlt<4>(end.H, Eigen::Vector4d::Unit(3))[3];
  point.sigma_distance_m = std::sqrt(std::max(0.0, variance)) / (h.w * h.w);
  return point.p_w.allFinite() && std::isfinite(point.sigma_distance_m);
}

}  // namespace

double viewError(const KeyframeCameras& cameras, const Eigen::Vector3d& p_w, const PointView& view) {
  const Eigen::Vector3d p_c = cameras.R_c_w(view.keyframe) * (p_w - cameras.T_w_c(view.keyframe).p);
  const double depth_m = cameras.camera().wide() ? p_c.dot(cameras.ray(view.px.cast<double>())) : p_c.z();
  if (depth_m < 0.05) return std::numeric_limits<double>::infinity();
  return (cameras.camera().project(p_c) - view.px.cast<double>()).norm();
}

bool fitPoint(const KeyframeCameras& cameras, const PointFitParams& params, PointRecord& point) {
  for (PointView& v : point.views) v.inlier = cameras.contains(v.keyframe);
  bool found = false;
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<PointFitView> views = fitViews(cameras, point);
    found = views.size() >= 2 && estimate(cameras.camera(), views, params, point);
    if (!found) break;
    point.known = true;
    bool changed = false;
    double sum = 0;
    int inliers = 0;
    for (PointView& v : point.views) {
      if (!cameras.contains(v.keyframe)) continue;
      const double error = viewError(cameras, point.p_w, v);
      const bool inlier = error <= params.max_error_px;
      changed |= inlier != v.inlier;
      v.inlier = inlier;
      if (inlier) sum += error, ++inliers;
    }
    point.error_px = inliers > 0 ? sum / inliers : 0;
    found = inliers >= 2;
    if (!changed) break;
  }
  return point.known = found;
}

}  // namespace lintel
