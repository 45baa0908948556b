// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowFactors.h"

#include "landmarks/LineDegeneracy.h"

#include <cmath>
#include <limits>

namespace lintel {

const std::shared_ptr<const StateManifold>& manifoldOf(BlockKey::Kind kind) {
  using Manifold = std::shared_ptr<const StateManifold>;
  static const Manifold pose = std::make_shared<PoseManifold>();
  static const std::array<Manifold, 7> manifolds{pose,  // in the order of BlockKey::Kind
                                                 std::make_shared<VectorManifold>(kMotionSize),
                                                 pose,
                                                 std::make_shared<VectorManifold>(kCorrectionSize),
                                                 std::make_shared<DirectionManifold>(),
                                                 std::make_shared<PointManifold>(),
                                                 std::make_shared<LineManifold>()};
  return manifolds[static_cast<std::size_t>(kind)];
}

WindowFactors::WindowFactors(const SlidingWindow& window, const FactorParams& params)
    : window_(window), params_(params), point_loss_(params.point_loss_width), line_loss_(params.line_loss_width) {
  for (const WindowFrame& frame : window.frames) motions_[frame.id] = frame.bodyMotion();
}

void WindowFactors::add(std::unique_ptr<ceres::CostFunction> cost, std::vector<BlockKey> blocks) {
  factors_.push_back({cost.get(), nullptr, std::move(blocks)});
  others_.push_back(std::move(cost));
}

void WindowFactors::addPriors() {
  for (const WindowPrior& prior : window_.priors) factors_.push_back({prior.factor.get(), nullptr, prior.blocks});
}

void WindowFactors::addCalibrationPriors(const CalibrationParams& p, const Pose& T_b_c_calibrated) {
  Eigen::VectorXd sigma(kPoseTangent);
  sigma << Eigen::Vector3d::Constant(p.extrinsic_translation_sigma_m),
      Eigen::Vector3d::Constant(p.extrinsic_rotation_sigma_rad);
  add(makeBlockPrior(manifoldOf(BlockKey::kExtrinsics), toBlock(T_b_c_calibrated), sigma),
      {{BlockKey::kExtrinsics, 0}});
  Eigen::VectorXd correction_sigma(kCorrectionSize);
  correction_sigma << p.focal_sigma_px, p.focal_sigma_px, p.centre_sigma_px, p.centre_sigma_px, p.distortion_sigma,
      p.distortion_sigma, p.time_offset_sigma_s;
  if (!p.refine_camera) correction_sigma.head<kTimeOffsetAt>().setConstant(1e-9);
  if (!p.refine_time_offset) correction_sigma[kTimeOffsetAt] = 1e-9;
  add(makeBlockPrior(manifoldOf(BlockKey::kCorrection), CorrectionBlock::Zero(), correction_sigma),
      {{BlockKey::kCorrection, 0}});
}

void WindowFactors::addGauge() {
  constexpr double kWeight = 1e3;  // a millimetre, a milliradian: stiff, yet no worse conditioned than the rest
  const WindowFrame& oldest = window_.frames.front();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, kPoseTangent);
  A.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * kWeight;
  A.block<1, 3>(3, 3) = Eigen::RowVector3d::UnitZ() * oldest.T_w_b().R() * kWeight;
  std::vector<PriorBlock> blocks{{manifoldOf(BlockKey::kPose), oldest.pose}};
  add(std::make_unique<PriorFactor>(std::move(blocks), std::move(A), Eigen::VectorXd::Zero(4)),
      {{BlockKey::kPose, oldest.id}});
}

void WindowFactors::addImu() {
  for (std::size_t i = 1; i < window_.frames.size(); ++i) addImu(window_.frames[i - 1], window_.frames[i]);
}

void WindowFactors::addImuAfter(FrameId frame) {
  for (std::size_t i = 1; i < window_.frames.size(); ++i)
    if (window_.frames[i - 1].id == frame) addImu(window_.frames[i - 1], window_.frames[i]);
}

