// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Frame.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

/// What is wrong with a map whose sections are whole, in words that follow its name; empty: nothing. Maps may come from
/// anyone, and their numbers become indices and differences.
std::string whatIsWrong(const LineMap& map);

/// The same of the IMU samples of one keyframe, before anything is integrated.
std::string wrongSamples(const ImuBatch& samples);

}  // namespace lintel
