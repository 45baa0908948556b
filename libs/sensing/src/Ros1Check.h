// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lintel {

/// Whether the records of a ROS 1 bag lie within the file and the messages within their chunks (format 2.0,
/// http://wiki.ros.org/Bags/Format/2.0). The library that reads bags takes all lengths for granted: it asks for memory
/// by them and reads beyond buffers. Of chunks compressed by bz2 only the
/// sizes are looked at. Throws
/// RecordingError, one line without the file's name.
void checkRos1Bag(const std::string& path);

}  // namespace lintel
