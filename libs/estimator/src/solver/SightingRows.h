// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lintel/factors/StateBlocks.h"
#include "solver/CameraPairs.h"

namespace lintel {

/// A sighting's residual of two coordinates, and what it depends on besides the camera. Columns: the target's tangent
/// space, the correction, the residual; those of the target that it does not have are 0.
constexpr int kTargetColumns = 4, kCorrectionColumn = kTargetColumns, kResidualColumn = 11, kSightingColumns = 12;
static_assert(kCorrectionColumn + kSightingCorrection == kResidualColumn, "the columns follow each other");
using SightingRows = Eigen::Matrix<double, 2, kSightingColumns, Eigen::RowMajor>;

/// Rows of sightings, transposed, times weighted rows of the same.
struct SightingProducts {
  Eigen::Matrix<double, kSightingColumns, kSightingColumns, Eigen::RowMajor> all;  ///< the sum: upper triangle
  std::vector<Eigen::Matrix<double, kCameraTangent, kSightingColumns, Eigen::RowMajor>> by_camera;  ///< of camera rows
};

/// The products of rows A_i and camera rows J_i with weighted rows B_i.
void multiplySightings(const std::vector<SightingRows>& A, const std::vector<CameraRows>& J,
                       const std::vector<SightingRows>& B, SightingProducts& products);

}  // namespace lintel
