// SPDX-License-Identifier: BSD-3-Clause
// repeat_map MAP.lintel LINES OUT.lintel [TRUE_LINES.csv OUT.csv]: a map of at least LINES lines, made of copies of a
// map side by side; the same of its true lines (large_map).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "../ToolMain.h"
#include "lintel/evaluation/TrueLines.h"
#include "lintel/mapping/MapFile.h"

namespace lintel {
namespace {

/// Where the copies stand: a square of rows, so far apart that lines do not touch.
class Places {
 public:
  Places(const LineMap& map, std::size_t count)
      : count_(count), columns_(static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))))) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const MapLine& line : map.lines)
      for (const Eigen::Vector3d& p_w : {line.segment_w.start, line.segment_w.end}) {
        low = low.cwiseMin(p_w);
        high = high.cwiseMax(p_w);
      }
    step_m_ = (high - low).head<2>().maxCoeff() + 5;
  }

  std::size_t count() const { return count_; }
  Eigen::Vector3d shift(std::size_t i) const {
    const std::size_t column = i % columns_, row = i / columns_;
    return step_m_ * Eigen::Vector3d(static_cast<double>(column), static_cast<double>(row), 0);
  }

 private:
  std::size_t count_, columns_;
  double step_m_ = 0;
};

/// Keyframes and trajectory are those of the first copy, which all lines were seen from.
LineMap repeated(const LineMap& map, const Places& places) {
  LineMap result = map;
  const std::uint64_t ids = map.lines.back().id + 1;
  for (std::size_t i = 1; i < places.count(); ++i)
    for (MapLine line : map.lines) {
      line.id += i * ids;
      line.segment_w.start += places.shift(i);
      line.segment_w.end += places.shift(i);
      result.lines.push_back(line);
    }
  return result;
}

void repeatTruth(const std::string& from, const std::string& to, const Places& places) {
  const std::vector<TrueLine> truth = readTrueLines(from);
  std::ofstream file(to);
  file.precision(9);
  file << "#id,x0 [m],y0 [m],z0 [m],x1 [m],y1 [m],z1 [m],direction_group,kind,frames_seen\n";
  std::size_t id = 0;
  for (std::size_t i = 0; i < places.count(); ++i)
    for (const TrueLine& line : truth) {
      const Eigen::Vector3d start = line.segment_w.start + places.shift(i), end = line.segment_w.end + places.shift(i);
      file << id++ << ',' << start.x() << ',' << start.y() << ',' << start.z() << ',' << end.x() << ',' << end.y()
           << ',' << end.z() << ",-1,copy," << line.frames_seen << '\n';
    }
  if (!file.flush()) throw std::runtime_error(to + ": cannot be written");
}

int runTool(int argc, char** argv) {
  if (argc != 4 && argc != 6)
    throw std::runtime_error("usage: repeat_map MAP.lintel LINES OUT.lintel [TRUE_LINES.csv OUT.csv]");
  const LineMap map = readMap(argv[1]);
  if (map.lines.empty()) throw std::runtime_error(std::string(argv[1]) + ": holds no lines");
  const std::size_t lines = std::stoul(argv[2]);
  const Places places(map, (lines + map.lines.size() - 1) / map.lines.size());
  const LineMap large = repeated(map, places);
  writeMap(large, argv[3]);
  if (argc == 6) repeatTruth(argv[4], argv[5], places);
  std::printf("%zu lines: %zu copies\n", large.lines.size(), places.count());
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("repeat_map", lintel::runTool, argc, argv); }
