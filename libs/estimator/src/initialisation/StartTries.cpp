// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartTries.h"

#include <algorithm>

#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

namespace {

constexpr int kBetweenTries = 4, kAfterWrongStart = 5;  // window frames
constexpr int kInVain = 4;                              // tries: two seconds
constexpr double kApart = 0.1;                          // of the wait for the scale
constexpr double kMoreFrames = 0.1;                     // than the buffer had in the last try

}  // namespace

bool StartTries::due() {
  waited_for_scale_ += for_scale_ ? 1 : 0;
  if (frames_to_wait_ == 0) return true;
  --frames_to_wait_;
  return false;
}

void StartTries::failed(const std::string& reason) {
  reason_ = reason;
  for_scale_ = reason == kScaleUnknown;
  in_vain_ = for_scale_ ? 0 : in_vain_ + 1;
  if (!for_scale_) waited_for_scale_ = 0;
  frames_to_wait_ = std::max(kBetweenTries, static_cast<int>(kApart * waited_for_scale_));
}

void StartTries::failedWhileGrowing(std::size_t frames, const std::string& reason) {
  reason_ = reason;
  frames_to_wait_ = std::max(0, static_cast<int>(kMoreFrames * static_cast<double>(frames)) - 1);
}

bool StartTries::mayBeShorter() const { return in_vain_ >= kInVain; }

void StartTries::startWasWrong() {
  reset();
  frames_to_wait_ = kAfterWrongStart;
  reason_ = "the start before was wrong";
}

}  // namespace lintel
