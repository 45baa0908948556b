// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackNoise.h"

#include <cmath>
#include <cstddef>

#include "lintel/core/ForAvx2.h"

namespace lintel {

std::vector<NoiseKind> kindsAbout(const NoiseKind& typical) {
  if (typical.walk == 0) return {typical};
  constexpr double kRatio = 4;
  return {{typical.white, typical.walk / kRatio}, typical, {typical.white, typical.walk * kRatio}};
}

Whitener::Whitener(const NoiseKind& kind, const std::vector<double>& t_s) {
  const double white = kind.white * kind.white, walk = kind.walk * kind.walk;
  double variance = 0;  // of the walk's value as known before an observation
  observations_.reserve(t_s.size());
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (i > 0) variance += walk * (t_s[i] - t_s[i - 1]);
    const double sigma = std::sqrt(variance + white), gain = variance / sigma;
    observations_.push_back({1 / sigma, gain});
    variance -= gain * gain;
    log_det_ += std::log(sigma);
  }
}

namespace {

struct Rows {
  double* m;
  const Whitener::Observation* observations;
  std::ptrdiff_t count, columns;
};

/// The filter on N columns from `first` on. `state`: the walk's value, as known so far.
template <int N>
[[gnu::always_inline]] inline void filterColumns(const Rows& rows, std::ptrdiff_t first) {
  double state[N] = {};
  for (std::ptrdiff_t i = 0; i < rows.count; ++i) {
    double* row = rows.m + i * rows.columns + first;
    const auto [scale, gain] = rows.observations[i];
    for (int k = 0; k < N; ++k) {
      row[k] = (row[k] - state[k]) * scale;
      state[k] += gain * row[k];
    }
  }
}

/// The same, transposed: from the last row to the first.
template <int N>
[[gnu::always_inline]] inline void filterColumnsBack(const Rows& rows, std::ptrdiff_t first) {
  double state[N] = {};
  for (std::ptrdiff_t i = rows.count - 1; i >= 0; --i) {
    double* row = rows.m + i * rows.columns + first;
    const auto [scale, gain] = rows.observations[i];
    for (int k = 0; k < N; ++k) {
      row[k] = (row[k] + gain * state[k]) * scale;
      state[k] -= row[k];
    }
  }
}

LINTEL_FOR_AVX2_TOO void filter(Rows rows) {
  std::ptrdiff_t first = 0;
  for (; first + 8 <= rows.columns; first += 8) filterColumns<8>(rows, first);
  for (; first + 2 <= rows.columns; first += 2) filterColumns<2>(rows, first);
  if (first < rows.columns) filterColumns<1>(rows, first);
}

LINTEL_FOR_AVX2_TOO void filterBack(Rows rows) {
  std::ptrdiff_t first = 0;
  for (; first + 8 <= rows.columns; first += 8) filterColumnsBack<8>(rows, first);
  for (; first + 2 <= rows.columns; first += 2) filterColumnsBack<2>(rows, first);
  if (first < rows.columns) filterColumnsBack<1>(rows, first);
}

}  // namespace

void Whitener::whiten(double* m, int columns) const {
  filter({m, observations_.data(), static_cast<std::ptrdiff_t>(size()), columns});
}

void Whitener::whitenTransposed(double* m, int columns) const {
  filterBack({m, observations_.data(), static_cast<std::ptrdiff_t>(size()), columns});
}

void Whitener::information(const double* weights, std::vector<double>& result) const {
  const std::size_t n = size();
  result.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) result[i * n + i] = 1;
  whiten(result.data(), static_cast<int>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) result[i * n + j] *= weights[i];
  whitenTransposed(result.data(), static_cast<int>(n));
}

}  // namespace lintel
