// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/LineTriangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "landmarks/LineDegeneracy.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/geometry/PlaneIntersection.h"
#include "lintel/geometry/SmallLeastSquares.h"

namespace lintel {

namespace {

/// What else is known of a line.
struct KnownDirection {
  Eigen::Vector3d d_w;
  double sigma_rad;
};

/// The residuals of one line, poses and calibration fixed. The poses must outlive them.
class LineResiduals {
 public:
  LineResiduals(const CameraPoses& poses, const FactorParams& params, const LineTrack& track)
      : correction_(poses.correction()), loss_(params.line_loss_width) {
    factors_.reserve(track.sightings.size());
    for (const LineSighting& s : track.sightings)
      factors_.push_back(
          {{s.start, s.end, track.origin_w, 1 / (params.line_sigma_px * s.sigma_px)}, poses.view(s.frame)});
  }

  /// Normal equations of the line.
  NormalEquations4 linearise(const LineBlock& line) const {
    NormalEquations4 normal;
    LineLinearisation l;
    const LineAxes axes(line.data());
    for (const Factor& factor : factors_) {
      factor.residual.linearise(factor.view, correction_, axes, true, l);
      double rho[3];
      loss_.Evaluate(l.residual.squaredNorm(), rho);
      normal.add(l.d_target, l.residual, rho[1]);
      normal.cost += 0.5 * rho[0];
    }
    return normal;
  }

  /// With its direction known.
  NormalEquations4 linearise(const LineBlock& line, const KnownDirection& known) const {
    NormalEquations4 normal = linearise(line);
    const double* blocks[] = {line.data(), known.d_w.data()};
    Eigen::Vector3d r;
    Eigen::Matrix<double, 3, kLineSize, Eigen::RowMajor> J_ambient;
    double* jacobians[] = {J_ambient.data(), nullptr};
    SharedDirectionFactor(1 / known.sigma_rad).Evaluate(blocks, r.data(), jacobians);
    RowMajorMatrix plus(kLineSize, kLineTangent);
    LineManifold().PlusJacobian(line.data(), plus.data());
    const Eigen::Matrix<double, 3, 4> J = J_ambient * plus;
    normal.H += J.transpose() * J;
    normal.b += J.transpose() * r;
    normal.cost += 0.5 * r.squaredNorm();
    return normal;
  }

 private:
  struct Factor {
    LineResidual residual;
    const CameraView& view;
  };
  const double* correction_;
  ceres::CauchyLoss loss_;
  std::vector<Factor> factors_;
};

void refine(const LineResiduals& residuals, LineTrack& track, const KnownDirection* known = nullptr) {
  LevenbergParams levenberg;
  levenberg.damping = 1e-3;
  levenberg.max_damping = std::numeric_limits<double>::infinity();
  levenberg.absolute_damping = 1e-9;
  levenberg.min_relative_decrease = 1e-4;
  levenberg.max_iterations = 10;
  const auto linearise = [&](const LineBlock& line) {
    return known ? residuals.linearise(line, *known) : residuals.linearise(line);
  };
  const auto moved = [](const LineBlock& line, const Eigen::Vector4d& step) {
    LineBlock result;
    LineManifold().Plus(line.data(), step.data(), result.data());
    return result;
  };
  levenbergMarquardt(levenberg, track.line, linearise, moved);
}

/// The ends of a sighting on a line, in the camera's frame. How many of them are in front of it. `foot_w`: a point of
/// the line.
int endsInCamera(const CameraPoses& poses, const CameraView& view, const Eigen::Vector3d& foot_w,
                 const Eigen::Vector3d& d_w, const LineSighting& s, Eigen::Vector3d ends_c[2]) {
  const Eigen::Vector3d d_c = view.R_c_w * d_w;
  const Eigen::Vector3d p_c = view.R_c_w * (foot_w - view.p_w_c);
  const PluckerLine line_c{p_c.cross(d_c), d_c};
  const Eigen::Vector3d seen[2] = {s.start.corrected(poses.correction()), s.end.corrected(poses.correction())};
  int in_front = 0;
  for (int k = 0; k < 2; ++k)
    in_front += closestPointToRay(line_c, seen[k], ends_c[k]) && poses.camera().depth(ends_c[k], seen[k]) >= 0.05;
  return in_front;
}

/// The middle of what the newest sighting shows: its place along the line, from the foot, and its depth.
struct SeenMiddle {
  double along_m = 0, depth_m = 0;
};

SeenMiddle middleOf(const CameraPoses& poses, const LineTrack& track) {
  const LineSighting& newest = track.sightings.back();
  Eigen::Vector3d ends_c[2] = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()};
  const CameraView& view = poses.view(newest.frame);
  const PluckerLine line = lineFromBlock(track.line.data()).plucker();
  endsInCamera(poses, view, track.origin_w + line.nearestPoint(), line.d, newest, ends_c);
  const Eigen::Vector3d middle_w = view.R_c_w.transpose() * (0.5 * (ends_c[0] + ends_c[1])) + view.p_w_c;
  const Eigen::Vector3d d_w = line.d.normalized();
  const double depth_m =
      poses.camera().wide() ? (0.5 * (ends_c[0] + ends_c[1])).norm() : 0.5 * (ends_c[0].z() + ends_c[1].z());
  return {(middle_w - track.origin_w).dot(d_w), std::max(depth_m, 0.1)};
}

/// Start from all observation planes, abreast of `track.origin_w`.
bool startFromPlanes(const CameraPoses& poses, LineTrack& track) {
  std::vector<ObservationPlane> planes;
  for (const LineSighting& s : track.sightings) {
    const Pose& T_w_c = poses.T_w_c(s.frame);
    const Eigen::Vector3d start = s.start.corrected(poses.correction());
    const Eigen::Vector3d end = s.end.corrected(poses.correction());
    const Eigen::Vector3d cross = start.cross(end);
    if (cross.norm() < 1e-6) return false;
    planes.push_back({T_w_c.q * cross.normalized(), T_w_c.p});
  }
  const auto line = intersectPlanes(planes, track.origin_w);
  if (!line) return false;
  const PluckerLine line_w = lineThrough(line->point_w, line->point_w + line->direction_w);
  track.line = toBlock(toOrthonormal(movedOrigin(line_w, track.origin_w)));
  return true;
}

/// Sigmas and verdict of a line.
void judgeBy(const LineResiduals& residuals, const CameraPoses& poses, const EstimatorParams& params,
             LineTrack& track) {
  const SeenMiddle middle = middleOf(poses, track);
  const LineUncertainty uncertainty =
      uncertaintyOf(lineFromBlock(track.line.data()), residuals.linearise(track.line).H, middle.along_m);
  track.sigma_direction_rad = uncertainty.direction_rad;
  track.sigma_distance_m = uncertainty.distance_m;
  track.verdict = judgeLine(poses, params.degeneracy, track, middle.depth_m);
}

}  // namespace

