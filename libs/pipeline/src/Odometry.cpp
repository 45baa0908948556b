// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Odometry.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "CalibrationRemarks.h"
#include "ClockSearch.h"
#include "EstimationStage.h"
#include "ImageRemarks.h"
#include "RefinedComparison.h"
#include "RunCheck.h"
#include "TrackingStage.h"
#include "lintel/core/BoundedQueue.h"
#include "lintel/core/Formatted.h"
#include "lintel/sensing/ShiftedRecording.h"

namespace lintel {

namespace {

/// Takes a tracked frame; false when no more are wanted.
using FrameTaker = std::function<bool(const TrackedFrame&)>;

void trackOnThisThread(TrackingStage& tracking, const FrameTaker& take) {
  while (auto frame = tracking.next())
    if (!take(*frame)) return;
}

void trackOnItsOwnThread(TrackingStage& tracking, const FrameTaker& take) {
  BoundedQueue<TrackedFrame> queue(4);
  std::exception_ptr failure;
  std::thread thread([&] {
    try {
      while (auto frame = tracking.next())
        if (!queue.push(std::move(*frame))) break;
    } catch (...) {
      failure = std::current_exception();
    }
    queue.close();
  });
  try {
    while (auto frame = queue.pop())
      if (!take(*frame)) break;
  } catch (...) {
    queue.close();
    thread.join();
    throw;
  }
  queue.close();
  thread.join();
  if (failure) std::rethrow_exception(failure);
}

/// Tracking of a recording whose clocks have been compared. The frames that this took are tracked anew where stamps had
/// to be corrected, and only handed on where they are good.
class Tracking {
 public:
  Tracking(Recording& recording, const Configuration& configuration, OdometryResult& result,
           const std::function<bool()>& cancelled)
      : stage_(std::in_place, recording, configuration.tracking, result),
        search_(searchOf(recording.rig(), configuration.estimator.calibration, cancelled)) {
    if (search_.offset_s == 0) {
      stage_->giveAgain(std::move(search_.frames));
      return;
    }
    std::deque<FrameWithImu> read;
    for (TrackedFrame& frame : search_.frames) read.push_back(std::move(frame.step));
    std::exception_ptr fault;
    if (!result.error.empty()) fault = std::make_exception_ptr(RecordingError(result.error));
    shifted_.emplace(recording, std::move(read), search_.offset_s, fault);
    result.error.clear();
    result.statistics.decoding = result.statistics.tracking = StageClock();
    stage_.emplace(*shifted_, configuration.tracking, result);
  }

  TrackingStage& stage() { return *stage_; }
  const ClockSearch& search() const { return search_; }

 private:
  ClockSearch searchOf(const Rig& rig, const CalibrationParams& calibration, const std::function<bool()>& cancelled) {
    if (calibration.find_clock_offset) return searchClock(*stage_, rig, calibration.time_offset_sigma_s, cancelled);
    ClockSearch as_stamped;
    as_stamped.sigma_s = calibration.time_offset_sigma_s;
    return as_stamped;
  }

