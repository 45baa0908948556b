// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace lintel {

/// The value below which a share `q` of the values lies; 0 without values.
inline double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

/// One line: the name, the median and the range of eight tenths of the values.
inline void printSpread(const char* name, const std::vector<double>& values) {
  std::printf("%-28s %8.3f (%.3f to %.3f)\n", name, quantile(values, 0.5), quantile(values, 0.1),
              quantile(values, 0.9));
}

}  // namespace lintel
