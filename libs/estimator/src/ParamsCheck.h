// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"

namespace lintel {

/// Throws std::invalid_argument naming the parameter that is out of range or contradicts another one.
void checkParams(const EstimatorParams& params);

}  // namespace lintel
