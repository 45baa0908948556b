// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "GzipStream.h"
#include "Writers.h"

// Keyframes as MRPT's view-based map: the body's pose, and what the camera saw there as two clouds of points, those of
// the map and points along the lines. MRPT has no observation of 3D segments.
namespace lintel {

namespace {

constexpr double kSpacing_m = 0.05;     // along a line; MOLA's local maps are no finer
constexpr double kMostAlongALine = 50;  // a very long wrong line does not fill a cloud

/// What a keyframe saw of the drawing.
struct Seen {
  std::vector<const MapPoint*> points;
  std::vector<const MapLine*> lines;
};

std::unordered_map<std::uint64_t, Seen> seenByKeyframe(const Drawing& drawing) {
  std::unordered_map<std::uint64_t, Seen> seen;
  for (const DrawnPart& part : drawing.parts) {
    for (const DrawnPoint& point : part.points) {
      for (const auto& observation : point.point->observations)
        seen[observation.keyframe_id].points.push_back(point.point);
    }
  }
  for (const MapLine* line : drawing.lines) {
    for (const auto& observation : line->observations) seen[observation.keyframe_id].lines.push_back(line);
  }
  return seen;
}

/// By integers, as MRPT's own conversions go through double. A rawlog's clock ticks at 100 ns.
mrpt::Clock::time_point mrptTime(std::int64_t t_ns) {
  constexpr std::int64_t kTicksFrom1601To1970 = 116444736000000000;
  return mrpt::Clock::time_point(mrpt::Clock::duration(t_ns / 100 + kTicksFrom1601To1970));
}

mrpt::poses::CPose3D mrptPose(const Pose& T) {
  return {mrpt::math::CQuaternionDouble(T.q.w(), T.q.x(), T.q.y(), T.q.z()), T.p.x(), T.p.y(), T.p.z()};
}

mrpt::maps::CSimplePointsMap::Ptr cloudOfPoints(const Seen& seen, const Pose& T_c_w) {
  auto cloud = mrpt::maps::CSimplePointsMap::Create();
  for (const MapPoint* point : seen.points) {
    const Eigen::Vector3f p = (T_c_w * point->p_w).cast<float>();
    cloud->insertPoint(p.x(), p.y(), p.z());
  }
  return cloud;
}

mrpt::maps::CSimplePointsMap::Ptr cloudOfLines(const Seen& seen, const Pose& T_c_w) {
  auto cloud = mrpt::maps::CSimplePointsMap::Create();
  for (const MapLine* line : seen.lines) {
    const auto& [start, end] = line->segment_w;
    const auto steps = static_cast<int>(std::clamp(std::ceil((end - start).norm() / kSpacing_m), 1.0, kMostAlongALine));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector3f p = (T_c_w * (start + (end - start) * i / steps)).cast<float>();
      cloud->insertPoint(p.x(), p.y(), p.z());
    }
  }
  return cloud;
}

void addCloud(const char* label, const mrpt::maps::CSimplePointsMap::Ptr& cloud, const MapKeyframe& keyframe,
              const Rig& rig, mrpt::obs::CSensoryFrame& frame) {
  if (cloud->empty()) return;
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->timestamp = mrptTime(keyframe.t_ns);
  observation->sensorLabel = label;
  observation->sensorPose = mrptPose(rig.T_b_c);
  observation->pointcloud = cloud;
  frame.insert(observation);
}

}  // namespace

OutputFiles simplemapFiles(const Drawing& drawing, const std::string& path) {
  auto seen = seenByKeyframe(drawing);
  const Rig& rig = drawing.map->rig;
  mrpt::maps::CSimpleMap map;
  for (const MapKeyframe& keyframe : drawing.keyframes) {
    const Pose T_c_w = (keyframe.T_w_b * rig.T_b_c).inverse();
    const Seen& here = seen[keyframe.id];
    auto frame = mrpt::obs::CSensoryFrame::Create();
    addCloud("points", cloudOfPoints(here, T_c_w), keyframe, rig, *frame);
    addCloud("lines", cloudOfLines(here, T_c_w), keyframe, rig, *frame);
    // The map does not keep the poses' covariances: MRPT reads zeros as "not known".
    map.insert(mrpt::poses::CPose3DPDFGaussian::Create(mrptPose(keyframe.T_w_b)), frame);
  }
  GzipStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  return {{path, stream.finish()}};
}

}  // namespace lintel
