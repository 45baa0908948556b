// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "lintel/core/Rig.h"

namespace lintel {

/// What MRPT's observations have no fields for. It stands as YAML in a CObservationComment at the head of a rawlog.
/// (MRPT does not store a comment's label: rawlog-edit --keep-label drops it, as --cut drops what comes first. The
/// reader then takes rates from the time stamps, assumes a noise and says so.)
struct RawlogNote {
  std::map<std::string, double> camera_rates_hz;  ///< by sensor label
  std::map<std::string, double> line_delays_s;    ///< of those with a rolling shutter
  ImuNoise imu_noise;
  AxesErrors axes;
  double imu_rate_hz = 0;
};

/// Numbers are written so that they read back exactly.
std::string formatNote(const RawlogNote& note);

/// Empty when the text is another program's comment. Throws RecordingError naming `where` when it is Lintel's but
/// damaged.
std::optional<RawlogNote> parseNote(const std::string& text, const std::string& where);

}  // namespace lintel
