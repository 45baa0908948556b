// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lintel/factors/CameraView.h"

namespace lintel {

/// d residual / d camera of a sighting, by rows.
using CameraRows = Eigen::Matrix<double, 2, kCameraTangent, Eigen::RowMajor>;

/// Adds information(i, j) J_i' J_j to the blocks of H in which the cameras of the sightings i and j meet, i >= j.
/// `information`: symmetric, J.size() rows and columns. `places`: first rows of the cameras in H, ascending.
void addCameraPairs(const std::vector<CameraRows>& J, const std::vector<double>& information,
                    const std::vector<Eigen::Index>& places, Eigen::MatrixXd& H);

}  // namespace lintel
