// SPDX-License-Identifier: BSD-3-Clause
#include "PngFilters.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "lintel/core/ForAvx2.h"

namespace lintel {

namespace {

enum Filter : std::uint8_t { kNone, kSub, kUp, kAverage, kPaeth };

constexpr std::size_t kLanes = 16;  // rows at once; rows and columns that are transposed at once
// vectors as arguments: the functions are inlined, no other program calls them
#pragma GCC diagnostic ignored "-Wpsabi"
using Lanes = std::int16_t __attribute__((vector_size(2 * kLanes)));
using Bytes = std::uint8_t __attribute__((vector_size(kLanes)));

[[gnu::always_inline]] inline Lanes absolute(const Lanes& v) { return v < 0 ? -v : v; }

/// Of left, up and upper left the one nearest to left + up - upper left.
[[gnu::always_inline]] inline Lanes nearest(const Lanes& left, const Lanes& up, const Lanes& corner) {
  const Lanes to_left = absolute(up - corner), to_up = absolute(left - corner),
              to_corner = absolute(up + left - corner - corner);
  const Lanes nearer = to_up < to_left ? up : left, distance = to_up < to_left ? to_up : to_left;
  return to_corner < distance ? corner : nearer;
}

/// Sixteen rows of sixteen bytes become sixteen columns: four times the first half is interleaved with the second.
void transpose(const std::uint8_t* from, std::size_t from_step, std::uint8_t* to, std::size_t to_step) {
  Bytes rows[kLanes], mixed[kLanes];
#pragma GCC unroll 16
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(&rows[i], from + i * from_step, kLanes);
#pragma GCC unroll 4
  for (int pass = 0; pass < 4; ++pass) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kLanes / 2; ++i) {
      const Bytes a = rows[i], b = rows[i + kLanes / 2];
      mixed[2 * i] = __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
      mixed[2 * i + 1] = __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    }
#pragma GCC unroll 16
    for (std::size_t i = 0; i < kLanes; ++i) rows[i] = mixed[i];
  }
#pragma GCC unroll 16
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(to + i * to_step, &rows[i], kLanes);
}

/// What each row's filter says of a pixel, from its neighbours: all ones in the lanes of the rows that have the filter.
struct Guess {
  Lanes sub{}, up{}, average{}, paeth{};

  [[gnu::always_inline]] Lanes of(const Lanes& left, const Lanes& above, const Lanes& corner) const {
    return (left & sub) | (above & up) | (((left + above) >> 1) & average) | (nearest(left, above, corner) & paeth);
  }
};

/// Runs through the steps: to each row's byte its guess is added. Compiled twice; the program takes what the processor
/// can do when it starts.
LINTEL_FOR_AVX2_TOO void follow(const Guess& guess, const std::uint8_t* above, std::size_t width, std::uint8_t* steps) {
  Lanes value{}, up{};
  for (std::size_t t = 0; t + 1 < width + kLanes; ++t, steps += kLanes) {
    const Lanes corner = up, first{static_cast<std::int16_t>(t < width ? above[t] : 0)};
    up = __builtin_shufflevector(value, first, 16, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14);
    Bytes step;
    std::memcpy(&step, steps, kLanes);
    value = (__builtin_convertvector(step, Lanes) + guess.of(value, up, corner)) & 255;
    step = __builtin_convertvector(value, Bytes);
    std::memcpy(steps, &step, kLanes);
  }
}

/// Sixteen rows at a time. A pixel needs its left neighbour, so that a row is one long chain; but the rows below can
/// follow, each one pixel behind. Row i at step t is at pixel t - i, what is above it is what row i - 1 had at step
/// t - 1. `steps`: memory for a row of lanes a step. False where a row names none of the filters.
bool sixteenRows(const std::uint8_t* rows, std::size_t width, const std::uint8_t* above, std::uint8_t* pixels,
                 std::vector<std::uint8_t>& steps) {
  Guess guess;
  Lanes* const masks[] = {nullptr, &guess.sub, &guess.up, &guess.average, &guess.paeth};
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::uint8_t filter = rows[i * (width + 1)];
    if (filter > kPaeth) return false;
    if (filter != kNone) (*masks[filter])[i] = -1;
  }
  steps.resize(kLanes * (width + kLanes));
  std::fill_n(steps.begin(), kLanes * kLanes, std::uint8_t{0});  // before a row begins its pixels count as 0
  // steps at which every row is within its pixels, in blocks; the others one by one
  const std::size_t begin = kLanes - 1, end = begin + (std::max(width, begin) - begin) / kLanes * kLanes;
  const auto forOthers = [&](const auto& visit) {
    for (std::size_t i = 0; i < kLanes; ++i)
      for (std::size_t t = i; t < i + width; ++t)
        if (t < begin || t >= end)
          visit(steps[kLanes * t + i], i, t - i);
        else
          t = end - 1;
  };
  for (std::size_t t = begin; t < end; t += kLanes) transpose(rows + 1 + t, width, &steps[kLanes * t], kLanes);
  forOthers([&](std::uint8_t& lane, std::size_t i, std::size_t x) { lane = rows[i * (width + 1) + 1 + x]; });
  follow(guess, above, width, steps.data());
  for (std::size_t t = begin; t < end; t += kLanes) transpose(&steps[kLanes * t], kLanes, pixels + t, width - 1);
  forOthers([&](const std::uint8_t& lane, std::size_t i, std::size_t x) { pixels[i * width + x] = lane; });
  return true;
}

int paeth(int left, int up, int corner) {
  const int to_left = std::abs(up - corner), to_up = std::abs(left - corner),
            to_corner = std::abs(up + left - 2 * corner);
  if (to_left <= to_up && to_left <= to_corner) return left;
  return to_up <= to_corner ? up : corner;
}

bool oneRow(const std::uint8_t* row, std::size_t width, const std::uint8_t* above, std::uint8_t* pixels,
            std::vector<std::uint8_t>&) {
  const std::uint8_t filter = *row++;
  if (filter > kPaeth) return false;
  int left = 0, corner = 0;
  for (std::size_t x = 0; x < width; ++x) {
    const int up = above[x];
    int guess = 0;
    if (filter == kSub) guess = left;
    if (filter == kUp) guess = up;
    if (filter == kAverage) guess = (left + up) / 2;
    if (filter == kPaeth) guess = paeth(left, up, corner);
    pixels[x] = static_cast<std::uint8_t>(row[x] + guess);
    left = pixels[x];
    corner = up;
  }
  return true;
}

}  // namespace

bool unfilterGray(const std::uint8_t* rows, std::size_t width, std::size_t height, std::vector<std::uint8_t>& pixels) {
  pixels.resize(width * height);
  std::vector<std::uint8_t> nothing(width), steps;
  const std::uint8_t* above = nothing.data();
  for (std::size_t y = 0; y < height;) {
    const auto unfilter = y + kLanes <= height ? sixteenRows : oneRow;
    if (!unfilter(rows + y * (width + 1), width, above, &pixels[y * width], steps)) return false;
    y += y + kLanes <= height ? kLanes : 1;
    above = &pixels[(y - 1) * width];
  }
  return true;
}

}  // namespace lintel
