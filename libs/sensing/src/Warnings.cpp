// SPDX-License-Identifier: BSD-3-Clause
#include "Warnings.h"

namespace lintel {
namespace {

constexpr std::size_t kShownOfAKind = 3;

const char* nameOf(Fault fault) {
  switch (fault) {
    case Fault::Image:
      return "unreadable images";
    case Fault::ImageRepeat:
      return "images shown again";
    case Fault::ImageStamp:
      return "image time stamps out of order";
    case Fault::ImuStamp:
      return "IMU time stamps out of order";
    case Fault::ImuValue:
      return "IMU samples that are not finite";
    case Fault::ImuSpike:
      return "spikes of the IMU";
    case Fault::ImuRange:
      return "ends of the IMU's ranges";
    case Fault::CutLine:
      return "incomplete lines";
    case Fault::ImuGap:
      return "frames without IMU";
    case Fault::ImuBridged:
      return "drop-outs of the IMU";
    case Fault::Calibration:
      return "calibration faults";
    case Fault::Other:
      break;
  }
  return "other faults";
}

}  // namespace

void WarningLog::add(const Warning& warning) {
  Kind& kind = kinds_[warning.fault];
  ++kind.count;
  if (kind.texts.size() < kShownOfAKind) kind.texts.push_back(warning.text);
}

std::vector<std::string> WarningLog::lines() const {
  std::vector<std::string> all;
  for (const auto& [fault, kind] : kinds_) {
    all.insert(all.end(), kind.texts.begin(), kind.texts.end());
    const std::size_t hidden = kind.count - kind.texts.size();
    if (hidden > 0) all.push_back("and " + std::to_string(hidden) + " more " + nameOf(fault));
  }
  return all;
}

}  // namespace lintel
