// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "lintel/mapping/CommonKeyframes.h"

namespace lintel {

/// Keeps track of which landmarks have become one: a landmark that was joined refers to the one that stays.
class MergedRecords {
 public:
  explicit MergedRecords(std::size_t size) : roots_(size) { std::iota(roots_.begin(), roots_.end(), std::size_t{0}); }

  /// The landmark that `i` is part of by now.
  std::size_t rootOf(std::size_t i) const {
    while (roots_[i] != i) i = roots_[i];
    return i;
  }

  /// Both are roots.
  void join(std::size_t stays, std::size_t goes) { roots_[goes] = stays; }

  /// Removes the joined ones from `records`.
  template <class Record>
  void compact(std::vector<Record>& records) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (roots_[i] != i) continue;
      if (kept != i) records[kept] = std::move(records[i]);
      ++kept;
    }
    records.resize(kept);
  }

 private:
  std::vector<std::size_t> roots_;
};

/// The views of both, ascending by keyframe.
template <class View>
std::vector<View> mergedViews(const std::vector<View>& a, const std::vector<View>& b) {
  std::vector<View> all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all),
             [](const View& x, const View& y) { return x.keyframe < y.keyframe; });
  return all;
}

/// Whether some keyframe saw both landmarks.
template <class Record>
bool shareKeyframe(const Record& a, const Record& b) {
  using View = typename decltype(Record::views)::value_type;
  return anyInCommonKeyframes(a.views, b.views, &View::keyframe, [](const View&, const View&) { return true; });
}

}  // namespace lintel
