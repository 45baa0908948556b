// SPDX-License-Identifier: BSD-3-Clause
#include "PngFilters.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace lintel {

namespace {

enum Filter : std::uint8_t { kNone, kSub, kUp, kAverage, kPaeth };

constexpr std::size_t kLanes = 8;
using Lanes = std::int16_t __attribute__((vector_size(2 * kLanes)));
using Bytes = std::uint8_t __attribute__((vector_size(kLanes)));

Lanes absolute(const Lanes& v) { return v < 0 ? -v : v; }

/// Of left, up and upper left the one nearest to left + up - upper left.
Lanes paeth(const Lanes& left, const Lanes& up, const Lanes& corner) {
  const Lanes to_left = absolute(up - corner), to_up = absolute(left - corner),
              to_corner = absolute(up + left - corner - corner);
  const Lanes nearer = to_up < to_left ? up : left, distance = to_up < to_left ? to_up : to_left;
  return to_corner < distance ? corner : nearer;
}

/// Eight rows of Paeth's filter at a time. A pixel needs its left neighbour, so that a row is one long chain; but the
/// rows below can follow, each one pixel behind. Row i at step t is at pixel t - i, what is above it is what row i - 1
/// had at step t - 1. `steps`: memory for a row of lanes a step.
void paethRows(const std::uint8_t* rows, std::size_t width, const std::uint8_t* above, std::uint8_t* pixels,
               std::vector<std::uint8_t>& steps) {
  steps.assign(kLanes * (width + kLanes), 0);
  for (std::size_t i = 0; i < kLanes; ++i)
    for (std::size_t x = 0; x < width; ++x) steps[kLanes * (x + i) + i] = rows[i * (width + 1) + 1 + x];
  Lanes value{}, up{};
  for (std::size_t t = 0; t + 1 < width + kLanes; ++t) {
    const Lanes corner = up, first{static_cast<std::int16_t>(t < width ? above[t] : 0)};
    up = __builtin_shufflevector(value, first, 8, 0, 1, 2, 3, 4, 5, 6);
    Bytes step;
    std::memcpy(&step, &steps[kLanes * t], kLanes);
    value = (__builtin_convertvector(step, Lanes) + paeth(value, up, corner)) & 255;
    step = __builtin_convertvector(value, Bytes);
    std::memcpy(&steps[kLanes * t], &step, kLanes);
  }
  for (std::size_t i = 0; i < kLanes; ++i)
    for (std::size_t x = 0; x < width; ++x) pixels[i * width + x] = steps[kLanes * (x + i) + i];
}

int paeth(int left, int up, int corner) {
  const int to_left = std::abs(up - corner), to_up = std::abs(left - corner),
            to_corner = std::abs(up + left - 2 * corner);
  if (to_left <= to_up && to_left <= to_corner) return left;
  return to_up <= to_corner ? up : corner;
}

bool oneRow(const std::uint8_t* row, std::size_t width, const std::uint8_t* above, std::uint8_t* pixels) {
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

bool unfilterGray(const std::vector<std::uint8_t>& rows, std::size_t width, std::size_t height,
                  std::vector<std::uint8_t>& pixels) {
  pixels.resize(width * height);
  std::vector<std::uint8_t> nothing(width), steps;
  const std::uint8_t* above = nothing.data();
  const auto isPaeth = [&](std::size_t y) { return rows[y * (width + 1)] == kPaeth; };
  for (std::size_t y = 0; y < height;) {
    std::size_t alike = 0;
    while (alike < kLanes && y + alike < height && isPaeth(y + alike)) ++alike;
    const std::size_t done = alike == kLanes ? kLanes : 1;
    if (done == kLanes)
      paethRows(&rows[y * (width + 1)], width, above, &pixels[y * width], steps);
    else if (!oneRow(&rows[y * (width + 1)], width, above, &pixels[y * width]))
      return false;
    y += done;
    above = &pixels[(y - 1) * width];
  }
  return true;
}

}  // namespace lintel
