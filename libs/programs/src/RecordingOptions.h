// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandLine.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

/// The options of every program that opens a recording: which sensors of it, and their calibration.
void addRecordingOptions(CommandLine& line, RecordingParams& params);

}  // namespace lintel
