// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lintel {

/// Mixes 64 bits (SplitMix64 finaliser): a good hash of counters and coordinates.
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// A stream of random numbers, the same on every machine: the standard library's engines are specified but its
/// distributions are not. Streams of one seed with different names are independent.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t name = 0) : state_(mixBits(mixBits(seed) ^ mixBits(~name))) {}

  std::uint64_t bits() { return mixBits(state_++); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, count), count > 0.
  int index(int count) { return static_cast<int>(uniform() * count); }
  /// Standard normal.
  double gaussian();
  Eigen::Vector3d gaussian3(double sigma);
  /// Uniform on the unit sphere.
  Eigen::Vector3d direction();

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace lintel
