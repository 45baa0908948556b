// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/pipeline/Odometry.h"
#include "lintel/reporting/HtmlPage.h"

namespace lintel {

/// Places that were seen again: from when to when, how many points say so, the drift before and after the refinement;
/// and why others were refused. Nothing where they were not looked for.
void loopSection(HtmlPage& page, const OdometryResult& result);

}  // namespace lintel
