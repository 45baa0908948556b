// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "lintel/bench/BenchResults.h"
#include "lintel/reporting/Table.h"

namespace lintel {

/// The tables of a suite. All but those with CPU times are the same whenever and wherever the jobs ran.
std::vector<Table> benchTables(const BenchSuite& suite, const BenchResults& results);

/// Whether a table holds CPU times.
bool differsFromRunToRun(const Table& table);

/// Figures for programs: per recording and configuration, and every single run. Nothing that depends on the machine.
nlohmann::ordered_json benchJson(const BenchSuite& suite, const BenchResults& results);

}  // namespace lintel
