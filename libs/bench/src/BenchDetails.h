// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/bench/BenchResults.h"
#include "lintel/bench/BenchSuite.h"
#include "lintel/reporting/Table.h"

namespace lintel {

// Tables with a row a recording and configuration, a column a figure; medians over the repetitions.

/// All that decides between configurations side by side; its last column is CPU time.
Table methodTable(const BenchSuite& suite, const BenchResults& results);
Table coverageTable(const BenchSuite& suite, const BenchResults& results);
/// The paper's tracking table and what the estimator made of the tracks.
Table trackingTable(const BenchSuite& suite, const BenchResults& results);
Table mapTable(const BenchSuite& suite, const BenchResults& results);
Table timingTable(const BenchSuite& suite, const BenchResults& results);

}  // namespace lintel
