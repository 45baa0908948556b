// SPDX-License-Identifier: BSD-3-Clause
#include "BatchProblem.h"

#include <ceres/ordered_groups.h>
#include <ceres/solver.h>

#include <cmath>

#include "SolverEnd.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

StateManifold* lineManifold() {
  static LineManifold manifold;
  return &manifold;
}

StateManifold* directionManifold() {
  static DirectionManifold manifold;
  return &manifold;
}

constexpr double kPoseCoordinates = 6;
constexpr double kOffsetLossWidth = 1;  // standard deviations: exposure times change at once, clocks slowly

}  // namespace

ceres::Problem::Options BatchProblem::problemOptions() {
  ceres::Problem::Options o;
  o.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  o.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  o.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  o.disable_all_safety_checks = true;
  return o;
}

StateManifold* BatchProblem::poseManifold() {
  static PoseManifold manifold;
  return &manifold;
}

BatchProblem::BatchProblem(const Rig& calibrated, const EstimatorParams& estimator, MapMaterial& material,
                           const std::vector<Anchors>& anchors, const std::vector<bool>& use_point,
                           const std::vector<bool>& use_line, std::size_t most_views,
                           const std::vector<ParallelLines>& groups, const RefinementParams& refinement)
    : calibrated_(calibrated),
      estimator_(estimator),
      material_(material),
      anchors_(anchors),
      most_views_(most_views),
      refinement_(refinement),
      groups_(groups),
      point_loss_(estimator.factors.point_loss_width),
      line_loss_(estimator.factors.line_loss_width),
      calibration_loss_(estimator.calibration.loss_width),
      structural_loss_(estimator.degeneracy.structural_loss_width),
      offset_loss_(kOffsetLossWidth),
      problem_(std::make_unique<ceres::Problem>(problemOptions())) {
  for (std::size_t i = 0; i < material.points.size(); ++i)
    if (use_point[i]) points_.push_back(i);
  for (std::size_t i = 0; i < material.lines.size(); ++i)
    if (use_line[i]) lines_.push_back(i);
  for (std::size_t k = 0; k < material.keyframes.size(); ++k) {
    const FrameId id = material.keyframes[k].id;
    if (id >= keyframe_places_.size()) keyframe_places_.resize(id + 1, -1);
    keyframe_places_[id] = static_cast<std::int64_t>(k);
    motions_.push_back(motionOf(material_.keyframes, k));
  }
  findCarriages();
  findStretches();
  findMeanBiases();
  placeBlocks();
  addPriors();
  addImu();
  addPoints();
  addLines();
  landmark_residuals_.push_back(static_cast<std::size_t>(problem_->NumResidualBlocks()));
  addGroups();
}

Eigen::Vector3d BatchProblem::originOf(FrameId keyframe) const {
  const RetiredKeyframe& k = material_.keyframes[static_cast<std::size_t>(keyframe_places_[keyframe])];
  return k.T_w_b * material_.rig.T_b_c.p;
}

void BatchProblem::placeBlocks() {
  lines_at_ = points_.size() * kPointSize;
  extrinsics_at_ = lines_at_ + lines_.size() * kLineSize;
  correction_at_ = extrinsics_at_ + kPoseSize;
  directions_at_ = correction_at_ + stretches() * kCorrectionSize;
  mean_biases_at_ = directions_at_ + groups_.size() * kDirectionSize;
  axes_at_ = mean_biases_at_ + meanBiases() * kMeanBiasSize;
  carriage_scales_at_ = axes_at_ + kAxesSize;
  keyframes_at_ = carriage_scales_at_ + carriageScales() * kCarriageScaleSize;
  values_.resize(keyframes_at_ + material_.keyframes.size() * (kPoseSize + kMotionSize));

  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointRecord& point = material_.points[points_[i]];
    PointBlock block;
    block << point.p_w - originOf(point.views.front().keyframe), 1;
    Eigen::Map<PointBlock>(at(points_at_ + i * kPointSize)) = block.normalized();
    problem_->AddParameterBlock(at(points_at_ + i * kPointSize), kPointSize);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const LineRecord& line = material_.lines[lines_[i]];
    const Eigen::Vector3d p = line.estimate.middle_w - originOf(line.views.front().keyframe);
    Eigen::Map<LineBlock>(at(lines_at_ + i * kLineSize)) =
        toBlock(toOrthonormal({p.cross(line.estimate.direction_w), line.estimate.direction_w}));
    problem_->AddParameterBlock(at(lines_at_ + i * kLineSize), kLineSize, lineManifold());
  }
  Eigen::Map<PoseBlock>(at(extrinsics_at_)) = toBlock(material_.rig.T_b_c);
  problem_->AddParameterBlock(at(extrinsics_at_), kPoseSize, poseManifold());
  placeCorrections();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Eigen::Map<DirectionBlock>(at(directions_at_ + g * kDirectionSize)) = groups_[g].direction_w;
    problem_->AddParameterBlock(at(directions_at_ + g * kDirectionSize), kDirectionSize, directionManifold());
  }
  placeMeanBiases();
  Eigen::Map<AxesBlock>(at(axes_at_)) = toBlock(material_.axes);
  problem_->AddParameterBlock(at(axes_at_), kAxesSize);
  placeCarriageScales();
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    Eigen::Map<PoseBlock>(at(poseAt(k))) = toBlock(keyframe.T_w_b);
    Eigen::Map<MotionBlock>(at(motionAt(k))) << keyframe.v_w_b, keyframe.bias.gyro, keyframe.bias.accel;
    if (!isAnchor(k)) continue;
    problem_->AddParameterBlock(at(poseAt(k)), kPoseSize, poseManifold());
    problem_->AddParameterBlock(at(motionAt(k)), kMotionSize);
  }
}

