// SPDX-License-Identifier: BSD-3-Clause
#include "LineJudgement.h"

#include <algorithm>

#include "Evidence.h"
#include "LineExtent.h"

namespace lintel {

namespace {

bool hasEvidence(const MapParams& params, const LineRecord& line) {
  if (!line.known || keyframesOf(line) < params.min_observations || line.error_px > params.max_error_px) return false;
  return inliersOf(line) >= params.min_inlier_share * static_cast<double>(line.views.size());
}

}  // namespace

LineJudgement judgeMapLine(const MapParams& params, const KeyframeCameras& cameras, const LineRecord& line) {
  LineJudgement result;
  if (!hasEvidence(params, line)) return result;
  result.stretch = seenStretch(cameras, line, params.coverage);
  const auto [from, to] = result.stretch.value_or(std::make_pair(0.0, 0.0));
  result.sigma_direction_rad = line.estimate.sigmaDirection();
  result.sigma_distance_m = std::max(line.estimate.sigmaPosition(from), line.estimate.sigmaPosition(to));
  const double most_m = std::min(std::max(params.max_sigma_m, params.max_far_sigma * line.distance_m),
                                 params.max_relative_sigma * line.distance_m);
  const bool known = result.sigma_direction_rad <= params.max_sigma_direction_rad && result.sigma_distance_m <= most_m;
  result.state = known ? LineState::kKnown : LineState::kDegenerate;
  return result;
}

LineEvidence evidenceOf(const MapParams& params, const KeyframeCameras& cameras, const LineRecord& line) {
  const LineJudgement judged = judgeMapLine(params, cameras, line);
  const bool wanted =
      judged.state == LineState::kKnown || (judged.state == LineState::kDegenerate && params.degenerate_lines == "use");
  LineEvidence evidence;
  evidence.known = wanted && judged.stretch && judged.stretch->second - judged.stretch->first >= params.min_length_m;
  evidence.degenerate = judged.state == LineState::kDegenerate;
  if (!evidence.known) return evidence;
  evidence.segment_w = segmentOf(cameras, line, *judged.stretch);
  evidence.sigma_direction_rad = judged.sigma_direction_rad;
  evidence.sigma_distance_m = judged.sigma_distance_m;
  return evidence;
}

}  // namespace lintel