PluckerLine lineInWorld(const LineTrack& track) {
  return movedOrigin(lineFromBlock(track.line.data()).plucker(), -track.origin_w);
}

double lineError(const CameraPoses& poses, const LineTrack& track) {
  double sum = 0;
  Eigen::Vector3d ends[2];
  // a line along the motion may end in its own vanishing point, where noise decides what is in front
  const int least_in_front = track.group != 0 ? 1 : 2;
  const LineAxes axes(track.line.data());
  const Eigen::Vector3d foot_w = track.origin_w + PluckerLine{axes.n_w, axes.d_w}.nearestPoint();
  for (const LineSighting& s : track.sightings) {
    const CameraView& view = poses.view(s.frame);
    if (endsInCamera(poses, view, foot_w, axes.d_w, s, ends) < least_in_front)
      return std::numeric_limits<double>::infinity();
    LineLinearisation l;
    LineResidual{s.start, s.end, track.origin_w, 1}.linearise(view, poses.correction(), axes, false, l);
    sum += 0.5 * l.residual.cwiseAbs().sum();
  }
  return track.sightings.empty() ? 0 : sum / static_cast<double>(track.sightings.size());
}

void updateLineUncertainty(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track) {
  // after marginalisation has used its sightings a line keeps its last estimate
  if (!track.distance_known) return;
  if (track.verdict != LineVerdict::kNone &&
      static_cast<int>(track.sightings.size()) < params.landmarks.line_min_observations)
    return;
  judgeBy(LineResiduals(poses, params.factors, track), poses, params, track);
}

bool triangulateLine(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track) {
  track.triangulated = false;
  track.verdict = LineVerdict::kNone;
  if (track.sightings.size() < 2) return false;
  track.origin_w = poses.T_w_c(track.sightings.back().frame).p;
  if (!startFromPlanes(poses, track)) {
    track.verdict = LineVerdict::kDirectionUnknown;
    track.sigma_direction_rad = track.sigma_distance_m = std::numeric_limits<double>::infinity();
    return false;
  }
  // A line that is far from being determined is not worth refining: its approximate sigmas show that already.
  const LineResiduals residuals(poses, params.factors, track);
  judgeBy(residuals, poses, params, track);
  constexpr double kFarAbove = 3;  // times the limit: the approximation is wrong by less
  if (track.sigma_direction_rad > kFarAbove * params.degeneracy.max_sigma_direction_rad)
    return track.triangulated = true;
  refine(residuals, track);
  if (!(lineError(poses, track) < params.landmarks.line_max_error_px)) {
    if (!track.degenerate()) track.verdict = LineVerdict::kNone;  // an outlier, unless it is degenerate
    return track.triangulated = track.degenerate() && params.degeneracy.lines == "use";
  }
  track.triangulated = true;
  judgeBy(residuals, poses, params, track);
  return true;
}

bool triangulateTied(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track,
                     const Eigen::Vector3d& d_w) {
  // Of the depth. A distance known worse than that follows the noise of the direction, and biases the poses: in
  // the scene of rails the trajectory was 17 % worse than without them at 1, 3 % at 0.05. Beyond, only the direction
  // counts.
  constexpr double kMaxRelativeSigma = 0.05;
  const KnownDirection known{d_w, params.degeneracy.structural_sigma_rad};
  LineTrack tied = track;
  const LineResiduals residuals(poses, params.factors, tied);
  refine(residuals, tied, &known);
  if (!(lineError(poses, tied) < params.landmarks.line_max_error_px)) return false;
  const NormalEquations4 normal = residuals.linearise(tied.line, known);
  const SeenMiddle middle = middleOf(poses, tied);
  const LineUncertainty uncertainty = uncertaintyOf(lineFromBlock(tied.line.data()), normal.H, middle.along_m);
  if (uncertainty.distance_m > kMaxRelativeSigma * middle.depth_m) return false;
  tied.sigma_direction_rad = uncertainty.direction_rad;
  tied.sigma_distance_m = uncertainty.distance_m;
  track = tied;
  return true;
}

void triangulateLines(SlidingWindow& window, const EstimatorParams& params) {
  const CameraPoses poses(window);
  for (auto& [id, track] : window.lines)
    if ((!track.triangulated || (track.degenerate() && track.group == 0)) &&
        static_cast<int>(track.sightings.size()) >= params.landmarks.line_min_observations)
      triangulateLine(poses, params, track);
}

}  // namespace lintel