  std::optional<ShiftedRecording> shifted_;
  std::optional<TrackingStage> stage_;
  ClockSearch search_;
};

/// The rig with the readout that the search has found.
Rig withReadout(Rig rig, const ClockSearch& search) {
  if (search.clock.readout_sigma_s > 0) rig.line_delay_s = search.clock.readout_s / rig.camera.height;
  return rig;
}

/// The configuration, time offset and readout only as well known as the search has found them.
Configuration withClock(Configuration configuration, const ClockSearch& search) {
  CalibrationParams& calibration = configuration.estimator.calibration;
  calibration.time_offset_sigma_s = std::max(calibration.time_offset_sigma_s, search.sigma_s);
  calibration.readout_sigma_s = std::max(calibration.readout_sigma_s, search.clock.readout_sigma_s);
  return configuration;
}

/// Stages and map know the offset that remains after the stamps have been corrected; the result has the sum of both.
void addClock(const ClockSearch& search, OdometryResult& result) {
  result.clock_offset_s = search.offset_s;
  if (search.offset_s == 0) return;
  result.time_offset_s += search.offset_s;
  result.window_calibration.time_offset_s += search.offset_s;
  result.remarks.emplace_back(
      formatted("clocks of images and IMU: an image with stamp t shows the world at t %+.1f ms; found from their "
                "rotations before the start, corrected",
                1000 * search.offset_s));
}

}  // namespace

OdometryResult runOdometry(Recording& recording, const Configuration& configuration, const RunOptions& options) {
  if (options.threads != 1 && options.threads != 2)
    throw std::invalid_argument("threads is " + std::to_string(options.threads) + ", must be 1 or 2");
  OdometryResult result;
  const auto cancelled = [&] {
    return result.cancelled = result.cancelled || (options.cancelled && options.cancelled());
  };
  Tracking prepared(recording, configuration, result, cancelled);
  const ClockSearch& search = prepared.search();
  TrackingStage& tracking = prepared.stage();
  const Configuration used = withClock(configuration, search);
  const Rig rig = withReadout(recording.rig(), search);
  EstimationStage estimation(rig, used, result);
  RunCheck check(rig, search.offset_s, search.clock.determined ? search.clock.bias_gyro : Eigen::Vector3d::Zero());
  const std::size_t expected_frames = recording.expectedFrames();
  const FrameTaker take = [&](const TrackedFrame& frame) {
    if (cancelled()) return false;
    const WindowUpdate update = estimation.process(frame);
    check.add(frame, update);
    const std::size_t done = result.statistics.frames;
    if (options.progress) options.progress({RunStage::kFrames, done, expected_frames});
    if (options.observer) options.observer(frame.step.frame, frame.tracks, update, done);
    return true;
  };
  options.threads == 1 ? trackOnThisThread(tracking, take) : trackOnItsOwnThread(tracking, take);
  if (result.cancelled) result.error.clear();  // of frames ahead of the last one processed
  const auto progressOf = [&](RunStage stage) {
    return [&, stage](double share) {
      if (options.progress) options.progress({stage, static_cast<std::size_t>(100 * share), 100});
      return share >= 1 || !cancelled();
    };
  };
  estimation.finish({options.threads, progressOf(RunStage::kLoops), progressOf(RunStage::kRefinement),
                     progressOf(RunStage::kDensification)});
  result.statistics.front_end = tracking.statistics();
  result.found_mask = tracking.foundMask();
  addClock(search, result);
  if (const std::string noise = check.noiseRemark(); !noise.empty())
    result.remarks.push_back("noise of the IMU: " + noise);
  if (const std::string readout = readoutRemark(recording.rig(), result.window_calibration); !readout.empty())
    result.remarks.push_back(readout);
  const bool refined = result.refinement.accepted;
  const CalibrationEstimate& last = result.window_calibration;
  const AxesErrors& given = recording.rig().axes;
  for (const std::string& wrong :
       {accelerometerAxesRemark(given, refined ? result.refinement.axes : last.accelerometer_axes),
        gyroscopeAxesRemark(given, refined ? result.refinement.gyro_axes : last.gyroscope_axes)})
    if (!wrong.empty()) result.remarks.push_back(wrong);
  if (const std::string stamps = stampRemark(result.window_calibration); !stamps.empty())
    result.remarks.push_back(stamps);
  if (const std::string vehicle = vehicleRemark(result.statistics.front_end.vehicle_share); !vehicle.empty())
    result.remarks.push_back(vehicle);
  if (const std::string images = imagesRemark(result.statistics.front_end); !images.empty())
    result.remarks.push_back(images);
  result.evidence = check.evidence();
  result.verdict = check.verdict(result.statistics, result.rig, result.refinement);
  result.contradiction = contradictionOf(result);
  return result;
}

}  // namespace lintel
