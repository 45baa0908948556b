// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ImuBatcher.h"
#include "SensorStream.h"

namespace lintel {

/// What one step produces: a decoded frame with its IMU, and the faults met on the way to it.
struct Step {
  std::optional<FrameWithImu> frame;  ///< empty at the end
  std::vector<Warning> warnings;
};

/// Joins the two sensors of a stream to FrameWithImu, decoding each image. Used by one thread.
class StepProducer {
 public:
  StepProducer(std::unique_ptr<SensorStream> stream, const RecordingParams& params);

  /// Throws RecordingError.
  Step next();

 private:
  std::optional<FrameRef> nextInRange();
  std::shared_ptr<const GrayImage> decode(const FrameRef& ref);
  bool isRepeat(const FrameRef& ref, const std::shared_ptr<const GrayImage>& image);
  ImuBatch imuOf(std::int64_t t_ns);
  void checkEnd() const;
  void warn(Fault fault, std::string text) { warnings_.push_back({fault, std::move(text)}); }

  std::unique_ptr<SensorStream> stream_;
  RecordingParams params_;
  ImuBatcher imu_;
  WarningSink sink_;
  std::vector<Warning> warnings_;
  std::optional<FrameRange> range_;
  std::optional<std::int64_t> previous_ns_;
  std::shared_ptr<const GrayImage> shown_;  ///< the last image, and since when it has been the same
  std::int64_t shown_ns_ = 0;
  std::int64_t last_seen_ns_ = 0;
  std::size_t delivered_ = 0, with_imu_ = 0, unreadable_ = 0;
  std::string first_unreadable_;
  bool bridging_ = false;  ///< the last batch ended in a drop-out
};

}  // namespace lintel
