// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "EurocTable.h"
#include "SampleGate.h"
#include "lintel/core/Frame.h"

namespace lintel {

/// The folder that holds cam0 and imu0: `path` or its `mav0`. Throws RecordingError when there is none.
std::string findMav0(const std::string& path);

/// An image listed in camN/data.csv.
struct ImageEntry {
  std::int64_t t_ns = 0;  ///< cut to ticks
  std::string path;
};

/// Reads camN/data.csv in step; times strictly increasing.
class EurocImageList {
 public:
  /// `folder`: …/mav0/camN. Throws RecordingError.
  explicit EurocImageList(const std::string& folder);
  std::optional<ImageEntry> next(const WarningSink& warn);
  std::string where() const { return csv_.where(); }

 private:
  std::string folder_;
  EurocTable csv_;
  StampGate gate_{"image", Fault::ImageStamp};
};

/// Reads imu0/data.csv in step; times strictly increasing, values finite.
class EurocImuList {
 public:
  /// `folder`: …/mav0/imu0. Throws RecordingError.
  explicit EurocImuList(const std::string& folder);
  std::optional<ImuSample> next(const WarningSink& warn);

 private:
  EurocTable csv_;
  ImuGate gate_;
};

}  // namespace lintel
