// SPDX-License-Identifier: BSD-3-Clause
#include "ClockSearch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "lintel/core/Hypotheses.h"

namespace lintel {

namespace {

constexpr double kLongest_s = 5;  // of turning; and the tracks that are compared at a time
constexpr double kFirstTry_s = 1.5, kTryGrowth = 1.5, kTriesApart_s = 2.5;
constexpr double kNewTurning_s = 0.3;  // since the last try, for another one
constexpr double kImuBefore_s = 2 * kLargestClockOffset_s;
constexpr double kGoodSigma_s = 0.004;    // found before kLongest_s, ends the search
constexpr double kUsableSigma_s = 0.008;  // later: a quick turn moves points by some pixels in that time
constexpr double kRightShare = 0.5;       // of recordings, whose stamps are right
// Of the search's standard deviation: it counts errors as shared by all points of two images, and by pairs that
// overlap.
constexpr double kErrorShare = 0.5;
constexpr double kTypicalOffset_s = 0.02;  // of the others: exposure, readout, transfer
constexpr double kLeastTurn_rad_s = 0.03;  // slower turns show the offset to tens of milliseconds only
constexpr std::size_t kMostHeld_bytes = std::size_t{1} << 29;  // of images while the camera is still

std::size_t bytesOf(const Frame& frame) { return frame.image ? frame.image->pixels.size() : 0; }

/// How long the camera turned since the frame before; 0 where the images do not tell.
double turningSeconds(const CameraTurn& turn) {
  const double dt_s = 1e-9 * static_cast<double>(turn.to_ns - turn.from_ns);
  return turn.known() && turn.rotation.norm() > kLeastTurn_rad_s * dt_s ? dt_s : 0;
}

template <class Item>
void eraseBefore(std::int64_t t_ns, std::vector<Item>& items) {
  const auto earlier = [t_ns](const Item& item) { return item.t_ns < t_ns; };
  items.erase(items.begin(), std::find_if_not(items.begin(), items.end(), earlier));
}

/// What is known of the offset after the search: the stamps are right to `stamp_sigma_s`, or off by some tens of
/// milliseconds. The likelier of both is taken, with a standard deviation that covers the other.
void weigh(double stamp_sigma_s, ClockSearch& search) {
  search.sigma_s = stamp_sigma_s;
  if (!search.clock.determined) return;
  const double found_s = search.clock.offset_s, error_s = std::hypot(kErrorShare * search.clock.sigma_s, stamp_sigma_s),
               right = kRightShare * normalDensity(found_s, error_s),
               wrong = (1 - kRightShare) * std::exp(-std::abs(found_s) / kTypicalOffset_s) / (2 * kTypicalOffset_s),
               share = right / (right + wrong);
  if (share > kSureShare) return;
  std::tie(search.offset_s, search.sigma_s) = likelierAndSigma(share, 0, stamp_sigma_s, found_s, search.clock.sigma_s);
}

/// The tracks of the last kLongest_s, and the IMU samples around them.
struct Newest {
  std::vector<FrameTracks> tracks;
  ImuBatch imu;

  void add(const TrackedFrame& frame) {
    tracks.push_back({frame.tracks.t_ns, frame.tracks.points, {}});
    for (const ImuSample& sample : frame.step.imu)
      if (imu.empty() || sample.t_ns > imu.back().t_ns) imu.push_back(sample);
    eraseBefore(tracks.back().t_ns - static_cast<std::int64_t>(1e9 * kLongest_s), tracks);
    eraseBefore(tracks.front().t_ns - static_cast<std::int64_t>(1e9 * kImuBefore_s), imu);
  }
};

}  // namespace

ClockSearch searchClock(TrackingStage& tracking, const Rig& rig, double stamp_sigma_s,
                        const std::function<bool()>& cancelled) {
  ClockSearch search;
  Newest newest;
  double next_try_s = kFirstTry_s, tried_s = 0;
  double turning_s = 0, compared_s = 0;  // when tracks were compared last
  std::size_t held_bytes = 0;
  double vehicle_share = 0;  // of the image, when tracks were compared last
  bool parts_grew = false;   // then: there may be more of them
  while (!(cancelled && cancelled())) {
    auto frame = tracking.next();
    if (!frame) break;
    newest.add(*frame);
    turning_s += turningSeconds(frame->turn);
    held_bytes += bytesOf(frame->step.frame);
    search.frames.push_back(std::move(*frame));
    const double t_s = 1e-9 * static_cast<double>(newest.tracks.back().t_ns - search.frames.front().tracks.t_ns);
    if (t_s < next_try_s) continue;
    next_try_s = t_s < kLongest_s ? std::min(kLongest_s, kTryGrowth * next_try_s) : next_try_s + kTriesApart_s;
    if (t_s < kLongest_s || turning_s > compared_s + kNewTurning_s) {
      compared_s = turning_s;
      for (FrameTracks& tracks : newest.tracks) tracking.leaveOutVehicle(tracks);
      parts_grew = tracking.statistics().vehicle_share > vehicle_share;
      vehicle_share = tracking.statistics().vehicle_share;
      if (parts_grew) search.clock = ClockOffset();  // tracks on them had part in it
      const ClockOffset clock = findClockOffset(newest.tracks, newest.imu, rig);
      const bool knows_more = tried_s < kLongest_s;  // than the last try, whose tracks it has
      if (clock.determined && (knows_more || !search.clock.determined || clock.sigma_s < search.clock.sigma_s))
        search.clock = clock;
      tried_s = t_s;
    }
    const double enough_s = t_s >= kLongest_s ? kUsableSigma_s : kGoodSigma_s;
    if (search.clock.determined && !parts_grew && search.clock.sigma_s < enough_s) break;
    if (t_s >= kLongest_s && (turning_s >= kLongest_s || held_bytes > kMostHeld_bytes)) break;
  }
  weigh(stamp_sigma_s, search);
  return search;
}

}  // namespace lintel
