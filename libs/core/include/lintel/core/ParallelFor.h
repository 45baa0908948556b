// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace lintel {

/// Calls `work(i)` once for every i in [0, count), in this order, from `threads` threads, the calling one among them,
/// and `done(n)` after each with the number done, never two at a time. The first exception stops the rest and is thrown
/// again.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                 const std::function<void(std::size_t)>& done = {});

}  // namespace lintel
