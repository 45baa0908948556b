// SPDX-License-Identifier: BSD-3-Clause
#include "FrameTimes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "StampLine.h"
#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr std::size_t kLeastFrames = 30;  // to say how they come
constexpr double kScatter_ns = 5e5;       // less does no harm: half a pixel at 1 rad/s and 1000 px
constexpr double kAboutPeriod = 0.15;     // of the median interval: where the period is looked for
constexpr double kConcentration = 0.5;    // of the stamps' phases; by chance it is less than 0.35
// Mean squared distance from even times, to that of an interval from the period: 1/2 where each stamp scatters by
// itself, 1/4 where early and late ones alternate, more than 2 where the intervals are uneven themselves.
constexpr double kLeastRatio = 0.3, kMostRatio = 0.9;
constexpr double kFollow = 0.1, kFollowPeriod = 0.01;  // of the distance of a stamp from where it was expected
constexpr std::size_t kHeldUp = 5;                     // frames one after the other
constexpr double kLate = 2;                            // standard deviations: a frame that was held up
constexpr int kRounds = 5;                             // in which those are found
constexpr double kStray = 3;                           // times the scatter at first: they are not even any more

/// The period at which the stamps' phases agree best, and how well they do: 1 where all are at its multiples.
struct Period {
  double ns, concentration;
};

double medianInterval_ns(const std::vector<std::int64_t>& stamps) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return static_cast<double>(*middle);
}

Period periodOf(const std::vector<std::int64_t>& stamps) {
  const double usual_ns = medianInterval_ns(stamps);
  const double step = 0.1 * usual_ns / static_cast<double>(stamps.back() - stamps.front());
  Period best{usual_ns, 0};
  for (double rate = 1 - kAboutPeriod; rate <= 1 + kAboutPeriod; rate += step) {
    std::complex<double> sum = 0;
    for (const std::int64_t t_ns : stamps)
      sum += std::polar(1.0, 2 * M_PI * static_cast<double>(t_ns - stamps.front()) * rate / usual_ns);
    const double concentration = std::abs(sum) / static_cast<double>(stamps.size());
    if (concentration > best.concentration) best = {usual_ns / rate, concentration};
  }
  return best;
}

}  // namespace

FrameTimes::FrameTimes(const std::vector<std::int64_t>& first) {
  if (first.size() < kLeastFrames || medianInterval_ns(first) <= 0) return;
  const Period period = periodOf(first);
  if (period.concentration < kConcentration) return;
  period_ns_ = period.ns;
  for (const std::int64_t t_ns : first) push(t_ns);
  StampLine line;
  const auto t_ns = [&](std::size_t i) { return static_cast<double>(stamps_[i].t_ns - first.front()); };
  for (std::size_t i = 0; i < stamps_.size(); ++i) line.add(1, stamps_[i].number, t_ns(i));
  double squares = 0, of_intervals = 0, intervals = 0, before_ns = 0;
  for (std::size_t i = 0; i < stamps_.size(); ++i) {
    const double off_ns = t_ns(i) - line.at(stamps_[i].number), change_ns = off_ns - before_ns;
    squares += off_ns * off_ns;
    if (i > 0 && stamps_[i].number - stamps_[i - 1].number < 1.5) of_intervals += change_ns * change_ns, ++intervals;
    before_ns = off_ns;
  }
  squares /= static_cast<double>(stamps_.size());
  stamps_.clear();
  period_ns_ = line.slope_ns();
  scatter_ns_ = std::sqrt(squares);
  const double ratio = squares * intervals / std::max(1.0, of_intervals);
  if (scatter_ns_ < kScatter_ns || ratio < kLeastRatio || ratio > kMostRatio) return;
  remark_ = formatted("the stamps of images scatter by %.1f ms about even ones", 1e-6 * scatter_ns_);
}

/// Where a frame comes early for the number after the last: those before it were held up, and are moved back if a
/// number before them is free.
bool FrameTimes::moveBack() {
  for (std::size_t i = stamps_.size() - 1; i > 0 && i >= next_ && i + kHeldUp >= stamps_.size(); --i) {
    if (stamps_[i].number - stamps_[i - 1].number < 1.5) continue;
    for (std::size_t j = i; j < stamps_.size(); ++j) --stamps_[j].number;
    return true;
  }
  return false;
}

/// Gives the stamp a number, by the phase and the period of those before.
void FrameTimes::push(std::int64_t t_ns) {
  if (stamps_.empty()) {
    number_ = 0, expected_ns_ = static_cast<double>(t_ns);
    stamps_.push_back({t_ns, number_});
    return;
  }
  double passed = std::round((static_cast<double>(t_ns) - expected_ns_) / period_ns_);
  if (passed < 1) passed = moveBack() ? 0 : 1;
  number_ += passed;
  stamps_.push_back({t_ns, number_});
  const double off_ns = static_cast<double>(t_ns) - expected_ns_ - passed * period_ns_;
  expected_ns_ += passed * period_ns_ + kFollow * off_ns;
  period_ns_ += kFollowPeriod * off_ns;
}

/// Stamps count less the farther they are; those that were held up do not count.
std::int64_t FrameTimes::timeOf(const Stamp& stamp) const {
  StampLine line;
  double limit = std::numeric_limits<double>::infinity(), mean_square = 0;
  for (int round = 0; round < kRounds; ++round) {
    StampLine next;
    double squares = 0, n = 0;
    for (const Stamp& other : stamps_) {
      const double k = other.number - stamp.number, weight = 1 - std::abs(k) / (kReach + 1);
      const auto t_ns = static_cast<double>(other.t_ns - stamp.t_ns);
      const double off_ns = round > 0 ? t_ns - line.at(k) : 0;
      if (weight <= 0 || off_ns * off_ns > limit) continue;
      next.add(weight, k, t_ns);
      squares += off_ns * off_ns, ++n;
    }
    if (n < 2) break;
    line = next, mean_square = squares / n;
    if (round > 0) limit = kLate * kLate * mean_square;
  }
  const bool even = mean_square < kStray * kStray * scatter_ns_ * scatter_ns_;
  return even ? stamp.t_ns + std::llround(line.at(0)) : stamp.t_ns;
}

std::optional<std::int64_t> FrameTimes::pop(bool at_end) {
  if (next_ == stamps_.size() || (!at_end && next_ + kReach >= stamps_.size())) return std::nullopt;
  const std::int64_t t_ns = timeOf(stamps_[next_++]);
  while (next_ > kReach + 1) stamps_.pop_front(), --next_;
  return t_ns;
}

}  // namespace lintel
