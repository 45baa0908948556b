// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace lintel {

/// The longest file that a person writes (configuration, calibration, suite) [bytes]; another one is no such file.
constexpr std::size_t kLongestText = std::size_t{16} << 20;

/// All of a text file. `throw_error` gets one line when it cannot be read to its end or is longer than `most` bytes,
/// and must throw.
std::string textOfFile(const std::string& path, void (*throw_error)(const std::string&),
                       std::size_t most = kLongestText);

/// All bytes of a file; none if it cannot be read.
std::string bytesOfFile(const std::string& path);

}  // namespace lintel
