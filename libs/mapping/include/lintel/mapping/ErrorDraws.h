// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// How often errors are drawn. A standard deviation of so many draws is good to a seventh.
constexpr int kErrorDraws = 24;

/// Errors that a camera may have, as far as the refinement leaves it open: shift [m], then turn [rad], both in world
/// axes; a draw a column. The same column of all cameras of a map belongs together: what they have in common shows.
using CameraErrors = Eigen::Matrix<float, 6, kErrorDraws>;

}  // namespace lintel
