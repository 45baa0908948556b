// SPDX-License-Identifier: BSD-3-Clause
#include "LineFitting.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "LineExtent.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

double worstSigma(const Eigen::Matrix2d& covariance) {
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]));
}

/// A view as the fit sees it.
struct FitView {
  Eigen::Matrix3d R_c_w;
  Eigen::Vector3d p_w_c, ends[2];
  double weight = 0;
};

struct Normal {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();  ///< of the views
  Eigen::Matrix4d H_tie = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double cost = 0;
};

std::vector<FitView> fitViews(const KeyframeCameras& cameras, const LineRecord& line) {
  std::vector<FitView> views;
  for (const LineView& v : line.views) {
    if (!v.inlier || !cameras.contains(v.keyframe)) continue;
    views.push_back({cameras.R_c_w(v.keyframe),
                     cameras.T_w_c(v.keyframe).p,
                     {cameras.ray(v.start_px), cameras.ray(v.end_px)},
                     cameras.camera().meanFocal() / std::max(0.1, static_cast<double>(v.sigma_px))});
  }
  return views;
}

/// What lines are fitted to.
struct FitData {
  std::vector<FitView> views;
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
void addTie(const LineTie& tie, const Eigen::Vector3d& m, const Eigen::Vector3d& d, Normal& normal) {
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

Normal normalEquations(const FitData& data, const Eigen::Vector3d& m, const Eigen::Vector3d& d) {
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(d);
  const double width2 = data.loss_width * data.loss_width;
  Normal normal;
  LogProduct loss;
  if (data.tie) addTie(*data.tie, m, d, normal);
  for (const FitView& v : data.views) {
    const Eigen::Vector3d arm = m - v.p_w_c, l = v.R_c_w * arm.cross(d);
    const double size = std::max(l.head<2>().norm(), 1e-12);
    Eigen::Matrix<double, 3, 4> d_l;
    for (int k = 0; k < 2; ++k) {
      d_l.col(k) = v.R_c_w * B.col(k).cross(d);
      d_l.col(2 + k) = v.R_c_w * arm.cross(B.col(k));
    }
    const Eigen::Vector3d lateral(l.x() / size, l.y() / size, 0);
    Eigen::Vector2d r;
    Eigen::Matrix<double, 2, 4> J;
    for (int k = 0; k < 2; ++k) {
      const double distance = v.ends[k].dot(l) / size;
      r[k] = v.weight * distance;
      J.row(k) = v.weight / size * (v.ends[k] - distance * lateral).transpose() * d_l;
    }
    const double s = r.squaredNorm() / width2, w = 1 / (1 + s);  // Cauchy
    loss.multiply(1 + s);
    normal.H += w * J.transpose() * J;
    normal.b += w * J.transpose() * r;
  }
  normal.cost += 0.5 * width2 * loss.log();
  return normal;
}

/// Start from all observation planes [Lim2021, eq. make_plane]: the direction is what all normals are perpendicular to,
/// or the tie's.
bool intersectPlanes(const std::vector<FitView>& views, const std::optional<LineTie>& tie, LineEstimate& line) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const FitView& v : views) {
    const Eigen::Vector3d cross = v.ends[0].cross(v.ends[1]);
    if (cross.norm() < 1e-9) continue;
    const Eigen::Vector3d n_w = v.R_c_w.transpose() * cross.normalized();
    normals += n_w * n_w.transpose();
    b += n_w * n_w.dot(v.p_w_c);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normals);
  if (!tie && solver.eigenvalues()[1] < 1e-10) return false;
  line.direction_w = tie ? tie->direction_w : Eigen::Vector3d(solver.eigenvectors().col(0));
  const Eigen::Matrix3d along = line.direction_w * line.direction_w.transpose();
  if (tie)
    for (const PointOnLine& p : tie->points) normals += Eigen::Matrix3d::Identity() - along, b += p.p_w - along * p.p_w;
  line.middle_w = (normals + along).ldlt().solve(b + along * views.front().p_w_c);
  return line.middle_w.allFinite();
}

/// Moves the middle to where the views are, along the line. The median: one view at a grazing angle must not count.
bool centre(const std::vector<FitView>& views, LineEstimate& line, double& distance_m) {
  std::vector<double> places, distances;
  for (const FitView& v : views) {
    const Eigen::Vector3d ray = (v.R_c_w.transpose() * (v.ends[0] + v.ends[1])).normalized();
    const Eigen::Vector3d arm = line.middle_w - v.p_w_c;
    const double c = ray.dot(line.direction_w), denominator = 1 - c * c;
    if (denominator < 1e-6) continue;
    const double along = (c * ray.dot(arm) - line.direction_w.dot(arm)) / denominator;
    const double depth = ray.dot(arm) + along * c;
    if (depth <= 0) continue;
    places.push_back(along);
    distances.push_back(depth);
  }
  if (2 * places.size() < views.size() || places.empty()) return false;
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  line.middle_w += median(places) * line.direction_w;
  distance_m = median(distances);
  return true;
}

