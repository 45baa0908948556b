// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>

#include "BagStream.h"
#include "EurocStream.h"
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
  if (isBag(path)) return std::make_unique<BagStream>(path, params, given);
  if (std::filesystem::is_directory(path, ignored)) return std::make_unique<EurocStream>(path, params, given);
  if (!std::filesystem::exists(path, ignored))
    throw RecordingError(path + ": does not exist: give an EuRoC folder, a .rawlog, or a ROS bag (.bag .db3 .mcap)");
  return std::make_unique<RawlogStream>(path, params, given);
}

}  // namespace

std::unique_ptr<SensorStream> openStream(const std::string& path, const RecordingParams& params) {
  const GivenCalibration given(params);
  std::unique_ptr<SensorStream> stream = openUnshifted(path, params, given);
  if (given.shift_ns() == 0) return stream;
  return std::make_unique<ShiftedStream>(std::move(stream), given.shift_ns());
}

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingParams& params) {
  checkParams(params);
  return std::make_unique<StreamRecording>(openStream(path, params), params);
}

}  // namespace lintel
