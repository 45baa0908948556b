// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

namespace mrpt::obs {
class CObservation;
}

namespace lintel {

class GzInput;
class GzOutput;

/// Reads the observations of a rawlog one by one, in the file's order; those of sensory frames too.
class RawlogFile {
 public:
  /// Throws RecordingError when the file cannot be opened.
  explicit RawlogFile(const std::string& path);
  ~RawlogFile();

  /// Null at the end; a stereo pair is given as the CObservationImage of its left camera. Throws RecordingError when
  /// the file is cut, corrupt or no rawlog.
  std::shared_ptr<mrpt::obs::CObservation> next();

  /// The same, but with stereo pairs and damaged flags as they are in the file.
  std::shared_ptr<mrpt::obs::CObservation> nextAsRead();

  /// "file: entry N", N counting from 0 as rawlog-edit does.
  std::string where() const;

 private:
  std::string path_;
  std::unique_ptr<GzInput> stream_;
  std::deque<std::shared_ptr<mrpt::obs::CObservation>> pending_;
  std::size_t entries_ = 0;
};

/// Appends an observation to a rawlog. Throws std::runtime_error (disk full).
void writeObservation(GzOutput& file, const mrpt::obs::CObservation& observation);

/// Time of an observation [ns since 1970]; negative when it has none.
std::int64_t timeOf(const mrpt::obs::CObservation& observation);

}  // namespace lintel
