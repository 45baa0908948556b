// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "lintel/core/Frame.h"

namespace lintel {

/// Cuts a stream of IMU samples into the batches of Frame.h. Holds the samples of one batch only.
class ImuBatcher {
 public:
  /// Two samples further apart than this are a drop-out: one period of a 20 Hz camera, ten samples of a 200 Hz IMU.
  static constexpr std::int64_t kMaxGap_ns = 50'000'000;
  /// A drop-out up to this long is filled with interpolated samples, each this far from the next; a longer one ends the
  /// batch. The samples say that they were not measured (ImuSample::bridged).
  static constexpr std::int64_t kMaxBridge_ns = 500'000'000, kBridgeStep_ns = 10'000'000;
  /// Span before the first frame that its batch covers.
  static constexpr std::int64_t kLeadIn_ns = 500000000;

  /// Gives the next sample that is needed for times up to the argument; empty when there is none.
  using Next = std::function<std::optional<ImuSample>(std::int64_t needed_ns)>;
  explicit ImuBatcher(Next next) : next_(std::move(next)) {}

  /// Samples of the last 0.5 s before `t_ns` (after the last drop-out, bridged or not), ending with one at `t_ns`;
  /// empty when `t_ns` is not covered.
  ImuBatch before(std::int64_t t_ns);

  /// Samples from `t0_ns` to `t1_ns`, both ends included; empty when they are not covered throughout.
  ImuBatch between(std::int64_t t0_ns, std::int64_t t1_ns);

  /// Forgets what no batch of a frame at or after `t_ns` needs.
  void skipTo(std::int64_t t_ns) { readTo(t_ns, t_ns - kLeadIn_ns); }

 private:
  void readTo(std::int64_t t_ns, std::int64_t keep_from_ns);
  void append(ImuSample sample);
  std::optional<ImuSample> at(std::int64_t t_ns) const;

  Next next_;
  std::deque<ImuSample> samples_;
};

}  // namespace lintel
