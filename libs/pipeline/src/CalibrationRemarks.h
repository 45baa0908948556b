// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Rig.h"
#include "lintel/estimator/Estimator.h"
#include "lintel/mapping/BatchRefinement.h"

namespace lintel {

/// What a run found about the shutter that the calibration does not say: rows that were exposed one after the other
/// where none is given, or a readout that is another. Empty: nothing.
std::string readoutRemark(const Rig& given, const CalibrationEstimate& estimate);

/// What it found about the accelerometer's axes, `A` as AxesErrors should be given: that they are wrong by more than
/// the prior explains, or by more than any sensor's are. Empty: nothing.
std::string accelerometerAxesRemark(const AxesErrors& given, const Eigen::Matrix3d& A);

/// The same of the gyroscope's.
std::string gyroscopeAxesRemark(const AxesErrors& given, const Eigen::Matrix3d& G);

/// What it found about the images' stamps: that they are off, each by its own amount. Empty: nothing.
std::string stampRemark(const CalibrationEstimate& estimate);

}  // namespace lintel
