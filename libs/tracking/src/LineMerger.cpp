// SPDX-License-Identifier: BSD-3-Clause
#include "LineMerger.h"

#include <algorithm>
#include <cmath>

namespace lintel {
namespace {

constexpr double kGap_px = 15;                 ///< from a line to what continues it, at the reference focal length
constexpr double kDuplicateDistance_px = 1.5;  ///< of the image: two lines on one edge differ by their noise
constexpr double kDuplicateOverlap = 0.5;      ///< of the shorter one

struct Overlap {
  std::size_t predicted, detected;
  double score;
};

/// The longer one gives the line, both give the ends.
ImageLine united(const ImageLine& a, const ImageLine& b) {
  const bool a_longer = a.length() >= b.length();
  ImageLine line = a_longer ? a : b;
  const ImageLine& piece = a_longer ? b : a;
  const Eigen::Vector2d d = line.direction(), origin = line.start;
  const double length = line.length();
  const double first = d.dot(piece.start - origin), last = d.dot(piece.end - origin);
  if (first < 0) line.start = origin + first * d;
  if (last > length) line.end = origin + last * d;
  return line;
}

}  // namespace

double LineMerger::score(const ImageLine& predicted, const ImageLine& detected) const {
  // A short line's direction is uncertain: distances are measured from the longer one.
  const bool longer = predicted.length() >= detected.length();
  const ImageLine &reference = longer ? predicted : detected, &other = longer ? detected : predicted;
  const auto relation = camera_.relateNear(reference, other, params_.merge_distance_px);
  const double shorter = other.length();
  if (!relation || relation->angle_rad > params_.merge_angle_rad || relation->overlap_px < -camera_.scaled(kGap_px) ||
      shorter <= 0)
    return 0;
  // A piece that continues the line counts, but less than one beside it.
  const double overlap = 0.2 + 0.8 * std::clamp(relation->overlap_px / shorter, 0.0, 1.0);
  return overlap * (1.0 - 0.7 * relation->angle_rad / params_.merge_angle_rad) *
         (1.0 - 0.7 * relation->distance_px / params_.merge_distance_px);
}

MergedLines LineMerger::merge(const std::vector<ImageLine>& predicted, const std::vector<ImageLine>& detected) const {
  std::vector<Overlap> pairs;
  for (std::size_t p = 0; p < predicted.size(); ++p)
    for (std::size_t d = 0; d < detected.size(); ++d)
      if (const double s = score(predicted[p], detected[d]); s > 0) pairs.push_back({p, d, s});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Overlap& a, const Overlap& b) { return a.score > b.score; });

  MergedLines merged{predicted, std::vector<int>(predicted.size(), 0), {}};
  std::vector<char> taken(detected.size(), 0);
  for (const Overlap& pair : pairs) {
    if (taken[pair.detected]) continue;
    taken[pair.detected] = 1;
    ++merged.detections[pair.predicted];
    ImageLine& line = merged.lines[pair.predicted];
    line = united(line, camera_.seenFrom(line.axis, detected[pair.detected]));
  }
  for (std::size_t d = 0; d < detected.size(); ++d)
    if (!taken[d]) merged.fresh.push_back(detected[d]);
  return merged;
}

bool LineMerger::duplicates(const ImageLine& a, const ImageLine& b) const {
  const bool a_longer = a.length() >= b.length();
  const ImageLine &longer = a_longer ? a : b, &shorter = a_longer ? b : a;
  const auto relation = camera_.relateNear(longer, shorter, kDuplicateDistance_px);
  return relation && relation->angle_rad < params_.merge_angle_rad &&
         relation->overlap_px > kDuplicateOverlap * shorter.length();
}

}  // namespace lintel
