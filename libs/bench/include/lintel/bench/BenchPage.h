// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/bench/BenchResults.h"

namespace lintel {

/// The tables with pictures, in one file. Reads what the jobs have left for the pictures.
std::string benchPage(const BenchSuite& suite, const BenchResults& results);

}  // namespace lintel
