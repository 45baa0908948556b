// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>

#include "ArrivalStream.h"
#include "AxesStream.h"
#include "BagStream.h"
#include "EurocFolder.h"
#include "EurocStream.h"
#include "ImuValuesStream.h"
#include "PlainStream.h"
#include "RawlogStream.h"
#include "ShiftedStream.h"
#include "StreamRecording.h"

namespace lintel {
namespace {

void checkParams(const RecordingParams& params) {
  if (!std::isfinite(params.from_s) || params.from_s < 0 || params.from_s > 1e9)
    throw RecordingError("from must be seconds after the first frame, 0 or more");
  if (!std::isfinite(params.to_s) || params.to_s < 0 || params.to_s > 1e9)
    throw RecordingError("to must be seconds after the first frame, 0 for the end");
  if (params.to_s > 0 && params.to_s < params.from_s) throw RecordingError("to must not be before from");
}

std::unique_ptr<SensorStream> openUnshifted(const std::string& path, const RecordingParams& params,
                                            const GivenCalibration& given) {
  std::error_code ignored;
  if (isFilm(path) && std::filesystem::exists(path, ignored)) return std::make_unique<PlainStream>(path, params, given);
  if (isImageFolder(path)) return std::make_unique<PlainStream>(path, params, given);
  if (isBag(path)) return std::make_unique<BagStream>(path, params, given);
  if (std::filesystem::is_directory(path, ignored)) return std::make_unique<EurocStream>(path, params, given);
  if (!std::filesystem::exists(path, ignored))
    throw RecordingError(
        path +
        ": does not exist: give an EuRoC folder, a .rawlog, a ROS bag (.bag .db3 .mcap), a film or a folder of images");
  return std::make_unique<RawlogStream>(path, params, given);
}

/// TUM-VI publishes EuRoC's form with Kalibr's files in the folder `dso` in the place of sensor.yaml.
RecordingParams withPublishedCalibration(const std::string& path, RecordingParams params) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!params.calibration.empty() || !fs::is_directory(path, ignored) || isBag(path) || isImageFolder(path))
    return params;
  const fs::path mav0 = findMav0(path), dso = mav0 / ".." / "dso";
  if (fs::exists(mav0 / "cam0" / "sensor.yaml", ignored)) return params;
  for (const char* name : {"camchain.yaml", "imu_config.yaml"})
    if (fs::exists(dso / name, ignored)) params.calibration.push_back((dso / name).lexically_normal().string());
  return params;
}

}  // namespace

std::unique_ptr<SensorStream> openStream(const std::string& path, const RecordingParams& own_params) {
  const RecordingParams params = withPublishedCalibration(path, own_params);
  const GivenCalibration given(params);
  std::unique_ptr<SensorStream> stream = std::make_unique<ArrivalStream>(openUnshifted(path, params, given));
  stream = std::make_unique<ImuValuesStream>(std::move(stream));
  if (!stream->rig().axes.none()) stream = std::make_unique<AxesStream>(std::move(stream));
  if (given.shift_ns() == 0) return stream;
  return std::make_unique<ShiftedStream>(std::move(stream), given.shift_ns());
}

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingParams& params) {
  checkParams(params);
  return std::make_unique<StreamRecording>(openStream(path, params), params);
}

}  // namespace lintel
