// SPDX-License-Identifier: BSD-3-Clause
#include "WordIndex.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr std::uint32_t kTables = 8, kBits = 16;

/// Bit `k` of the words of `table`, as a place in the descriptor: odd steps through 256 places reach all of them.
std::uint32_t place(std::uint32_t table, std::uint32_t k) { return (37 * (kBits * table + k) + 11 * table) % 256; }

}  // namespace

WordIndex::WordIndex() : views_(kTables << kBits) {}

std::vector<std::uint32_t> WordIndex::wordsOf(const PlaceView& view) const {
  std::vector<std::uint32_t> words;
  words.reserve(kTables * view.features.size());
  for (const PlaceFeature& feature : view.features)
    for (std::uint32_t table = 0; table < kTables; ++table) {
      std::uint32_t word = table;
      for (std::uint32_t k = 0; k < kBits; ++k) {
        const std::uint32_t at = place(table, k);
        word = word << 1U | static_cast<std::uint32_t>(feature.descriptor[at / 64] >> (at % 64) & 1U);
      }
      words.push_back(word);
    }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

void WordIndex::add(const PlaceView& view) {
  const std::vector<std::uint32_t> words = wordsOf(view);
  for (const std::uint32_t word : words) views_[word].push_back(static_cast<std::uint32_t>(norms_.size()));
  norms_.push_back(std::sqrt(std::max(1.0F, static_cast<float>(words.size()))));
}

std::vector<float> WordIndex::scores(const PlaceView& view, std::size_t end) const {
  std::vector<float> scores(end, 0.0F);
  for (const std::uint32_t word : wordsOf(view)) {
    const std::vector<std::uint32_t>& having = views_[word];
    if (having.size() * 4 > norms_.size() + 16) continue;  // says nothing about the place
    const float idf = std::log(static_cast<float>(norms_.size() + 1) / static_cast<float>(having.size() + 1));
    for (auto v = having.begin(); v != having.end() && *v < end; ++v) scores[*v] += idf;
  }
  for (std::size_t i = 0; i < end; ++i) scores[i] /= norms_[i];
  return scores;
}

}  // namespace lintel
