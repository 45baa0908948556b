// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ImuSource.h"

namespace lintel {

/// A time as tables write it, with its unit: of the header ("[ns]", "_us", "(s)"), or as its size says.
enum class TimeUnit { kUnknown, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// The unit that the heading of a column names.
TimeUnit timeUnitOf(const std::string& heading);

/// A time in nanoseconds, exact for integers and decimals; empty when `text` is no time. Without a unit: seconds when
/// it has decimals, else by its digits, as times of this century.
std::optional<std::int64_t> parseTime_ns(const std::string& text, TimeUnit unit);

/// When an image was taken, and which.
struct TimedImage {
  std::int64_t t_ns = 0;  ///< as written
  std::string name;       ///< empty: the next one
};

/// A table of images: a time a line, or a time and a file's name in either order. Throws RecordingError.
std::vector<TimedImage> readImageTimes(const std::string& file);

/// The samples of a table: columns by the names of the header, whatever their order (gx gy gz, gyro_x, w_RS_S_x
/// [rad/s], angular_velocity.x, ax, acc_x …), or without header a time, angular rates, accelerations. Units of the
/// header: deg/s, g, ms …; else rad/s and m/s^2. `sensors`: what the table has to have; the other stays 0. Throws
/// RecordingError.
enum class ImuColumns { kBoth, kGyro, kAccel };
ImuSource openImuTable(const std::string& file, ImuColumns sensors);

}  // namespace lintel
