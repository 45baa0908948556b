// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/densification/Densifier.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "CommonViews.h"
#include "LineSearch.h"
#include "RowTimes.h"
#include "SeenPoints.h"
#include "lintel/core/ParallelFor.h"
#include "lintel/core/Quantiles.h"
#include "lintel/mapping/LineEvidence.h"
#include "lintel/mapping/LineFitting.h"

namespace lintel {

namespace {

constexpr int kPasses = 2;               // of adding edges to a line: with the first ones more of it is known
constexpr std::size_t kLeastKnown = 20;  // lines of the map whose errors say what is usual
constexpr double kUnusualShare = 0.4;    // of the map's limit, for the errors of lines where too few are known

constexpr double kFittedShare = 0.5;  // of the tolerance: what a fitted line needs less than a candidate
constexpr int kLeastTold = 2;         // images that tell whether a place is hidden
constexpr double kChanceMore = 0.15;  // images: what chance may cover although it was not seen to

/// An edge of an image.
struct Sighting {
  std::size_t view, segment;
};

/// A line that the material does not have, and its edges.
struct NewLine {
  LineRecord record;
  std::vector<Sighting> seen;
};

/// The search in one material.
class Densifier {
 public:
  Densifier(const DensifyParams& params, const MapParams& map, const ImageEdges& edges, MapMaterial& material)
      : params_(params), map_(map), material_(material), cameras_(material) {
    fit_.max_error_px = map.view_max_error_px;
    fit_.min_depth_m = map.min_depth_m;
    const RowTimes rows(material);
    for (std::size_t k = 0; k < material.keyframes.size(); ++k) {
      const RetiredKeyframe& keyframe = material.keyframes[k];
      const auto found = edges.find(keyframe.t_ns);
      if (found == edges.end()) continue;
      std::vector<EdgeSegment> segments = found->second;
      rows.move(k, segments);
      place_.emplace(keyframe.id, views_.size());
      views_.emplace_back(cameras_, keyframe.id, std::move(segments));
    }
    points_.emplace(material, views_);
    common_ = findCommonViews(*points_, static_cast<std::size_t>(params.views), views_);
    for (const SegmentView& view : views_) report_.segments += view.size();
    report_.images = views_.size();
    for (const LineRecord& line : material.lines) next_id_ = std::max(next_id_, line.id + 1);
  }

  DensifyReport run(int threads, const DensifyProgress& progress) {
    takeKnown();
    std::vector<std::optional<NewLine>> lines;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (progress && !progress(static_cast<double>(i) / static_cast<double>(views_.size()))) break;
      const std::size_t n = common_[i].chosen.empty() ? 0 : views_[i].size();
      lines.assign(n, std::nullopt);
      parallelFor(n, threads, [&](std::size_t s) { lines[s] = lineFrom(i, s); });
      for (std::size_t s = 0; s < n; ++s) {
        if (lines[s] && isTaken(*lines[s])) lines[s] = lineFrom(i, s);
        if (lines[s]) add(std::move(*lines[s]));
      }
    }
    return report_;
  }

 private:
  /// Edges of `among` that lie on a segment in space.
  std::vector<Sighting> sightings(const std::vector<std::size_t>& among, const Segment3& segment_w, bool taken_too,
                                  const EdgeLook* look = nullptr) const {
    std::vector<Sighting> seen;
    for (const std::size_t v : among)
      for (const std::size_t s :
           supportOf(views_[v], seenSegment(views_[v], segment_w), params_.tolerance_px, taken_too, look).by)
        seen.push_back({v, s});
    return seen;
  }

  void take(const std::vector<Sighting>& seen) {
    for (const Sighting& s : seen) views_[s.view].taken[s.segment] = 1;
  }

  LineView viewOf(const Sighting& s, TrackId track) const {
    const SegmentView& view = views_[s.view];
    const EdgeSegment& edge = view.segments[s.segment];
    return {view.keyframe, track, edge.start_px, edge.end_px, edge.sigma_px, true};
  }

  /// Lines that the map has get the edges on them as views where tracking had none; these edges are no candidates.
  void takeKnown() {
    std::vector<double> errors_px;
    for (LineRecord& line : material_.lines) {
      LineEvidence evidence = evidenceOf(map_, cameras_, line);
      if (!evidence.known) continue;
      errors_px.push_back(line.error_px);
      const std::vector<std::size_t> among = viewsAround(line);
      for (int pass = 0; pass < kPasses; ++pass) {
        if (!extend(line, sightings(among, evidence.segment_w, true))) break;
        evidence = evidenceOf(map_, cameras_, line);
      }
      take(sightings(among, evidence.segment_w, true));
    }
    most_error_px_ = kUnusualShare * map_.max_error_px;
    if (errors_px.size() >= kLeastKnown)
      most_error_px_ = std::min(map_.max_error_px, params_.max_error_ratio * upperQuantile(errors_px, 0.95));
  }

  /// Those that share points with views of the line, or with the first searched after one of them.
  std::vector<std::size_t> viewsAround(const LineRecord& line) const {
    std::set<std::size_t> at;
    for (const LineView& v : line.views)
      if (const auto found = place_.lower_bound(v.keyframe); found != place_.end() && v.inlier)
        at.insert(found->second);
    std::vector<bool> is_around(views_.size());
    for (const std::size_t v : at)
      for (const std::size_t other : common_[v].all) is_around[other] = true;
    std::vector<std::size_t> around;
    for (std::size_t v = 0; v < views_.size(); ++v)
      if (is_around[v]) around.push_back(v);
    return around;
  }

