// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "lintel/core/FolderLock.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// The folder that a run writes to, locked against other runs as long as the object lives.
class RunFolder {
 public:
  /// Makes the folder if need be, and removes what killed runs have left half-written. Throws std::runtime_error when
  /// it cannot be made or written to, another run holds it, or it has results and `overwrite` is false.
  RunFolder(const std::string& path, bool overwrite);
  /// Removes the folder if it was made here and is empty.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

 private:
  void removeParts() const;

  std::string path_;
  bool made_ = false;
  std::optional<FolderLock> lock_;
};

/// The poses so far, in FOLDER/trajectory.partial.tum: appended every few seconds, so that a run that is killed loses
/// no more. Gone when the run has written its results.
class TrajectoryCheckpoint {
 public:
  /// `every_s`: seconds of wall time; 0 writes nothing.
  TrajectoryCheckpoint(const std::string& folder, double every_s);
  ~TrajectoryCheckpoint();
  TrajectoryCheckpoint(const TrajectoryCheckpoint&) = delete;
  TrajectoryCheckpoint& operator=(const TrajectoryCheckpoint&) = delete;

  /// Takes the pose, and writes if it is time.
  void add(const OdometryPose& pose);
  /// Writes what is left.
  void flush();
  /// What follows is of another start.
  void endStart();
  /// Takes away what was added since endStart().
  void withdrawStart();
  /// Removes the file: the results are written.
  void remove();
  /// Why it could not be written; empty if it could. The run goes on, as there may be space at its end.
  const std::string& fault() const { return fault_; }

  static std::string fileIn(const std::string& folder);

 private:
  using Clock = std::chrono::steady_clock;
  void write();

  std::string path_;
  double every_s_;
  Clock::time_point last_ = Clock::now();
  std::vector<OdometryPose> waiting_;
  int descriptor_ = -1;
  off_t settled_bytes_ = 0;  ///< of former starts
  std::string fault_;
};

}  // namespace lintel
