// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Why the window cannot be trusted any more, in words; empty when it can. `predicted`: the newest pose before the
/// images were used. [Qin2018, failure detection]
std::string findFailure(const SlidingWindow& window, const FailureParams& params, const Pose& predicted_T_w_b);

}  // namespace lintel