void BatchProblem::addPriors() {
  const auto add = [&](std::unique_ptr<ceres::CostFunction> cost, std::size_t block,
                       ceres::LossFunction* loss = nullptr) {
    problem_->AddResidualBlock(cost.get(), loss, at(block));
    own_factors_.push_back(std::move(cost));
  };
  const auto addParts = [&](PriorParts parts, std::size_t block) {
    for (PriorPart& part : parts) add(std::move(part.factor), block, part.refined ? &calibration_loss_ : nullptr);
  };
  addParts(makeExtrinsicsPriors(estimator_.calibration, calibrated_.T_b_c), extrinsics_at_);
  addParts(makeCorrectionPriors(estimator_.calibration), correction_at_);
  add(makeAxesPrior(toBlock(material_.axes), estimator_.calibration).factor, axes_at_);
  addCorrectionChanges();
  addMeanBiasWalk();
  addCarriageScalePriors();
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    if (!isAnchor(k)) continue;
    if (keyframe.at_rest) add(makeRestPrior(estimator_.rest_velocity_sigma), motionAt(k));
    if (keyframe.imu && k > 0) continue;
    // the first of a world: its place and yaw are free to choose
    if (k == 0 || beginsWorld(keyframe.id)) add(makeGaugePrior(toBlock(keyframe.T_w_b)), poseAt(k));
  }
}

bool BatchProblem::beginsWorld(FrameId keyframe) const {
  if (material_.pieces.empty()) return true;
  const std::size_t piece = pieceOf(material_.pieces, keyframe);
  return material_.pieces[piece].world == static_cast<int>(piece);
}

BatchProblem::Summary BatchProblem::solve(int max_iterations, double least_gain, const std::function<bool(int)>& goOn) {
  auto landmarks = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < points_.size(); ++i) landmarks->AddElementToGroup(at(points_at_ + i * kPointSize), 0);
  for (std::size_t i = 0; i < lines_.size(); ++i) landmarks->AddElementToGroup(at(lines_at_ + i * kLineSize), 0);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>(*landmarks);
  ordering->AddElementToGroup(at(extrinsics_at_), 1);
  ordering->AddElementToGroup(at(axes_at_), 1);
  for (std::size_t i = 0; i < stretches(); ++i) ordering->AddElementToGroup(at(correctionOf(i)), 1);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    ordering->AddElementToGroup(at(directions_at_ + g * kDirectionSize), 1);
  for (std::size_t i = 0; i < meanBiases(); ++i) ordering->AddElementToGroup(at(meanBiasOf(i)), 1);
  for (std::size_t i = 0; i < carriageScales(); ++i) ordering->AddElementToGroup(at(carriageScaleOf(i)), 1);
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    if (!isAnchor(k)) continue;
    ordering->AddElementToGroup(at(poseAt(k)), 1);
    ordering->AddElementToGroup(at(motionAt(k)), 1);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.linear_solver_ordering = ordering;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-9;
  options.num_threads = 1;
  // The scale hardly shows in a single residual: damping relative to those would hold it back for many iterations.
  options.initial_trust_region_radius = 1e8;
  options.num_threads = 1;
  // A landmark with a wrong sighting may raise the cost of a step, and a refused step leaves weakly observed
  // directions such as the scale unchanged: a few steps may raise the cost if it then falls below its former value.
  options.use_nonmonotonic_steps = true;
  // Every landmark is estimated anew after every step of all: what the steps of a few would raise the cost by, when
  // their views hardly determine them, else makes many a step of all be refused.
  options.use_inner_iterations = true;
  options.inner_iteration_ordering = landmarks;
  options.logging_type = ceres::SILENT;
  options.update_state_every_iteration = true;
  SolverEnd end(
      kPoseCoordinates * least_gain * anchorCount(), [this] { return wayOfAnchors(); }, goOn);
  options.callbacks.push_back(&end);
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);
  settle();
  return {summary.IsSolutionUsable(), static_cast<int>(summary.iterations.size()),
          static_cast<std::size_t>(summary.num_residuals), summary.initial_cost, summary.final_cost};
}

Eigen::Matrix3Xd BatchProblem::wayOfAnchors() const {
  std::vector<Eigen::Vector3d> steps;
  std::size_t last = 0;  // the anchor before
  bool led = false;      // by the IMU, from there on
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    led = led && material_.keyframes[k].imu;
    if (!isAnchor(k)) continue;
    const auto p_w = [&](std::size_t i) { return Eigen::Vector3d::Map(values_.data() + poseAt(i)); };
    if (led) steps.push_back(p_w(k) - p_w(last));
    last = k;
    led = true;
  }
  Eigen::Matrix3Xd way_w(3, steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) way_w.col(static_cast<Eigen::Index>(i)) = steps[i];
  return way_w;
}

void BatchProblem::writeBack() {
  material_.rig.T_b_c = poseFromBlock(at(extrinsics_at_));
  material_.rig.T_b_c.q.normalize();
  material_.rig.camera = correctedCamera(calibrated_.camera, at(correction_at_));
  material_.axes = axesFromBlock(at(axes_at_), material_.axes.mean_f);
  writeBackOffsets();
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    RetiredKeyframe& keyframe = material_.keyframes[k];
    keyframe.T_w_b = poseFromBlock(at(poseAt(k)));
    keyframe.T_w_b.q.normalize();
    keyframe.v_w_b = velocityOf(at(motionAt(k)));
    keyframe.bias = biasOf(at(motionAt(k)));
  }
}

}  // namespace lintel
