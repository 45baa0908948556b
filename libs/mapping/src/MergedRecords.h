// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lintel/mapping/CommonKeyframes.h"

namespace lintel {

/// Keeps track of which landmarks have become one: a landmark that was joined refers to the one that stays.
class MergedRecords {
 public:
  explicit MergedRecords(std::size_t size) : roots_(size), grown_(size, 0) {
    std::iota(roots_.begin(), roots_.end(), std::size_t{0});
  }

  /// The landmark that `i` is part of by now.
  std::size_t rootOf(std::size_t i) const {
    while (roots_[i] != i) i = roots_[i];
    return i;
  }

  /// Both are roots.
  void join(std::size_t stays, std::size_t goes) {
    roots_[goes] = stays;
    ++grown_[stays];
  }

  /// How many others are part of a root.
  std::size_t grown(std::size_t root) const { return grown_[root]; }

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
  std::vector<std::size_t> grown_;
};

/// What was found out about two roots, for as long as neither grows: with hundreds of visits of a place two landmarks
/// are candidates hundreds of times.
class PairAnswers {
 public:
  explicit PairAnswers(const MergedRecords& records) : records_(records) {}

  std::optional<bool> of(std::size_t a, std::size_t b) const {
    const auto found = answers_.find({a, b});
    if (found == answers_.end() || found->second.grown != grown(a, b)) return std::nullopt;
    return found->second.yes;
  }
  bool isYes(std::size_t a, std::size_t b) const { return of(a, b).value_or(false); }
  void set(std::size_t a, std::size_t b, bool yes) { answers_[{a, b}] = {grown(a, b), yes}; }
  void clear() { answers_.clear(); }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  struct Hash {
    std::size_t operator()(const Pair& p) const { return p.first * 0x9E3779B97F4A7C15ULL ^ p.second; }
  };
  struct Answer {
    Pair grown;
    bool yes = false;
  };
  Pair grown(std::size_t a, std::size_t b) const { return {records_.grown(a), records_.grown(b)}; }

  const MergedRecords& records_;
  std::unordered_map<Pair, Answer, Hash> answers_;
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
