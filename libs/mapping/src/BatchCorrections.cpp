// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: the corrections of the calibration. They are the same all the time but for the offset between the
// clocks of camera and IMU, so that each stretch of time has a block of its own, held to those beside it.
#include <algorithm>
#include <cmath>

#include "BatchProblem.h"
#include "BlockChange.h"

namespace lintel {

namespace {

constexpr double kStretch_s = 1;  // an offset that walks changes by less than its sigma within it
constexpr double kAnchors = 2;    // in a stretch, of a long flight: where it stays in one place all blocks are dense

/// How long the IMU leads from keyframe to keyframe.
double duration_s(const std::vector<RetiredKeyframe>& keyframes) {
  double sum_s = 0;
  for (const RetiredKeyframe& keyframe : keyframes)
    if (keyframe.imu) sum_s += keyframe.imu->dt_s();
  return sum_s;
}

CorrectionBlock correctionFrom(const Camera& camera, const Camera& calibrated, double time_offset_s) {
  CorrectionBlock c;
  c << camera.fx - calibrated.fx, camera.fy - calibrated.fy, camera.cx - calibrated.cx, camera.cy - calibrated.cy,
      camera.lens[0] - calibrated.lens[0], camera.lens[1] - calibrated.lens[1], 0, time_offset_s;
  return c;
}

/// Holds all corrections but the offset: to a thousandth of what is known of them beforehand.
CorrectionBlock weightsOfTheSame(const CalibrationParams& p) {
  CorrectionBlock sigmas;
  sigmas << p.focal_sigma_px, p.focal_sigma_px, p.centre_sigma_px, p.centre_sigma_px, p.distortion_sigma,
      p.distortion_sigma, p.readout_sigma_s, 1;
  CorrectionBlock weights = 1e3 * sigmas.cwiseInverse();
  weights[kTimeOffsetAt] = 0;
  return weights;
}

}  // namespace

/// Each begins with an anchor, and with every piece another one: that may be of another recording, earlier or later.
void BatchProblem::findStretches() {
  const bool changes = refinement_.offset_walk_s > 0 && estimator_.calibration.refine_time_offset;
  const double stretch_s = std::max(kStretch_s, kAnchors * duration_s(material_.keyframes) / anchorCount());
  std::int64_t start_ns = 0;
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    const std::int64_t t_ns = material_.keyframes[k].t_ns;
    const bool piece = !material_.keyframes[k].imu, late = static_cast<double>(t_ns - start_ns) > 1e9 * stretch_s;
    const bool begins = k == 0 || (changes && isAnchor(k) && (piece || late));
    if (begins) start_ns = t_ns;
    stretches_.push_back(k == 0 ? 0 : stretches_.back() + (begins ? 1 : 0));
  }
}

void BatchProblem::placeCorrections() {
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    if (k > 0 && stretches_[k] == stretches_[k - 1]) continue;
    Eigen::Map<CorrectionBlock>(at(correctionAt(k))) = correctionFrom(
        material_.rig.camera, calibrated_.camera, material_.time_offset_s + material_.keyframes[k].offset_change_s);
    problem_->AddParameterBlock(at(correctionAt(k)), kCorrectionSize);
  }
}

void BatchProblem::addCorrectionChanges() {
  const CorrectionBlock same = weightsOfTheSame(estimator_.calibration);
  for (std::size_t k = 1; k < stretches_.size(); ++k) {
    if (stretches_[k] == stretches_[k - 1]) continue;
    std::size_t before = k - 1;
    while (before > 0 && stretches_[before - 1] == stretches_[before]) --before;
    const std::int64_t dt_ns = material_.keyframes[k].t_ns - material_.keyframes[before].t_ns;
    const double dt_s = std::max(kStretch_s, std::abs(1e-9 * static_cast<double>(dt_ns)));
    CorrectionBlock walk = CorrectionBlock::Zero();
    walk[kTimeOffsetAt] = 1 / (refinement_.offset_walk_s * std::sqrt(dt_s));
    own_factors_.push_back(std::make_unique<BlockChange<kCorrectionSize>>(same));
    problem_->AddResidualBlock(own_factors_.back().get(), nullptr, at(correctionAt(before)), at(correctionAt(k)));
    own_factors_.push_back(std::make_unique<BlockChange<kCorrectionSize>>(walk));
    problem_->AddResidualBlock(own_factors_.back().get(), &offset_loss_, at(correctionAt(before)), at(correctionAt(k)));
  }
}

/// The material's offset is the mean.
void BatchProblem::writeBackOffsets() {
  material_.time_offset_s = 0;
  for (std::size_t i = 0; i < stretches(); ++i)
    material_.time_offset_s += at(correctionOf(i))[kTimeOffsetAt] / static_cast<double>(stretches());
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k)
    material_.keyframes[k].offset_change_s = at(correctionAt(k))[kTimeOffsetAt] - material_.time_offset_s;
}

}  // namespace lintel
