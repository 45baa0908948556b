// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>

#include "EurocStream.h"
#include "RawlogStream.h"
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

}  // namespace

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingParams& params) {
  checkParams(params);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return std::make_unique<StreamRecording>(std::make_unique<EurocStream>(path, params), params);
  if (!std::filesystem::exists(path, ignored))
    throw RecordingError(path + ": does not exist: give an EuRoC folder or a .rawlog");
  return std::make_unique<StreamRecording>(std::make_unique<RawlogStream>(path, params), params);
}

}  // namespace lintel
