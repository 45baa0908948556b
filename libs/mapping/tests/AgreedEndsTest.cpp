// SPDX-License-Identifier: BSD-3-Clause
#include "AgreedEnds.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

using Stretch = std::pair<double, double>;

constexpr double kShare = 0.2;

/// `n` views that saw the line from 0 on and end within 2 px of `to`.
std::vector<SeenPiece> viewsTo(double to, int n, double m_per_px = 0.01) {
  std::vector<SeenPiece> pieces;
  for (int k = 0; k < n; ++k) pieces.push_back({0, to + (k % 3 - 1) * m_per_px, true, false, m_per_px, m_per_px});
  return pieces;
}

std::vector<SeenPiece> operator+(std::vector<SeenPiece> a, const std::vector<SeenPiece>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(AgreedEnds, WhatCoarserViewsSawBeyondTheAgreedEndIsCutOff) {
  const Stretch cut = withinAgreedEnds(viewsTo(2, 30) + viewsTo(2.6, 3, 0.02), kShare, {0, 2.6});
  EXPECT_DOUBLE_EQ(cut.first, 0);
  EXPECT_DOUBLE_EQ(cut.second, 2.01) << "the last of those that agree";
}

TEST(AgreedEnds, OfTheOtherEndTheSame) {
  std::vector<SeenPiece> mirrored;
  for (const SeenPiece& p : viewsTo(2, 30) + viewsTo(2.6, 3, 0.02))
    mirrored.push_back({-p.to, -p.from, p.to_open, p.from_open, p.to_m_per_px, p.from_m_per_px});
  EXPECT_DOUBLE_EQ(withinAgreedEnds(mirrored, kShare, {-2.6, 0}).first, -2.01);
}

TEST(AgreedEnds, WhatFinerViewsSawStays) {
  const std::vector<SeenPiece> pieces = viewsTo(2, 30) + viewsTo(2.6, 3, 0.005);
  EXPECT_EQ(withinAgreedEnds(pieces, kShare, {0, 2.6}), Stretch(0, 2.6)) << "a view from near by sees the fainter edge";
}

TEST(AgreedEnds, WhatManySawStays) {
  const std::vector<SeenPiece> pieces = viewsTo(2, 30) + viewsTo(2.6, 10, 0.02);
  EXPECT_EQ(withinAgreedEnds(pieces, kShare, {0, 2.6}), Stretch(0, 2.6)) << "a quarter goes on";
}

TEST(AgreedEnds, EndsThatScatterAreWhereTheTrackerStopped) {
  std::vector<SeenPiece> pieces = viewsTo(2, 4) + viewsTo(2.6, 3, 0.02);
  for (int k = 0; k < 26; ++k) pieces.push_back({0, 1 + 0.03 * k, true, false, 0.01, 0.01});
  EXPECT_EQ(withinAgreedEnds(pieces, kShare, {0, 2.6}), Stretch(0, 2.6));
}

TEST(AgreedEnds, EndsAtTheImagesBorderDoNotCount) {
  std::vector<SeenPiece> pieces = viewsTo(2, 30);
  for (SeenPiece& piece : pieces) piece.to_open = true;
  EXPECT_EQ(withinAgreedEnds(pieces + viewsTo(2.6, 3, 0.02), kShare, {0, 2.6}), Stretch(0, 2.6));
}

TEST(AgreedEnds, APieceBehindAGapIsNotPastTheEnd) {
  std::vector<SeenPiece> pieces = viewsTo(2, 30);
  pieces.insert(pieces.end(), {{3, 4, false, false, 0.02, 0.02}, {3, 4, false, false, 0.02, 0.02}});
  EXPECT_EQ(withinAgreedEnds(pieces, kShare, {0, 4}), Stretch(0, 4));
}

TEST(AgreedEnds, FewViewsAgreeByChance) {
  const auto cut = [](int agree) {
    std::vector<SeenPiece> pieces = viewsTo(2.6, 2, 0.02);
    for (SeenPiece& piece : pieces) piece.to_open = true;
    return withinAgreedEnds(pieces + viewsTo(2, agree), 0.9, {0, 2.6});
  };
  EXPECT_EQ(cut(2), Stretch(0, 2.6));
  EXPECT_EQ(cut(3), Stretch(0, 2.01));
  EXPECT_EQ(withinAgreedEnds({}, kShare, {0, 1}), Stretch(0, 1));
}

}  // namespace
}  // namespace lintel
