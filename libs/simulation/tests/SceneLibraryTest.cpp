// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SceneLibrary.h"

#include <gtest/gtest.h>

#include "lintel/simulation/EurocWriter.h"

namespace lintel {
namespace {

SceneRequest requestOf(const SceneKind& kind) {
  SceneRequest request;
  request.hull = kind.hull;
  const FigureTrajectory trajectory(kind.figure);
  for (double t = 0; t < 60; t += 0.1) request.path.push_back(trajectory.at(t).T_w_b.p);
  return request;
}

/// Share of the lines in the three largest families of parallel ones.
double parallelShare(const Scene& scene) {
  double in_groups = 0;
  for (const int group : directionGroups(scene.lines)) in_groups += group >= 0 && group < 3;
  return in_groups / static_cast<double>(scene.lines.size());
}

TEST(SceneLibrary, EveryFigureFliesInsideItsSceneAndNothingIsInItsWay) {
  for (const SceneKind& kind : sceneKinds()) {
    const SceneRequest request = requestOf(kind);
    const Scene scene = kind.build(request);
    ASSERT_GT(scene.lines.size(), 60u) << kind.name;
    ASSERT_GT(scene.lamps.size(), 0u);
    for (const Eigen::Vector3d& p : request.path) {
      ASSERT_TRUE(request.hull.contains(p)) << kind.name;
    }
    for (const SceneLine& line : scene.lines) {
      ASSERT_GT(line.segment_w.length(), 0) << kind.name;
      for (std::size_t i = 0; i < request.path.size(); i += 5) {
        ASSERT_GE(distanceToSegment(request.path[i], line.segment_w), request.clearance_m - 1e-9)
            << kind.name << line.kind;
      }
    }
  }
}

TEST(SceneLibrary, PatchesHaveAreaAndKnownMaterials) {
  for (const SceneKind& kind : sceneKinds()) {
    const Scene scene = kind.build(requestOf(kind));
    for (const Patch& p : scene.patches) {
      ASSERT_GT(p.edge_u.cross(p.edge_v).norm(), 1e-7) << kind.name;
      ASSERT_LT(static_cast<std::size_t>(p.material), scene.materials.size());
    }
  }
}

TEST(SceneLibrary, ParallelWhereItShouldBeAndNotWhereNot) {
  EXPECT_GT(parallelShare(sceneKind("corridor").build(requestOf(sceneKind("corridor")))), 0.95);
  EXPECT_GT(parallelShare(sceneKind("room").build(requestOf(sceneKind("room")))), 0.7);
  EXPECT_LT(parallelShare(sceneKind("braces").build(requestOf(sceneKind("braces")))), 0.1);
}

TEST(SceneLibrary, SeedsMakeDifferentScenesAndTheSameSeedTheSame) {
  SceneRequest request = requestOf(sceneKind("room"));
  const Scene a = sceneKind("room").build(request), b = sceneKind("room").build(request);
  request.seed = 2;
  const Scene c = sceneKind("room").build(request);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.lines.size(); ++i) ASSERT_EQ(a.lines[i].segment_w.start, b.lines[i].segment_w.start);
  bool different = a.lines.size() != c.lines.size();
  for (std::size_t i = 0; !different && i < a.lines.size(); ++i)
    different = a.lines[i].segment_w.start != c.lines[i].segment_w.start;
  EXPECT_TRUE(different);
}

TEST(SceneLibrary, AnUnknownNameIsRefusedWithThoseThatThereAre) {
  try {
    sceneKind("cellar");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("corridor"), std::string::npos);
  }
}

}  // namespace
}  // namespace lintel
