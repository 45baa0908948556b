// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "lintel/evaluation/Statistics.h"

namespace lintel {

/// Keeps the keys in the order in which they are written, so that the file reads like the text output.
using Json = nlohmann::ordered_json;

inline Json jsonOf(const ErrorStatistics& statistics) {
  return {{"count", statistics.count},
          {"rmse", statistics.rmse},
          {"mean", statistics.mean},
          {"median", statistics.median},
          {"max", statistics.max}};
}

}  // namespace lintel
