// SPDX-License-Identifier: BSD-3-Clause
#include "ClockSearch.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lintel {

namespace {

constexpr double kLongest_s = 5;
constexpr double kFirstTry_s = 1.5, kTryGrowth = 1.5;
constexpr double kGoodSigma_s = 0.002;
constexpr double kLeftToEstimator_s = 0.005;  // its model is linear in the offset
constexpr double kSignificant = 4;            // standard deviations

}  // namespace

ClockSearch searchClock(TrackingStage& tracking, const Rig& rig, const std::function<bool()>& cancelled) {
  ClockSearch search;
  std::vector<FrameTracks> tracks;
  ImuBatch imu;
  double next_try_s = kFirstTry_s;
  while (!(cancelled && cancelled())) {
    auto frame = tracking.next();
    if (!frame) break;
    tracks.push_back({frame->tracks.t_ns, frame->tracks.points, {}});
    for (const ImuSample& sample : frame->step.imu)
      if (imu.empty() || sample.t_ns > imu.back().t_ns) imu.push_back(sample);
    search.frames.push_back(std::move(*frame));
    const double t_s = 1e-9 * static_cast<double>(tracks.back().t_ns - tracks.front().t_ns);
    if (t_s < next_try_s) continue;
    next_try_s = std::min(kLongest_s, kTryGrowth * next_try_s);
    const ClockOffset clock = findClockOffset(tracks, imu, rig);
    if (clock.determined && (!search.clock.determined || clock.sigma_s < search.clock.sigma_s)) search.clock = clock;
    if (t_s >= kLongest_s || (search.clock.determined && search.clock.sigma_s < kGoodSigma_s)) break;
  }
  const ClockOffset& clock = search.clock;
  if (clock.determined && std::abs(clock.offset_s) > kLeftToEstimator_s + kSignificant * clock.sigma_s)
    search.offset_s = clock.offset_s;
  return search;
}

}  // namespace lintel