void WindowFactors::addImu(const WindowFrame& before, const WindowFrame& frame) {
  if (!frame.imu || frame.imu->dt_s() <= 0) return;
  add(std::make_unique<ImuFactor>(frame.imu), {{BlockKey::kPose, before.id},
                                               {BlockKey::kMotion, before.id},
                                               {BlockKey::kPose, frame.id},
                                               {BlockKey::kMotion, frame.id}});
}

void WindowFactors::addRest(double velocity_sigma) {
  for (const WindowFrame& frame : window_.frames) addRestOf(frame, velocity_sigma);
}

void WindowFactors::addRestOf(const WindowFrame& frame, double velocity_sigma) {
  if (!frame.at_rest) return;
  Eigen::VectorXd sigma = Eigen::VectorXd::Constant(kMotionSize, std::numeric_limits<double>::infinity());
  sigma.segment<3>(kVelocityAt).setConstant(velocity_sigma);
  add(makeBlockPrior(manifoldOf(BlockKey::kMotion), MotionBlock::Zero(), sigma), {{BlockKey::kMotion, frame.id}});
}

void WindowFactors::addPoints() {
  for (const auto& [id, track] : window_.points)
    if (track.triangulated) addPoint(track);
}

void WindowFactors::addPoint(const PointTrack& track) {
  if (track.sightings.size() < 2) return;  // one sighting says nothing about the cameras
  for (const PointSighting& s : track.sightings) {
    point_factors_.emplace_back(s.px, window_.camera(), motionOf(s.frame), track.origin_w, params_.point_sigma_px);
    factors_.push_back({&point_factors_.back(),
                        &point_loss_,
                        {{BlockKey::kPose, s.frame},
                         {BlockKey::kExtrinsics, 0},
                         {BlockKey::kCorrection, 0},
                         {BlockKey::kPoint, track.id}}});
  }
}

void WindowFactors::addLines(const DegeneracyParams& degeneracy) {
  for (const auto& [id, track] : window_.lines)
    if (entersProblem(track, degeneracy)) addLine(track, degeneracy);
}

void WindowFactors::addLine(const LineTrack& track, const DegeneracyParams& degeneracy) {
  if (!track.placed) {
    for (const LineSighting& s : track.sightings) addVanishing(track, s, degeneracy);
    return;
  }
  if (track.sightings.size() < 2) return;  // one sighting says nothing about the cameras
  addSightings(track);
  if (track.group == 0) return;
  setStructuralLoss(degeneracy);
  add(std::make_unique<SharedDirectionFactor>(1 / degeneracy.structural_sigma_rad),
      {{BlockKey::kLine, track.id}, {BlockKey::kDirection, track.group}});
  factors_.back().loss = structural_loss_.get();
}

void WindowFactors::addSightings(const LineTrack& track) {
  for (const LineSighting& s : track.sightings) {
    const double weight = window_.camera().meanFocal() / (params_.line_sigma_px * s.sigma_px);
    line_factors_.emplace_back(s.start, s.end, motionOf(s.frame), track.origin_w, weight);
    factors_.push_back({&line_factors_.back(),
                        &line_loss_,
                        {{BlockKey::kPose, s.frame},
                         {BlockKey::kExtrinsics, 0},
                         {BlockKey::kCorrection, 0},
                         {BlockKey::kLine, track.id}}});
  }
}

void WindowFactors::addVanishing(const LineTrack& track, const LineSighting& s, const DegeneracyParams& degeneracy) {
  setStructuralLoss(degeneracy);
  const double sigma = planeSigma(window_, params_, s, window_.directions.at(track.group).d_w);
  add(std::make_unique<VanishingFactor>(s.start, s.end, motionOf(s.frame),
                                        1 / std::hypot(sigma, degeneracy.structural_sigma_rad)),
      {{BlockKey::kPose, s.frame},
       {BlockKey::kExtrinsics, 0},
       {BlockKey::kCorrection, 0},
       {BlockKey::kDirection, track.group}});
  factors_.back().loss = structural_loss_.get();
}

void WindowFactors::setStructuralLoss(const DegeneracyParams& degeneracy) {
  if (!structural_loss_) structural_loss_ = std::make_unique<ceres::CauchyLoss>(degeneracy.structural_loss_width);
}

}  // namespace lintel
