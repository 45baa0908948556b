// SPDX-License-Identifier: BSD-3-Clause
#include "RangeEnds.h"

#include <algorithm>
#include <cmath>

#include "ImuBatcher.h"
#include "ImuValue.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/UnmeasuredMotion.h"

namespace lintel {

namespace {

// The smallest ranges of IMUs are 125 degrees/s (2.2 rad/s) and 2 g: an axis may be scaled by a calibration.
constexpr double kSmallestGyroRange = 1.7, kSmallestAccelRange = 15;  // [rad/s], [m/s^2]
constexpr int kEndCount = 4, kEndRuns = 2, kEndRow = 10;              // samples at an end, in several runs, or in a row
constexpr double kBelow = 8.5, kPerBelow = 2;      // steps below an end; what has its value is so many times as often
constexpr std::int64_t kLongest_ns = 250'000'000;  // of a run that is replaced
constexpr std::size_t kBeside = 2;                 // samples to each side that the cubic takes

}  // namespace

std::array<RangeEnds::End, 12> RangeEnds::everyEnd() {
  std::array<End, 12> ends;
  for (int i = 0; i < 12; ++i)
    ends[static_cast<std::size_t>(i)].axis = i / 2, ends[static_cast<std::size_t>(i)].sign = i % 2 == 0 ? 1 : -1;
  return ends;
}

std::array<double, 6> RangeEnds::everyStep() {
  std::array<double, 6> steps;
  steps.fill(std::numeric_limits<double>::infinity());
  return steps;
}

/// Those little smaller than a former end count as little smaller than the present one when that is as near.
void RangeEnds::count(const ImuSample& sample, End& end) const {
  const double value = end.sign * imuValue(sample, end.axis), near = kBelow * step_[static_cast<std::size_t>(end.axis)];
  if (value > end.value) {
    end.below = value - end.value <= near ? end.below + end.count : 0;
    end.value = value, end.count = end.runs = end.row = 1, end.known = end.said = false;
  } else if (value == end.value) {
    const bool again = end.sign * imuValue(samples_.back(), end.axis) == value;
    ++end.count;
    end.row = again ? end.row + 1 : 1, end.runs += again ? 0 : 1;
  } else if (end.value - value <= near) {
    ++end.below;
  }
  const bool often = (end.count >= kEndCount && end.runs >= kEndRuns) || end.row >= kEndRow;
  end.known |= often && canEnd(end) && end.count > kPerBelow * end.below;
}

void RangeEnds::push(const ImuSample& sample) {
  if (!samples_.empty()) {
    for (int axis = 0; axis < 6; ++axis) {
      const double by = std::abs(imuValue(sample, axis) - imuValue(samples_.back(), axis));
      double& step = step_[static_cast<std::size_t>(axis)];
      if (by > 0) step = std::min(step, by);
    }
    for (End& end : ends_) count(sample, end);
  }
  samples_.push_back(sample);
}

bool RangeEnds::canEnd(const End& end) {
  return end.value >= (end.axis < 3 ? kSmallestGyroRange : kSmallestAccelRange);
}

bool RangeEnds::isAt(const End& end, std::size_t i) const {
  return end.sign * imuValue(samples_[i], end.axis) == end.value;
}

std::optional<RangeEnds::Run> RangeEnds::runAt(const End& end, std::size_t i) const {
  if (!canEnd(end) || !isAt(end, i)) return std::nullopt;
  Run run{i, i};
  while (run.first > 0 && goesOn(run.first - 1) && isAt(end, run.first - 1)) --run.first;
  while (run.last + 1 < samples_.size() && goesOn(run.last) && isAt(end, run.last + 1)) ++run.last;
  return run;
}

/// Whether the next sample follows without a drop-out.
bool RangeEnds::goesOn(std::size_t i) const {
  return samples_[i + 1].t_ns - samples_[i].t_ns <= ImuBatcher::kMaxGap_ns;
}

bool RangeEnds::isComplete(const Run& run) const {
  const std::size_t known = samples_.size() - 1 - run.last;
  return known >= kBeside || (known > 0 && !goesOn(run.last)) ||
         samples_[run.last].t_ns - samples_[run.first].t_ns > kLongest_ns;
}

/// Whether it is short, and what a cubic takes is there to both sides.
bool RangeEnds::isSurrounded(const Run& run) const {
  if (run.first < kBeside || run.last + kBeside >= samples_.size()) return false;
  if (samples_[run.last].t_ns - samples_[run.first].t_ns > kLongest_ns) return false;
  for (std::size_t k = 0; k < kBeside; ++k)
    if (!goesOn(run.first - 1 - k) || !goesOn(run.last + k)) return false;
  return true;
}

double RangeEnds::slope(const End& end, std::size_t from, std::size_t to) const {
  const double dt = 1e-9 * static_cast<double>(samples_[to].t_ns - samples_[from].t_ns);
  return end.sign * (imuValue(samples_[to], end.axis) - imuValue(samples_[from], end.axis)) / dt;
}

/// The cubic has the values and slopes of both sides. Its standard deviation is how far it goes beyond the end, or half
/// of the step to the end where that is more: a single sample's slopes show nothing.
void RangeEnds::extend(const End& end, const Run& run, ImuSample& sample) const {
  float& open = end.axis < 3 ? sample.gyro_open : sample.accel_open;
  if (!isSurrounded(run)) {
    open = static_cast<float>(std::max<double>(open, end.axis < 3 ? kUnmeasuredGyro : kUnmeasuredAccel));
    return;
  }
  const std::size_t before = run.first - 1, after = run.last + 1;
  const double span_s = 1e-9 * static_cast<double>(samples_[after].t_ns - samples_[before].t_ns);
  const double rise = std::max(0.0, slope(end, before - 1, before)) * span_s;
  const double fall = std::min(0.0, slope(end, after, after + 1)) * span_s;
  const double from = end.sign * imuValue(samples_[before], end.axis),
               to = end.sign * imuValue(samples_[after], end.axis);
  const auto cubic = [&](std::int64_t t_ns) {
    const double u = 1e-9 * static_cast<double>(t_ns - samples_[before].t_ns) / span_s, w = 1 - u;
    return w * w * ((1 + 2 * u) * from + u * rise) + u * u * ((1 + 2 * w) * to - w * fall);
  };
  double most = 0.5 * (end.value - std::min(from, to));
  for (std::size_t i = run.first; i <= run.last; ++i) most = std::max(most, cubic(samples_[i].t_ns) - end.value);
  imuValue(sample, end.axis) = end.sign * std::max(end.value, cubic(sample.t_ns));
  open = std::max(open, static_cast<float>(most * std::sqrt(span_s)));
}

std::optional<ImuSample> RangeEnds::pop(bool at_end, std::string& remark) {
  if (next_ == samples_.size()) return std::nullopt;
  ImuSample sample = samples_[next_];
  remark.clear();
  for (const End& end : ends_)
    if (const std::optional<Run> run = runAt(end, next_); run && !at_end && !isComplete(*run)) return std::nullopt;
  for (End& end : ends_) {
    const std::optional<Run> run = runAt(end, next_);
    if (!run || !end.known) continue;
    extend(end, *run, sample);
    if (end.said) continue;
    end.said = true;
    remark += formatted("%s%s along its %c axis end at %.3g %s", remark.empty() ? "" : "; ",
                        end.axis < 3 ? "the gyroscope's rates" : "the accelerometer's values", "xyz"[end.axis % 3],
                        end.sign * end.value, end.axis < 3 ? "rad/s" : "m/s^2");
  }
  ++next_;
  while (next_ > kBeside && samples_[next_ - kBeside].t_ns - samples_.front().t_ns > 2 * kLongest_ns)
    samples_.pop_front(), --next_;
  return sample;
}

}  // namespace lintel
