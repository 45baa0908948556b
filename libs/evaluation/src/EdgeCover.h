// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// How much of the true edges a map covers, and how often.
class EdgeCover {
 public:
  /// `segment`: where `line` lies in the world of the edges. The line must outlive this.
  void add(std::size_t edge_index, const MapLine& line, const Segment3& segment, const Segment3& edge);

  /// Sum of the covered stretches' lengths over the length of their union; NaN without any.
  double duplicates() const;

  /// The same, but a line that images show side by side with all the others there does not count: parallel lines close
  /// together are no duplicates.
  double trueDuplicates() const;

 private:
  struct Stretch {
    double from_m, to_m;
    const MapLine* line;
  };
  template <class CountsAgain>
  double times(const CountsAgain& countsAgain) const;

  std::map<std::size_t, std::vector<Stretch>> stretches_;
};

}  // namespace lintel
