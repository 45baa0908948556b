// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include "Files.h"
#include "SampleMap.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

class SimplemapExport : public FolderTest {
 protected:
  mrpt::maps::CSimpleMap reread(const LineMap& map, const ExportParams& params = {}) const {
    exportMap(map, in("map.simplemap"), params);
    mrpt::maps::CSimpleMap read;
    EXPECT_TRUE(read.loadFromFile(in("map.simplemap")));
    return read;
  }
};

Pose poseOf(const mrpt::poses::CPose3D& pose) {
  return poseFromMatrix(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
}

/// Where the points of the frame's observation of that name are in the world.
std::vector<Eigen::Vector3d> worldPoints(const mrpt::obs::CSensoryFrame& frame, const char* label, const Pose& T_w_b) {
  std::vector<Eigen::Vector3d> points;
  const auto observation =
      std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(frame.getObservationBySensorLabel(label));
  if (!observation) return points;
  const Pose T_w_c = T_w_b * poseOf(observation->sensorPose);
  for (std::size_t i = 0; i < observation->pointcloud->size(); ++i) {
    float x = 0, y = 0, z = 0;
    observation->pointcloud->getPoint(i, x, y, z);
    points.push_back(T_w_c * Eigen::Vector3d(x, y, z));
  }
  return points;
}

TEST_F(SimplemapExport, MrptReadsTheKeyframesPosesBack) {
  const LineMap room = sampleRoom();
  const auto read = reread(room);
  ASSERT_EQ(read.size(), room.keyframes.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Pose T_w_b = poseOf(read.begin()[static_cast<std::ptrdiff_t>(i)].pose->getMeanVal()),
               wanted = room.keyframes[i].T_w_b;
    EXPECT_LT((T_w_b.p - wanted.p).norm(), 1e-12) << i;
    EXPECT_LT(T_w_b.q.angularDistance(wanted.q), 1e-7) << i;
  }
}

TEST_F(SimplemapExport, AKeyframeHoldsWhatItsCameraSawWhereItIsInTheWorld) {
  const LineMap room = sampleRoom();
  const auto read = reread(room);
  const auto& first = *read.begin();
  const auto points = worldPoints(*first.sf, "points", room.keyframes[0].T_w_b);
  ASSERT_EQ(points.size(), room.points.size());  // the sample's first keyframe sees every point
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - room.points[i].p_w).norm(), 1e-5) << i;
  const auto lines = worldPoints(*first.sf, "lines", room.keyframes[0].T_w_b);
  ASSERT_GT(lines.size(), room.lines.size());
  EXPECT_LT((lines.front() - room.lines[0].segment_w.start).norm(), 1e-5);
  EXPECT_LT((lines.back() - room.lines.back().segment_w.end).norm(), 1e-4);
  const std::int64_t ticks = first.sf->getObservationBySensorLabel("lines")->timestamp.time_since_epoch().count();
  EXPECT_EQ(ticks - 116444736000000000, room.keyframes[0].t_ns / 100);
}

TEST_F(SimplemapExport, LayersChooseWhatAKeyframeHolds) {
  ExportParams params;
  params.layers = {MapLayer::kKeyframes, MapLayer::kLines};
  const auto read = reread(sampleRoom(), params);
  ASSERT_EQ(read.size(), 20u);
  EXPECT_TRUE(read.begin()->sf->getObservationBySensorLabel("lines"));
  EXPECT_FALSE(read.begin()->sf->getObservationBySensorLabel("points"));
  EXPECT_EQ(reread({}).size(), 0u);
}

}  // namespace
}  // namespace lintel
