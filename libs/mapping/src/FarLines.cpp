// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/FarLines.h"

#include <algorithm>
#include <vector>

#include "LineJudgement.h"

namespace lintel {

namespace {

struct FarLine {
  double length_m = 0;
  double least_far_sigma = 0;  ///< with which it is part of the map
};

/// Lines that would be part of the map if only `max_relative_sigma` counted.
std::vector<FarLine> farLines(const MapParams& params, const MapMaterial& material) {
  MapParams widest = params;
  widest.max_far_sigma = params.max_relative_sigma;
  const KeyframeCameras cameras(material);
  std::vector<FarLine> lines;
  for (const LineRecord& line : material.lines) {
    const LineJudgement judged = judgeMapLine(widest, cameras, line);
    if (judged.state != LineState::kKnown || !judged.stretch) continue;
    const double relative_sigma =
        judged.sigma_distance_m <= params.max_sigma_m ? 0 : judged.sigma_distance_m / line.distance_m;
    lines.push_back({judged.stretch->second - judged.stretch->first, relative_sigma});
  }
  return lines;
}

}  // namespace

MapParams withFarLines(const MapParams& params, const MapMaterial& material, double share) {
  std::vector<FarLine> lines = farLines(params, material);
  std::stable_sort(lines.begin(), lines.end(),
                   [](const FarLine& a, const FarLine& b) { return a.least_far_sigma < b.least_far_sigma; });
  double missing_m = 0;
  for (const FarLine& line : lines) missing_m += share * line.length_m;
  MapParams result = params;
  for (const FarLine& line : lines) {
    if (!(missing_m > 0)) break;
    result.max_far_sigma = std::max(result.max_far_sigma, line.least_far_sigma);
    missing_m -= line.length_m;
  }
  return result;
}

}  // namespace lintel
