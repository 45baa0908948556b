// SPDX-License-Identifier: BSD-3-Clause
#include "LocalPoints.h"

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <tuple>

namespace lintel {

namespace {

constexpr float kSamePlace_px = 6;                // features nearer than that are of one corner in several sizes
constexpr int kLookLevel = 1;                     // of a point: it may be found one size smaller or larger
constexpr std::int64_t kNear_ns = 2'000'000'000;  // neighbours in time see the same things
constexpr double kRatio = 0.85;                   // of bits, to the next best elsewhere

/// Bits in which every point, a row, differs from every feature.
cv::Mat allBits(const std::vector<LocalPoint>& points, const PlaceView& view) {
  std::vector<PlaceDescriptor> looks;
  looks.reserve(points.size());
  for (const LocalPoint& point : points) looks.push_back(point.look);
  const cv::Mat rows(static_cast<int>(looks.size()), sizeof(PlaceDescriptor), CV_8UC1, looks.data());
  const cv::Mat columns(static_cast<int>(view.features.size()), sizeof(PlaceDescriptor), CV_8UC1,
                        const_cast<PlaceDescriptor*>(&view.features.front().descriptor), sizeof(PlaceFeature));
  cv::Mat bits;
  cv::batchDistance(rows, columns, bits, CV_32S, cv::noArray(), cv::NORM_HAMMING);
  return bits;
}

/// The best feature for a point; it differs by 256 bits if there is none that is clearly the best.
LookAlike bestFeature(std::size_t point, const int* bits, const PlaceView& view) {
  LookAlike best{point, 0, 256};
  int second = 256;
  for (std::size_t f = 0; f < view.features.size(); ++f) {
    if (bits[f] >= second) continue;
    const bool beside =
        best.bits < 256 && (view.features[f].px - view.features[best.feature].px).norm() < kSamePlace_px;
    if (bits[f] < best.bits) {
      if (!beside) second = best.bits;
      best = {point, f, bits[f]};
    } else if (!beside) {
      second = bits[f];
    }
  }
  if (best.bits > kRatio * second) best.bits = 256;
  return best;
}

}  // namespace

std::vector<LocalPoint> localPoints(const std::vector<PlaceKeyframe>& keyframes, std::size_t at, std::size_t reach,
                                    const std::unordered_map<TrackId, Eigen::Vector3d>& points_w) {
  std::map<TrackId, LocalPoint> points;
  const std::size_t first = at - std::min(at, reach), last = std::min(at + reach, keyframes.size() - 1);
  std::vector<std::size_t> order{at};
  for (std::size_t k = first; k <= last; ++k)
    if (k != at && keyframes[k].run == keyframes[at].run &&
        std::abs(keyframes[k].view->t_ns - keyframes[at].view->t_ns) <= kNear_ns)
      order.push_back(k);
  for (const std::size_t k : order) {
    for (const PlaceFeature& feature : keyframes[k].view->features) {
      if (feature.track == PlaceFeature::kNoTrack || feature.level != kLookLevel) continue;
      const auto found = points_w.find(static_cast<TrackId>(feature.track));
      if (found == points_w.end()) continue;
      points.try_emplace(found->first, LocalPoint{found->first, found->second, feature.descriptor});
    }
  }
  std::vector<LocalPoint> result;
  result.reserve(points.size());
  for (const auto& [track, point] : points) result.push_back(point);
  return result;
}

std::vector<LookAlike> matchByLooks(const std::vector<LocalPoint>& points, const PlaceView& view, int max_bits) {
  std::vector<LookAlike> all, matches;
  if (points.empty() || view.features.empty()) return matches;
  const cv::Mat bits = allBits(points, view);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const LookAlike best = bestFeature(p, bits.ptr<int>(static_cast<int>(p)), view);
    if (best.bits <= max_bits) all.push_back(best);
  }
  std::sort(all.begin(), all.end(), [](const LookAlike& a, const LookAlike& b) {
    return std::tie(a.bits, a.point) < std::tie(b.bits, b.point);
  });
  for (const LookAlike& match : all)
    if (std::none_of(matches.begin(), matches.end(), [&](const LookAlike& m) {
          return (view.features[m.feature].px - view.features[match.feature].px).norm() < kSamePlace_px;
        }))
      matches.push_back(match);
  return matches;
}

std::vector<SamePoint> matchByPose(const Camera& camera, const std::vector<LocalPoint>& points, const PlaceView& view,
                                   const Pose& T_w_c, double max_error_px, int max_bits) {
  const Pose T_c_w = T_w_c.inverse();
  struct Candidate {
    int bits;
    TrackId earlier, later;
    bool operator<(const Candidate& o) const {
      return std::tie(bits, earlier, later) < std::tie(o.bits, o.earlier, o.later);
    }
  };
  std::vector<Candidate> candidates;
  for (const LocalPoint& point : points) {
    const Eigen::Vector3d p_c = T_c_w * point.p_w;
    if (!camera.projects(p_c)) continue;
    const Eigen::Vector2d px = camera.project(p_c);
    for (const PlaceFeature& feature : view.features) {
      if (feature.track == PlaceFeature::kNoTrack || (feature.px.cast<double>() - px).norm() > max_error_px) continue;
      const int bits = hammingDistance(point.look, feature.descriptor);
      if (bits <= max_bits) candidates.push_back({bits, point.track, static_cast<TrackId>(feature.track)});
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<SamePoint> same;
  for (const Candidate& c : candidates)
    if (std::none_of(same.begin(), same.end(),
                     [&](const SamePoint& s) { return s.earlier == c.earlier || s.later == c.later; }))
      same.push_back({c.earlier, c.later, 1});
  return same;
}

}  // namespace lintel
