// SPDX-License-Identifier: BSD-3-Clause
// large_map lines COUNT OUT.lintel        COUNT short lines in a hall
// large_map repeat MAP.lintel N OUT.lintel  a map N times, one after the other in time and place: 225 times 16 s is an
// hour For measurements of exports (doc/results.md); not part of the tests.
#include <cstdlib>
#include <iostream>

#include "SampleMap.h"
#include "lintel/mapping/MapFile.h"

namespace lintel {
namespace {

template <class List>
std::uint64_t idsOf(const List& list) {
  return list.empty() ? 0 : list.back().id + 1;
}

LineMap repeated(const LineMap& map, int times) {
  LineMap all = map;
  const std::int64_t duration_ns =
      map.trajectory.empty() ? 0 : map.trajectory.back().first - map.trajectory.front().first + 50000000;
  for (int i = 1; i < times; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    const int row = i / 50;
    const Eigen::Vector3d shift(3.0 * (i % 50), 3.0 * row, 0);
    const std::int64_t later_ns = duration_ns * i;
    for (MapKeyframe keyframe : map.keyframes) {
      keyframe.id += n * idsOf(map.keyframes), keyframe.t_ns += later_ns, keyframe.T_w_b.p += shift;
      all.keyframes.push_back(keyframe);
    }
    for (MapPoint point : map.points) {
      point.id += n * idsOf(map.points), point.p_w += shift;
      for (auto& observation : point.observations) observation.keyframe_id += n * idsOf(map.keyframes);
      all.points.push_back(std::move(point));
    }
    for (MapLine line : map.lines) {
      line.id += n * idsOf(map.lines), line.first_t_ns += later_ns, line.last_t_ns += later_ns;
      line.segment_w.start += shift, line.segment_w.end += shift;
      for (auto& observation : line.observations) observation.keyframe_id += n * idsOf(map.keyframes);
      all.lines.push_back(std::move(line));
    }
    for (auto [t_ns, T_w_b] : map.trajectory) {
      T_w_b.p += shift;
      all.trajectory.emplace_back(t_ns + later_ns, T_w_b);
    }
  }
  return all;
}

int run(const std::vector<std::string>& words) {
  if (words.size() == 3 && words[0] == "lines") return writeMap(manyLines(std::atoi(words[1].c_str())), words[2]), 0;
  if (words.size() == 4 && words[0] == "repeat")
    return writeMap(repeated(readMap(words[1]), std::atoi(words[2].c_str())), words[3]), 0;
  std::cerr << "large_map lines COUNT OUT.lintel\nlarge_map repeat MAP.lintel N OUT.lintel\n";
  return 2;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) {
  try {
    return lintel::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "large_map: " << error.what() << '\n';
    return 1;
  }
}
