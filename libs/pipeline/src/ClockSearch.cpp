// SPDX-License-Identifier: BSD-3-Clause
#include "ClockSearch.h"

#include <cmath>
#include <optional>
#include <vector>

#include "lintel/tracking/FrontEnd.h"

namespace lintel {

namespace {

constexpr double kLongest_s = 5;
constexpr double kFirstTry_s = 1.5, kTryEvery_s = 0.5;
constexpr double kGoodSigma_s = 0.002;
constexpr double kLeftToEstimator_s = 0.005;  // its model is linear in the offset
constexpr double kSignificant = 4;            // standard deviations

}  // namespace

ClockSearch searchClock(Recording& recording, const FrontEndParams& tracking) {
  FrontEndParams points = tracking;
  points.features = "points";
  FrontEnd front_end(recording.rig(), points);
  ClockSearch search;
  std::vector<FrameTracks> frames;
  ImuBatch imu;
  double next_try_s = kFirstTry_s;
  const auto read = [&]() -> std::optional<FrameWithImu> {
    try {
      return recording.next();
    } catch (const RecordingError&) {
      search.fault = std::current_exception();
      return std::nullopt;
    }
  };
  while (auto step = read()) {
    frames.push_back(front_end.process(step->frame, step->imu));
    for (const ImuSample& sample : step->imu)
      if (imu.empty() || sample.t_ns > imu.back().t_ns) imu.push_back(sample);
    search.read.push_back(std::move(*step));
    const double t_s = 1e-9 * static_cast<double>(frames.back().t_ns - frames.front().t_ns);
    if (t_s < next_try_s) continue;
    next_try_s += kTryEvery_s;
    const ClockOffset clock = findClockOffset(frames, imu, recording.rig());
    if (clock.determined && (!search.clock.determined || clock.sigma_s < search.clock.sigma_s)) search.clock = clock;
    if (t_s >= kLongest_s || (search.clock.determined && search.clock.sigma_s < kGoodSigma_s)) break;
  }
  const ClockOffset& clock = search.clock;
  if (clock.determined && std::abs(clock.offset_s) > kLeftToEstimator_s + kSignificant * clock.sigma_s)
    search.offset_s = clock.offset_s;
  return search;
}

}  // namespace lintel
