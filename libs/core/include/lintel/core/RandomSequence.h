// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace lintel {

/// Numbers as good as random for drawing samples, the same on every platform: the distributions of the standard library
/// differ between its implementations. A linear congruential generator with Knuth's constants (MMIX).
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : state_(seed) {}

  /// Of 0 to n - 1; n > 0.
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33) % n);
  }

 private:
  std::uint64_t state_;
};

}  // namespace lintel
