// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/PointTriangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// A sighting relative to the host, the first one: g = ray + lambda * baseline in the target camera (PointFactor);
/// `aside`: two directions across the host's ray, in the target camera.
struct View {
  Eigen::Vector3d ray, baseline, seen;
  Eigen::Matrix<double, 3, 2> aside;
};

/// Two directions in which rays of their kind change: on the sphere, or on the plane z = 1.
Eigen::Matrix<double, 3, 2> asideOf(const Camera& camera, const Eigen::Vector3d& ray) {
  if (camera.wide()) return tangentBasis(ray);
  return Eigen::Matrix<double, 3, 2>::Identity();
}

/// All sightings; the host's has no baseline.
std::vector<View> viewsOf(const CameraPoses& poses, const PointTrack& track) {
  const CorrectionBlock& correction = poses.window().correction;
  const PointSighting& host = track.sightings.front();
  const Pose& T_w_ci = poses.T_w_c(host.frame);
  const Eigen::Vector3d ray = host.observation.corrected(correction.data());
  const Eigen::Matrix<double, 3, 2> aside = asideOf(poses.camera(), ray);
  std::vector<View> views{{ray, Eigen::Vector3d::Zero(), ray, aside}};
  views.reserve(track.sightings.size());
  for (std::size_t i = 1; i < track.sightings.size(); ++i) {
    const PointSighting& s = track.sightings[i];
    const Pose T_cj_ci = poses.T_c_w(s.frame) * T_w_ci;
    views.push_back(
        {T_cj_ci.q * ray, T_cj_ci.p, s.observation.corrected(correction.data()), T_cj_ci.q.toRotationMatrix() * aside});
  }
  return views;
}

double linearInverseDepth(const std::vector<View>& views) {
  double ab = 0, bb = 0;  // x_j x (ray + lambda baseline) = 0
  for (const View& v : views) {
    const Eigen::Vector3d seen = v.seen.normalized();
    const Eigen::Vector3d a = seen.cross(v.ray), b = seen.cross(v.baseline);
    ab += a.dot(b);
    bb += b.squaredNorm();
  }
  return bb > 0 ? -ab / bb : 0;
}

/// How the ray to a point moves with the point.
Eigen::Vector3d rayChange(const Camera& camera, const Eigen::Vector3d& p_c, const Eigen::Vector3d& change) {
  const Eigen::Vector3d n = camera.rayTo(p_c);
  return (change - n * camera.depth(change, n)) / camera.depth(p_c, n);
}

struct Step {
  double gradient = 0, information = 0, error = 0;
  bool in_front = true;
};

Step evaluate(const Camera& camera, const std::vector<View>& views, double lambda) {
  Step step;
  for (const View& v : views) {
    const Eigen::Vector3d g = v.ray + lambda * v.baseline;
    if (camera.depth(g, v.seen) < 1e-3) {
      step.in_front = false;
      return step;
    }
    const Eigen::Vector3d r = camera.rayTo(g) - v.seen, J = rayChange(camera, g, v.baseline);
    step.gradient += J.dot(r);
    step.information += J.squaredNorm();
    step.error += r.norm();
  }
  step.error /= static_cast<double>(views.size() - 1);  // the host has none
  return step;
}

/// The information of all sightings on the inverse depth, in units of that of a ray. The host's ray has the noise of
/// one sighting as well, and its direction is eliminated: many views from near places would else seem to show a
/// parallax that is the host's noise.
double inverseDepthInformation(const Camera& camera, const std::vector<View>& views, double lambda) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  // the ray's direction, inverse depth
  for (const View& v : views) {
    const Eigen::Vector3d g = v.ray + lambda * v.baseline;
    Eigen::Matrix3d J;
    J << rayChange(camera, g, v.aside.col(0)), rayChange(camera, g, v.aside.col(1)), rayChange(camera, g, v.baseline);
    H.noalias() += J.transpose() * J;
  }
  const Eigen::Vector2d across = H.topRightCorner<2, 1>();
  return H(2, 2) - across.dot(H.topLeftCorner<2, 2>().ldlt().solve(across));
}

}  // namespace

bool triangulatePoint(const CameraPoses& poses, const LandmarkParams& params, double sigma_px, PointTrack& track) {
  const SlidingWindow& window = poses.window();
  track.triangulated = false;
  if (track.sightings.size() < 2) return false;
  const std::vector<View> views = viewsOf(poses, track);
  const double least = 1.0 / params.max_depth_m, most = 1.0 / params.min_depth_m;
  double lambda = std::clamp(linearInverseDepth(views), least, most);
  Step step = evaluate(window.camera(), views, lambda);
  for (int i = 0; i < 5 && step.in_front && step.information > 0; ++i) {
    lambda = std::clamp(lambda - step.gradient / step.information, least, most);
    step = evaluate(window.camera(), views, lambda);
  }
  const double focal = window.camera().meanFocal();
  if (!step.in_front || step.error * focal > params.point_max_error_px) return false;
  const double information = inverseDepthInformation(window.camera(), views, lambda);
  const double sigma =
      information > 0 ? sigma_px / focal / std::sqrt(information) : std::numeric_limits<double>::infinity();
  if (sigma > params.point_max_relative_sigma * lambda) return false;
  const PointSighting& first = track.sightings.front();
  const Pose& T_w_c = poses.T_w_c(first.frame);
  track.origin_w = T_w_c.p;
  track.point << T_w_c.q * first.observation.corrected(window.correction.data()), lambda;
  track.point.normalize();
  track.sigma_inverse_depth = sigma;
  track.triangulated = true;
  return true;
}

void triangulatePoints(SlidingWindow& window, const LandmarkParams& params, double sigma_px) {
  const CameraPoses poses(window);
  for (auto& [id, track] : window.points)
    if (!track.triangulated && static_cast<int>(track.sightings.size()) >= params.point_min_observations)
      triangulatePoint(poses, params, sigma_px, track);
}

double reprojectionError(const CameraPoses& poses, const PointTrack& track) {
  const Camera camera = poses.window().correctedCamera();
  double sum = 0;
  for (const PointSighting& s : track.sightings) {
    const Pose& T_w_c = poses.T_w_c(s.frame);
    const Eigen::Vector3d g =
        T_w_c.q.conjugate() * (track.point.head<3>() + track.point[3] * (track.origin_w - T_w_c.p));
    if (camera.depth(g, s.observation.ray) < 1e-6) return std::numeric_limits<double>::infinity();
    sum += (camera.project(g) - s.px).norm();
  }
  return track.sightings.empty() ? 0 : sum / static_cast<double>(track.sightings.size());
}

void updatePointUncertainty(const CameraPoses& poses, double sigma_px, PointTrack& track) {
  const SlidingWindow& window = poses.window();
  if (track.sightings.size() < 2) return;
  const PointSighting& first = track.sightings.front();
  const double depth =
      window.camera().depth(poses.T_c_w(first.frame) * window.positionOf(track), first.observation.ray);
  if (depth <= 0) return;
  const std::vector<View> views = viewsOf(poses, track);
  if (!evaluate(window.camera(), views, 1 / depth).in_front) return;
  const double information = inverseDepthInformation(window.camera(), views, 1 / depth);
  if (information <= 0) return;
  track.sigma_inverse_depth =
      std::min(track.sigma_inverse_depth, sigma_px / window.camera().meanFocal() / std::sqrt(information));
}

}  // namespace lintel
