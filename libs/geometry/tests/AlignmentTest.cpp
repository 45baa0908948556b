// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Alignment.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

const Points kCorner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

double cost(const Similarity& S, const Points& from, const Points& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (S * from[i] - to[i]).squaredNorm();
  return sum;
}

/// A crooked path and a copy of it, moved by `S` and disturbed by centimetres.
std::pair<Points, Points> disturbed(const Similarity& S) {
  std::pair<Points, Points> sets;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.2 * i;
    sets.first.push_back({std::cos(t), 2 * std::sin(0.7 * t), 0.3 * t});
    sets.second.push_back(S * sets.first.back() +
                          0.05 * Vector3d(std::sin(91 * t), std::cos(57 * t), std::sin(33 * t)));
  }
  return sets;
}

TEST(Alignment, Sim3ByHand) {
  // twice as large, a quarter turn about z, moved by (1, 2, 3)
  const Similarity S = alignPositions(AlignmentKind::kSim3, kCorner, {{1, 2, 3}, {1, 4, 3}, {-1, 2, 3}, {1, 2, 5}});
  EXPECT_NEAR(S.scale, 2, 1e-14);
  EXPECT_TRUE(logRotation(S.T_a_b.q).isApprox(Vector3d(0, 0, M_PI / 2), 1e-14));
  EXPECT_TRUE(S.T_a_b.p.isApprox(Vector3d(1, 2, 3), 1e-14));
}

TEST(Alignment, Se3KeepsTheScale) {
  Points doubled;
  for (const Vector3d& p : kCorner) doubled.push_back(2 * p);
  const Similarity S = alignPositions(AlignmentKind::kSe3, kCorner, doubled);
  EXPECT_EQ(S.scale, 1);
  EXPECT_LE(logRotation(S.T_a_b.q).norm(), 1e-14);
  EXPECT_TRUE(S.T_a_b.p.isApprox(Vector3d::Constant(0.25), 1e-14));  // mean onto mean: 0.5 - 0.25
}

TEST(Alignment, MirrorImagesAreNotTurnedInsideOut) {
  Points mirrored;
  for (const Vector3d& p : kCorner) mirrored.push_back({p.x(), p.y(), -p.z()});
  EXPECT_NEAR(alignPositions(AlignmentKind::kSe3, kCorner, mirrored).T_a_b.R().determinant(), 1, 1e-14);
}

TEST(Alignment, YawDoesNotChangeTilt) {
  Similarity tilted;
  tilted.T_a_b = {expRotation({0, 0, 1.2}) * expRotation({0.1, 0, 0}), {4, 5, 6}};
  const auto [from, to] = disturbed(tilted);
  const Similarity S = alignPositions(AlignmentKind::kYaw, from, to);
  const Vector3d phi = logRotation(S.T_a_b.q);
  EXPECT_EQ(phi.head<2>().norm(), 0);
  EXPECT_NEAR(phi.z(), 1.2, 0.05);
  EXPECT_GT(cost(S, from, to), cost(alignPositions(AlignmentKind::kSe3, from, to), from, to));
}

TEST(Alignment, NoneIsTheIdentity) {
  const Similarity S = alignPositions(AlignmentKind::kNone, kCorner, {{9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}});
  EXPECT_EQ(S * Vector3d(1, 2, 3), Vector3d(1, 2, 3));
}

TEST(Alignment, NoSmallStepImprovesOnIt) {
  Similarity moved;
  moved.scale = 1.7;
  moved.T_a_b = {expRotation({0.4, -2, 1}), {-3, 2, 8}};
  const auto [from, to] = disturbed(moved);
  for (const AlignmentKind kind : {AlignmentKind::kSe3, AlignmentKind::kSim3, AlignmentKind::kYaw}) {
    const Similarity best = alignPositions(kind, from, to);
    for (const double step : {-1e-4, 1e-4})
      for (int k = 0; k < 3; ++k) {
        Similarity turned = best, shifted = best, scaled = best;
        const Vector3d axis = Vector3d::Unit(kind == AlignmentKind::kYaw ? 2 : k);
        turned.T_a_b.q = expRotation(step * axis) * best.T_a_b.q;
        shifted.T_a_b.p += step * Vector3d::Unit(k);
        scaled.scale *= 1 + step;
        EXPECT_GT(cost(turned, from, to), cost(best, from, to));
        EXPECT_GT(cost(shifted, from, to), cost(best, from, to));
        if (kind == AlignmentKind::kSim3) {
          EXPECT_GT(cost(scaled, from, to), cost(best, from, to));
        }
      }
  }
}

TEST(Alignment, StraightAndStandingPathsAlignAsFarAsTheyCan) {
  const Points line = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, upright = {{0, 0, 1}, {0, 0, 2}, {0, 0, 4}};
  EXPECT_LE(cost(alignPositions(AlignmentKind::kSim3, line, upright), line, upright), 1e-24);
  const Points standing(3, Vector3d(1, 2, 3));
  const Similarity S = alignPositions(AlignmentKind::kSim3, standing, upright);
  EXPECT_EQ(S.scale, 1);
  EXPECT_TRUE((S * standing.front()).isApprox(Vector3d(0, 0, 7.0 / 3), 1e-14));
  const Similarity shrunk = alignPositions(AlignmentKind::kSim3, upright, standing);
  EXPECT_NEAR(shrunk.scale, 0, 1e-5);
  EXPECT_TRUE((shrunk * upright.front()).isApprox(standing.front(), 1e-4));
}

TEST(Alignment, RefusesUnequalOrEmptySets) {
  EXPECT_THROW(alignPositions(AlignmentKind::kSe3, kCorner, {{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(alignPositions(AlignmentKind::kNone, {}, {}), std::invalid_argument);
}

TEST(Alignment, NamesThereAndBack) {
  for (const char* name : {"none", "se3", "yaw", "sim3"}) EXPECT_EQ(nameOf(alignmentKindOf(name)), name);
  EXPECT_THROW(alignmentKindOf("affine"), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