/// Levenberg-Marquardt; returns the normal equations where it ended.
Normal refine(const FitData& data, LineEstimate& line) {
  Normal now = normalEquations(data, line.middle_w, line.direction_w);
  double damping = 1e-4;
  for (int i = 0; i < 15; ++i) {
    Eigen::Matrix4d H = now.H + now.H_tie;
    H.diagonal() *= 1 + damping;
    H.diagonal().array() += 1e-12 * H.trace();
    const Eigen::Vector4d step = -H.ldlt().solve(now.b);
    const Eigen::Matrix<double, 3, 2> B = tangentBasis(line.direction_w);
    const Eigen::Vector3d m = line.middle_w + B * step.head<2>();
    const Eigen::Vector3d d = (line.direction_w + B * step.tail<2>()).normalized();
    const Normal next = m.allFinite() && d.allFinite() ? normalEquations(data, m, d) : Normal{};
    if (m.allFinite() && d.allFinite() && next.cost < now.cost) {
      const bool converged = now.cost - next.cost < 1e-6 * now.cost;
      line.middle_w = m, line.direction_w = d;
      now = next;
      damping *= 0.1;
      if (converged) break;
    } else {
      damping *= 10;
      if (damping > 1e6) break;
    }
  }
  return now;
}

Eigen::Matrix4d covarianceOf(const Eigen::Matrix4d& information, double scale_m) {
  // A unit of metres that makes positions as large as directions, and a floor instead of an inverse that fails.
  Eigen::Vector4d unit;
  unit << scale_m, scale_m, 1, 1;
  const Eigen::Matrix4d H = unit.asDiagonal() * information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(H);
  const Eigen::Vector4d variance = solver.eigenvalues().cwiseMax(1e-6).cwiseInverse();
  return unit.asDiagonal() * (solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose()) *
         unit.asDiagonal();
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

bool viewStretch(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view,
                 std::pair<double, double>& stretch) {
  constexpr double kLeastSine = 0.05, kMostSine = 0.5, kSigmas = 3;
  const Eigen::Vector3d arm = line.middle_w - cameras.T_w_c(view.keyframe).p;
  const double least_sine = std::clamp(kSigmas * line.sigmaDirection(), kLeastSine, kMostSine);
  const Eigen::Vector2d px[2] = {view.start_px, view.end_px};
  double places[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector3d ray = (cameras.R_c_w(view.keyframe).transpose() * cameras.ray(px[k])).normalized();
    const double c = ray.dot(line.direction_w), sine2 = 1 - c * c;
    if (sine2 < least_sine * least_sine) return false;
    places[k] = (c * ray.dot(arm) - line.direction_w.dot(arm)) / sine2;
    if (ray.dot(arm) + places[k] * c <= 0.05) return false;
  }
  stretch = {places[0], places[1]};
  return true;
}

double viewError(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view) {
  const Eigen::Vector3d arm = line.middle_w - cameras.T_w_c(view.keyframe).p;
  const Eigen::Matrix3d& R_c_w = cameras.R_c_w(view.keyframe);
  const Eigen::Vector3d l = R_c_w * arm.cross(line.direction_w);
  const double size = std::max(l.head<2>().norm(), 1e-12);
  double worst = 0;
  for (const Eigen::Vector2d& px : {view.start_px, view.end_px}) {
    const Eigen::Vector3d x = cameras.ray(px);
    const Eigen::Vector3d ray = (R_c_w.transpose() * x).normalized();
    const double c = ray.dot(line.direction_w), sine2 = std::max(1 - c * c, 1e-9);
    const double along = (c * ray.dot(arm) - line.direction_w.dot(arm)) / sine2;
    if (ray.dot(arm) + along * c <= 0) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, std::abs(x.dot(l)) / size * cameras.camera().meanFocal());
  }
  return worst;
}

bool fitLine(const KeyframeCameras& cameras, const LineFitParams& params, LineRecord& line) {
  const bool had_estimate = line.known;
  line.known = false;
  for (LineView& v : line.views) v.inlier = true;
  for (int pass = 0; pass < 3; ++pass) {
    const FitData data{fitViews(cameras, line), line.tie, params.loss_width};
    const std::vector<FitView>& views = data.views;
    if (views.size() < 2 || keyframesOf(line) < 2) return false;
    LineEstimate candidate;
    Normal normal;
    normal.cost = std::numeric_limits<double>::infinity();
    if (had_estimate || pass > 0) {
      candidate = line.estimate;
      normal = refine(data, candidate);
    }
    const double freedom = std::max(1.0, 2.0 * static_cast<double>(views.size()) - 4.0);
    const bool good = 2 * normal.cost <= freedom;  // as the sigmas promise: no need for another start
    if (LineEstimate other; pass == 0 && !good && intersectPlanes(views, line.tie, other)) {
      const Normal n = refine(data, other);
      if (n.cost < normal.cost) candidate = other, normal = n;
    }
    if (!std::isfinite(normal.cost) || !centre(views, candidate, line.distance_m)) return false;
    normal = normalEquations(data, candidate.middle_w, candidate.direction_w);
    // Views further off than their sigmas say make the line less known; and they share errors that do not average out.
    const double spread = std::max(1.0, 2 * normal.cost / freedom);
    const double common = 1 + params.systematic_px * params.systematic_px * static_cast<double>(views.size());
    candidate.covariance = covarianceOf(normal.H / (spread * common) + normal.H_tie, std::max(line.distance_m, 0.1));
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
