// SPDX-License-Identifier: BSD-3-Clause
#include "ArrivalStream.h"

namespace lintel {

std::optional<FrameRef> ArrivalStream::nextFrame(const WarningSink& warn) {
  const auto read = [&](std::int64_t) { return source().nextFrame(warn); };
  return frames_.next(read, [&](const std::string& remark) { warn(Fault::Other, path() + ": " + remark); });
}

std::optional<ImuSample> ArrivalStream::nextImu(std::int64_t needed_ns, const WarningSink& warn) {
  const auto read = [&](std::int64_t ahead_ns) { return source().nextImu(needed_ns + ahead_ns, warn); };
  const auto say = [&](const std::string& remark) { warn(Fault::Other, path() + ": " + remark); };
  const auto where = [this] { return path(); };
  while (std::optional<ImuSample> sample = samples_.next(read, say))
    if (gate_.admit(sample->t_ns, where, warn)) return sample;
  return std::nullopt;
}

}  // namespace lintel
