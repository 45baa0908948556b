// SPDX-License-Identifier: BSD-3-Clause
// What sections that are whole can still say wrongly: numbers and times that the programs count with.
#include "MapChecks.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr std::uint64_t kMostKeyframes = 10'000'000;              // numbers of keyframes index tables
constexpr std::int64_t kFarthest_ns = 4'000'000'000'000'000'000;  // the difference of two times is a number of 64 bits
constexpr double kLongestOffset_s = 3600;                         // of the clocks
constexpr int kLargestImage_px = 100'000;
constexpr std::int64_t kLongestImu_ns = 3'600'000'000'000;  // from one keyframe to the next

bool isTime(std::int64_t t_ns) { return t_ns > -kFarthest_ns && t_ns < kFarthest_ns; }

template <class Records>
bool idsAscend(const Records& records) {
  return std::adjacent_find(records.begin(), records.end(),
                            [](const auto& a, const auto& b) { return a.id >= b.id; }) == records.end();
}

template <class Landmarks>
bool haveTimes(const Landmarks& landmarks) {
  return std::all_of(landmarks.begin(), landmarks.end(),
                     [](const auto& seen) { return isTime(seen.first_t_ns) && isTime(seen.last_t_ns); });
}

bool isRig(const Rig& rig) {
  const Camera& camera = rig.camera;
  const auto is_size = [](int px) { return px >= 0 && px <= kLargestImage_px; };
  const Eigen::Vector4d pinhole(camera.fx, camera.fy, camera.cx, camera.cy);
  return is_size(camera.width) && is_size(camera.height) && pinhole.allFinite() && rig.T_b_c.q.coeffs().allFinite() &&
         rig.T_b_c.p.allFinite();
}

std::string wrongTimes(const LineMap& map) {
  const bool good =
      haveTimes(map.points) && haveTimes(map.lines) &&
      std::all_of(map.keyframes.begin(), map.keyframes.end(), [](const auto& k) { return isTime(k.t_ns); }) &&
      std::all_of(map.trajectory.begin(), map.trajectory.end(), [](const auto& pose) { return isTime(pose.first); }) &&
      std::all_of(map.views.begin(), map.views.end(), [](const MapView& view) { return isTime(view.looks.t_ns); });
  return good ? "" : "has times that are out of range";
}

std::string wrongPieces(const LineMap& map) {
  const std::size_t recordings = std::max<std::size_t>(map.recordings.size(), 1);
  for (std::size_t i = 0; i < map.pieces.size(); ++i) {
    const MapPiece& piece = map.pieces[i];
    if (static_cast<std::uint32_t>(piece.world) > i) return "has a piece in the frame of a later one";
    if (static_cast<std::uint32_t>(piece.recording) >= recordings)
      return "has a piece of a recording that it does not name";
    if (!isTime(piece.first_ns) || !isTime(piece.last_ns) || piece.first_ns > piece.last_ns)
      return "has a piece that ends before it begins";
    if (i > 0 &&
        (piece.first_keyframe <= map.pieces[i - 1].first_keyframe || piece.first_pose < map.pieces[i - 1].first_pose))
      return "has pieces out of order";
    if (piece.first_pose > map.trajectory.size()) return "has a piece beyond its trajectory";
  }
  return "";
}

}  // namespace

std::string wrongSamples(const ImuBatch& samples) {
  for (const ImuSample& sample : samples) {
    if (!isTime(sample.t_ns)) return "has times that are out of range";
    if (sample.t_ns > samples.front().t_ns + kLongestImu_ns) return "has an hour of IMU from one keyframe to the next";
  }
  return "";
}

std::string whatIsWrong(const LineMap& map) {
  if (!idsAscend(map.keyframes) || !idsAscend(map.points) || !idsAscend(map.lines))
    return "has records that are out of order";
  if (!map.keyframes.empty() && map.keyframes.back().id >= kMostKeyframes)
    return "has a keyframe of the number " + std::to_string(map.keyframes.back().id);
  const auto groups = static_cast<int>(map.groups.size());  // early files name none, though lines have numbers
  for (const MapLine& line : map.lines)
    if (line.group < -1 || (groups > 0 && line.group >= groups)) return "has a line in a group that does not exist";
  if (!isRig(map.rig)) return "has a camera whose numbers are out of range";
  if (!(std::abs(map.time_offset_s) < kLongestOffset_s)) return "has clocks that are an hour apart";
  for (const MapKeyframe& keyframe : map.keyframes)
    if (!(std::abs(keyframe.offset_change_s) < kLongestOffset_s)) return "has clocks that change by an hour";
  const std::string times = wrongTimes(map);
  return times.empty() ? wrongPieces(map) : times;
}

}  // namespace lintel
