// SPDX-License-Identifier: BSD-3-Clause
#include "EurocFolder.h"

#include <filesystem>

#include "TimeTicks.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

namespace fs = std::filesystem;

std::string findMav0(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) throw RecordingError(path + ": no such folder: give an EuRoC folder");
  for (const fs::path& folder : {fs::path(path) / "mav0", fs::path(path)})
    if (fs::is_directory(folder / "cam0", ignored) || fs::is_directory(folder / "imu0", ignored))
      return folder.string();
  throw RecordingError(path +
                       ": neither it nor its mav0 holds cam0 and imu0: give an EuRoC folder (.../mav0 or its parent)");
}

EurocImageList::EurocImageList(const std::string& folder)
    : folder_((fs::path(folder) / "data").string()), csv_((fs::path(folder) / "data.csv").string(), 2) {}

std::optional<ImageEntry> EurocImageList::next(const WarningSink& warn) {
  while (csv_.next(warn)) {
    const std::int64_t t_ns = cutToTick(csv_.time_ns());
    if (gate_.admit(
            t_ns, [this] { return csv_.where(); }, warn))
      return ImageEntry{t_ns, (fs::path(folder_) / csv_.field(1)).string()};
  }
  return std::nullopt;
}

EurocImuList::EurocImuList(const std::string& folder) : csv_((fs::path(folder) / "data.csv").string(), 7) {}

std::optional<ImuSample> EurocImuList::next(const WarningSink& warn) {
  double v[6];
  while (csv_.next(warn)) {
    if (!csv_.numbers(1, 6, v, warn)) continue;
    const ImuSample sample{cutToTick(csv_.time_ns()), {v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (gate_.admit(
            sample, [this] { return csv_.where(); }, warn))
      return sample;
  }
  return std::nullopt;
}

}  // namespace lintel
