// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/places/PlaceView.h"

namespace lintel {

/// Which views have descriptors in common, without a vocabulary that has to be learned: each table takes some bits of a
/// descriptor as a word (locality-sensitive hashing, [Indyk1998]); words that few views have count more (tf-idf).
class WordIndex {
 public:
  WordIndex();

  /// Views are numbered in the order in which they are added.
  void add(const PlaceView& view);

  /// How alike `view` is to each of the first `end` views; to be asked when all have been added.
  std::vector<float> scores(const PlaceView& view, std::size_t end) const;

 private:
  std::vector<std::uint32_t> wordsOf(const PlaceView& view) const;

  std::vector<std::vector<std::uint32_t>> views_;  ///< of each word, ascending
  std::vector<float> norms_;                       ///< of each view
};

}  // namespace lintel
