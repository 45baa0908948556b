// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/pages/RunReport.h"
#include "lintel/reporting/Table.h"

namespace lintel {

/// The calibration as given, as the last window had it, with its sigmas, and after the batch refinement where it was
/// used.
Table calibrationTable(const RunRecord& record, const OdometryResult& result);

/// Where the CPU time of the whole process went, as far as it can be known while the report is being written.
Table costsTable(const RunRecord& record, const OdometryResult& result);

}  // namespace lintel
