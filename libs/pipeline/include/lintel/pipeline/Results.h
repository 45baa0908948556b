// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Writes what a run has computed into `folder`, which is made if it is absent: trajectory.tum,
/// trajectory_covariance.csv, trajectory_refined.tum (if the refinement was accepted; else one of an earlier run is
/// removed, as is its stats.json, which would say that all is there), config.yaml, map.lintel, and mask.pgm if
/// something was found to move with the camera (else one of an earlier run is removed, unless a mask was given), then
/// map.EXT for each of `exports`, extensions that exportFormats() lists. The same files, byte for byte, as lintel-vio
/// writes. Returns the exports, those to open. Throws std::runtime_error, one line naming the file.
std::vector<std::string> writeResults(const OdometryResult& result, const std::string& folder,
                                      const std::vector<std::string>& exports = {});

/// The exports alone.
std::vector<std::string> writeExports(const LineMap& map, const std::string& folder,
                                      const std::vector<std::string>& exports);

/// A trajectory as TUM text: `t x y z qx qy qz qw`, seconds with 9 decimals, metres.
std::string trajectoryText(const std::vector<OdometryPose>& trajectory);

/// Covariances of a trajectory as text, a row for each pose: seconds with 9 decimals, then the upper triangle by rows
/// in (x, y, z, yaw, pitch, roll), metres and radians.
std::string covarianceText(const std::vector<OdometryPose>& trajectory);

}  // namespace lintel
