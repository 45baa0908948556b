// SPDX-License-Identifier: BSD-3-Clause
#include "solver/SightingRows.h"

#include "lintel/core/ForAvx2.h"

namespace lintel {

namespace {

constexpr int N = kSightingColumns;

constexpr int kLane = 4;  // columns at a time

/// all += a' b on and above the diagonal, and up to three columns below it.
[[gnu::always_inline]] inline void addSquare(const double* a, const double* b, double* __restrict all) {
  for (int r = 0; r < kResidualColumn; ++r)
    for (int c = r / kLane * kLane; c < N; ++c) all[r * N + c] += a[r] * b[c] + a[N + r] * b[N + c];
}

/// out = J' b.
[[gnu::always_inline]] inline void multiply(const double* J, const double* b, double* __restrict out) {
  for (int r = 0; r < kCameraTangent; ++r)
    for (int c = 0; c < N; ++c) out[r * N + c] = J[r] * b[c] + J[kCameraTangent + r] * b[N + c];
}

LINTEL_FOR_AVX2_TOO void multiplyAll(const double* A, const double* J, const double* B, std::ptrdiff_t count,
                                     double* all, double* by_camera) {
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    addSquare(A + i * 2 * N, B + i * 2 * N, all);
    multiply(J + i * 2 * kCameraTangent, B + i * 2 * N, by_camera + i * kCameraTangent * N);
  }
}

}  // namespace

void multiplySightings(const std::vector<SightingRows>& A, const std::vector<CameraRows>& J,
                       const std::vector<SightingRows>& B, SightingProducts& products) {
  products.all.setZero();
  products.by_camera.resize(A.size());
  if (A.empty()) return;
  multiplyAll(A.front().data(), J.front().data(), B.front().data(), static_cast<std::ptrdiff_t>(A.size()),
              products.all.data(), products.by_camera.front().data());
}

}  // namespace lintel
