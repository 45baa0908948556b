// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "Warnings.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

/// An image that cannot be decoded; what() is one line naming the file.
class ImageFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An image not yet decoded.
struct FrameRef {
  std::int64_t t_ns = 0;
  std::function<GrayImage()> decode;  ///< throws ImageFault
};

/// The two sensors of a recording, each in its own time order, not yet cut into frames and batches.
class SensorStream {
 public:
  virtual ~SensorStream() = default;

  virtual const Rig& rig() const = 0;
  virtual const std::string& path() const = 0;

  /// Faults met when the stream was opened.
  virtual std::vector<Warning> openingWarnings() const { return {}; }

  /// Frames that nextFrame will deliver, if known; else 0. Independent of the stream's position.
  virtual std::size_t countFrames(const RecordingParams& params) const = 0;

  /// The next image, times strictly increasing; empty at the end. Throws RecordingError.
  virtual std::optional<FrameRef> nextFrame(const WarningSink& warn) = 0;

  /// The next IMU sample, times increasing, values finite; two have the same time only where a stream of a file hands
  /// on samples that were stamped together on arrival (those of openStream() do not). Empty when there is none that
  /// belongs to times up to `needed_ns`: later calls with a later time may find one. Throws RecordingError.
  virtual std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) = 0;
};

/// Opens what openRecording() opens, with the same errors.
std::unique_ptr<SensorStream> openStream(const std::string& path, const RecordingParams& params);

/// Range of frame times that params ask for [ns], both included, given the first frame's time.
struct FrameRange {
  std::int64_t from_ns, to_ns;
  FrameRange(const RecordingParams& params, std::int64_t first_ns);
};

}  // namespace lintel
