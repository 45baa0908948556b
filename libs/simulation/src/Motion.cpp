// SPDX-License-Identifier: BSD-3-Clause
#include "Motion.h"

#include <stdexcept>

#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/simulation/SplineTrajectory.h"

namespace lintel {

namespace {

std::shared_ptr<const Trajectory> fromFile(const MotionParams& params) {
  const StampedPoses all = readTrajectory(params.trajectory_file);
  StampedPoses part;
  for (const auto& pose : all) {
    if (1e-9 * static_cast<double>(pose.first - all.front().first) >= params.start_s) part.push_back(pose);
  }
  try {
    return std::make_shared<SplineTrajectory>(part);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(params.trajectory_file + ": " + error.what());
  }
}

std::shared_ptr<const Trajectory> fromFigure(const MotionParams& params, const SceneKind& kind, const Rig& rig) {
  FigureParams figure = kind.figure;
  if (params.speed <= 0) throw std::invalid_argument("the speed must be positive");
  figure.period_s /= params.speed;
  figure.turn_rate_rad_s *= params.speed;
  if (params.figure == "translation") {
    figure.rotation = 0;
  } else if (params.figure == "rotation") {
    figure.translation = 0;
  } else if (params.figure != "full") {
    throw std::invalid_argument("no figure '" + params.figure + "'; there are: full translation rotation");
  }
  return std::make_shared<FigureTrajectory>(figure, rig.T_b_c.q);
}

}  // namespace

std::shared_ptr<const Trajectory> buildMotion(const MotionParams& params, const SceneKind& kind, const Rig& rig) {
  auto motion = params.trajectory_file.empty() ? fromFigure(params, kind, rig) : fromFile(params);
  if (params.static_s > 0) motion = std::make_shared<DelayedStart>(motion, params.static_s);
  return motion;
}

SceneRequest requestFor(const SceneKind& kind, const MotionParams& params, const Trajectory& trajectory,
                        double duration_s, std::uint64_t seed) {
  SceneRequest request;
  request.seed = seed;
  Eigen::AlignedBox3d flown;
  for (double t = 0; t <= duration_s; t += 0.05) {
    const Eigen::Vector3d p = trajectory.at(t).T_w_b.p;
    flown.extend(p);
    if (request.path.empty() || (p - request.path.back()).norm() > 0.05) request.path.push_back(p);
  }
  request.hull = kind.hull;
  if (!params.trajectory_file.empty()) {
    request.hull = {flown.min() - kind.margin_m, flown.max() + kind.margin_m};
    // a path that hardly moves still gets a room in which furniture has its place
    const Eigen::Vector3d missing = (0.6 * kind.hull.sizes() - request.hull.sizes()).cwiseMax(0);
    request.hull = {request.hull.min() - 0.5 * missing, request.hull.max() + 0.5 * missing};
  }
  return request;
}

}  // namespace lintel
