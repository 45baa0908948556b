// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <exception>
#include <memory>

#include "lintel/sensing/Recording.h"

namespace lintel {

class ImuBatcher;

/// A recording whose IMU is read on a clock that differs from the camera's by a constant: an image with stamp t shows
/// the world at t + offset of the IMU's clock. Frames keep their stamps, the IMU's stamps are moved to them.
class ShiftedRecording : public Recording {
 public:
  /// `read`: steps that have been taken from `source` already; they are given again, and then `fault` is thrown, if it
  /// is set. With an offset of 0 everything is passed on as it is.
  ShiftedRecording(Recording& source, std::deque<FrameWithImu> read, double offset_s, std::exception_ptr fault = {});
  ~ShiftedRecording() override;

  const Rig& rig() const override { return source_.rig(); }
  std::optional<FrameWithImu> next() override;
  std::size_t expectedFrames() const override { return source_.expectedFrames(); }
  std::vector<std::string> warnings() const override { return source_.warnings(); }

 private:
  std::optional<FrameWithImu> read();
  bool readOn();
  void take(const ImuBatch& batch);
  std::optional<ImuSample> nextSample();

  Recording& source_;
  std::int64_t shift_ns_;
  std::exception_ptr fault_;
  std::deque<FrameWithImu> ahead_;  ///< frames whose IMU has been read, or is about to be
  std::size_t taken_ = 0;           ///< of these, how many gave their IMU
  std::deque<ImuSample> samples_;
  std::int64_t newest_ns_ = 0, previous_ns_ = 0;
  bool first_ = true;
  std::unique_ptr<ImuBatcher> batcher_;
};

}  // namespace lintel
