// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Pose.h"

namespace lintel {

// What is known about single states without any measurement of them, for the sliding window and for the batch
// refinement alike. Priors are over one block where nothing else is said.

/// Ties position and yaw of a pose block to what they are: the four directions that no measurement sees.
std::unique_ptr<PriorFactor> makeGaugePrior(const PoseBlock& pose);

/// The params for this camera: lengths in its pixels; a distortion that is zero throughout is taken as not known, not
/// as measured.
EstimatorParams paramsFor(const Camera& camera, const EstimatorParams& params);

/// What belongs together in a calibration is right or wrong together, so each part is a prior of its own. A part that
/// is refined takes a robust loss (CalibrationParams::loss_width); one that is not is held and takes none.
struct PriorPart {
  std::unique_ptr<PriorFactor> factor;
  bool refined = true;
};
using PriorParts = std::vector<PriorPart>;

/// The extrinsics T_b_c, to within their sigmas about the calibrated ones: position, rotation.
PriorParts makeExtrinsicsPriors(const CalibrationParams& params, const Pose& T_b_c_calibrated);

/// The correction about zero: focal lengths, image centre, distortion, readout, time offset.
PriorParts makeCorrectionPriors(const CalibrationParams& params);

/// Zero velocity of a body at rest, to within `velocity_sigma` [m/s]; a motion block.
std::unique_ptr<PriorFactor> makeRestPrior(double velocity_sigma);

/// Two poses at one position, to within `position_sigma` [m]; their pose blocks, the earlier one first.
std::unique_ptr<PriorFactor> makeStillPrior(const PoseBlock& earlier, double position_sigma);

/// Standard deviations of what the axes of an IMU are wrong by (the axes block): those of calibrated sensors, for
/// scales and directions [rad], unless an element of the sensor has been `found` beyond three of them. Such elements
/// are eight times as uncertain, and the sensor's others four times.
AxesBlock axesSigmas(const AxesBlock& found, const CalibrationParams& params);

/// The axes block about zero, with the standard deviations of axesSigmas(). It takes no robust loss: where the motion
/// does not show some of it, errors of the images would lead them anywhere.
PriorPart makeAxesPrior(const AxesBlock& found, const CalibrationParams& params);

/// The mean bias of a run about `mean` [m/s^2].
std::unique_ptr<PriorFactor> makeMeanBiasPrior(const Eigen::Vector3d& mean, const InitializerParams& params);

/// Velocity and gyroscope's bias of a run's first state about those of `motion` with these standard deviations, and the
/// accelerometer's bias about the mean bias by the correlated noise. The motion block, the mean bias.
std::unique_ptr<PriorFactor> makeFirstMotionPrior(const MotionBlock& motion, double velocity_sigma,
                                                  double bias_gyro_sigma, const ImuNoise& noise);

}  // namespace lintel
