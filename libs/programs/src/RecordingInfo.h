// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// What `lintel-vio --info` does.
struct InfoRequest {
  std::string recording;         ///< empty: the calibration files alone
  RecordingParams params;        ///< sensors and calibration
  std::string save_calibration;  ///< file to write the rig to; empty for none
  std::string form = "kalibr";   ///< of that file
  bool overwrite = false;
};

/// Prints the sensors of a recording, its rig in words, and on `err` what looks wrong; saves the rig where asked. A
/// recording without calibration is listed all the same. Throws RecordingError or std::runtime_error.
void printRecordingInfo(const InfoRequest& request, std::ostream& out, std::ostream& err);

}  // namespace lintel