  /// Adds views of keyframes that have none; false when there are none, or the line would not be known any more.
  bool extend(LineRecord& line, const std::vector<Sighting>& seen) {
    std::set<FrameId> have;
    for (const LineView& v : line.views) have.insert(v.keyframe);
    LineRecord more = line;
    for (const Sighting& s : seen)
      if (have.count(views_[s.view].keyframe) == 0) more.views.push_back(viewOf(s, line.id));
    if (more.views.size() == line.views.size()) return false;
    std::stable_sort(more.views.begin(), more.views.end(),
                     [](const LineView& a, const LineView& b) { return a.keyframe < b.keyframe; });
    if (!fitLine(cameras_, fit_, more) || !evidenceOf(map_, cameras_, more).known) return false;
    report_.views += more.views.size() - line.views.size();
    line = std::move(more);
    return true;
  }

  bool isTaken(const NewLine& line) const {
    return std::any_of(line.seen.begin(), line.seen.end(),
                       [&](const Sighting& s) { return views_[s.view].taken[s.segment] != 0; });
  }

  void add(NewLine&& line) {
    take(line.seen);
    line.record.id = next_id_++;
    for (LineView& view : line.record.views) view.track = line.record.id;
    material_.lines.push_back(std::move(line.record));
    ++report_.lines;
  }

  /// The line of an edge, if one is found and has enough evidence. One whose views leave its direction or position open
  /// is taken as well: parallel lines may make it known.
  std::optional<NewLine> lineFrom(std::size_t i, std::size_t s) const {
    if (views_[i].taken[s]) return std::nullopt;
    auto segment_w = searchLine(params_, views_, common_[i].chosen, i, s);
    if (!segment_w) return std::nullopt;
    const EdgeLook look(views_[i].segments[s]);
    NewLine line;
    for (int pass = 0; pass < kPasses; ++pass) {
      line.seen = sightings(common_[i].all, *segment_w, false, &look);
      line.record = LineRecord();
      line.record.mapped = true;
      for (const Sighting& seen : line.seen) line.record.views.push_back(viewOf(seen, 0));
      if (!fitLine(cameras_, fit_, line.record) || line.record.error_px > most_error_px_) return std::nullopt;
      const LineEvidence evidence = evidenceOf(map_, cameras_, line.record);
      if (!evidence.known && !evidence.degenerate) return std::nullopt;
      if (evidence.known) segment_w = evidence.segment_w;
      line.record.parallel = !evidence.known;
    }
    if (!isSupported(line.record, *segment_w, i, look)) return std::nullopt;
    return line;
  }

  /// Whether an end or the middle lies behind what most of the images that seem to have the line see there.
  bool isHidden(const Segment3& segment_w, const std::vector<std::size_t>& supporting) const {
    for (const Eigen::Vector3d& p_w : {segment_w.start, segment_w.end, segment_w.midpoint()}) {
      int told = 0, behind = 0;
      for (const std::size_t v : supporting)
        if (const std::optional<bool> is_behind = points_->isBehind(v, p_w)) ++told, behind += *is_behind ? 1 : 0;
      if (told >= kLeastTold && 2 * behind > told) return true;
    }
    return false;
  }

  /// Whether enough images, from places far enough apart, have it, and would not by chance.
  bool isSupported(const LineRecord& line, const Segment3& segment_w, std::size_t i, const EdgeLook& look) const {
    const auto planeOf = [&](std::size_t v) {
      return line.estimate.direction_w.cross(line.estimate.middle_w - views_[v].p_w_c).normalized();
    };
    const double tolerance_px = kFittedShare * params_.tolerance_px;
    const Eigen::Vector3d own = planeOf(i);
    int visible = 0;
    double chance = 0, cover = 0;
    std::vector<double> sines;
    std::vector<std::size_t> supporting;
    std::vector<std::size_t> among = common_[i].chosen;
    among.push_back(i);
    for (const std::size_t v : among) {
      const SeenSegment seen = seenSegment(views_[v], segment_w);
      const LineSupport support = supportOf(views_[v], seen, tolerance_px, false, &look);
      if (!support.visible) continue;
      ++visible;
      chance += chanceOf(views_[v], seen, tolerance_px, look);
      if (support.cover < params_.least_cover) continue;
      supporting.push_back(v);
      cover += support.cover;
      sines.push_back(own.cross(planeOf(v)).norm());
    }
    const int supporters = static_cast<int>(supporting.size());
    if (supporters < params_.min_keyframes || cover < params_.least_share * visible) return false;
    std::sort(sines.begin(), sines.end(), std::greater<>());
    if (sines[2] < std::sin(params_.min_parallax_rad) || isHidden(segment_w, supporting)) return false;
    // two views determine the line; the others might have agreed by chance
    const double p = (chance + kChanceMore) / visible;
    return binomialTail(supporters - 2, visible - 2, p) <= params_.max_chance;
  }

  const DensifyParams& params_;
  const MapParams& map_;
  MapMaterial& material_;
  KeyframeCameras cameras_;
  LineFitParams fit_;
  std::vector<SegmentView> views_;
  std::map<FrameId, std::size_t> place_;  ///< of a keyframe among the views
  std::optional<SeenPoints> points_;
  std::vector<CommonViews> common_;
  TrackId next_id_ = 0;
  double most_error_px_ = 0;
  DensifyReport report_;
};

}  // namespace

DensifyReport densify(const DensifyParams& params, const MapParams& map, const ImageEdges& edges, MapMaterial& material,
                      int threads, const DensifyProgress& progress) {
  checkRanges(params, "densification.");
  return Densifier(params, map, edges, material).run(threads, progress);
}

}  // namespace lintel
