// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "GivenCalibration.h"
#include "ImuSource.h"
#include "PlainTables.h"
#include "SampleGate.h"
#include "SensorStream.h"

namespace lintel {

/// Whether `path` is a film (.mp4 .mkv .avi …), or a folder of images without the form of EuRoC's.
bool isFilm(const std::string& path);
bool isImageFolder(const std::string& path);

/// The tables of such a recording.
struct PlainTables {
  std::string times, imu;  ///< `imu`: a file, or one of the gyroscope and one of the accelerometer with a comma between
};

/// Those that `params` name, else those that are there (see PlainStream). Throws RecordingError.
PlainTables plainTables(const std::string& path, const RecordingParams& params);

/// The samples of one or two tables.
ImuSource openImuTables(const std::string& files);

/// A film, or a folder of images in the order of their names, with a table of times and one of IMU samples (or one each
/// of gyroscope and accelerometer). Tables that are not named are looked for: NAME_times.csv and NAME_imu.csv beside a
/// film, times.csv and imu.csv (also .txt, timestamps, data.csv) in a folder or the one above.
class PlainStream final : public SensorStream {
 public:
  /// Throws RecordingError.
  PlainStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given);

  const Rig& rig() const override { return rig_; }
  const std::string& path() const override { return path_; }
  std::vector<Warning> openingWarnings() const override { return warnings_; }
  std::size_t countFrames(const RecordingParams& params) const override;
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t, const WarningSink& warn) override { return imu_(warn); }

 private:
  void nameImages();

  std::string path_;
  PlainTables tables_;
  std::vector<Warning> warnings_;
  std::vector<TimedImage> images_;
  std::function<GrayImage(std::size_t)> decode_;
  Rig rig_;
  ImuSource imu_;
  std::size_t at_ = 0;
  StampGate gate_{"image", Fault::ImageStamp};
};

}  // namespace lintel
