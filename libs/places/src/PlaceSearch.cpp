// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/places/PlaceSearch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "LocalPoints.h"
#include "Resection.h"
#include "RunAlignment.h"
#include "WordIndex.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr std::size_t kReach = 2;               // keyframes to each side that add local points
constexpr std::size_t kEnough = 2;              // earlier places found for a keyframe
constexpr std::int64_t kVisit_ns = 2000000000;  // keyframes so near in time are of one visit
constexpr std::int64_t kApart_ns = 1000000000;  // candidates that are tried are farther apart
constexpr double kFaster = 1.5;                 // than ever seen it may have flown where nothing was estimated
constexpr double kSameDrift_m = 0.1, kSameDriftShare = 0.03, kSameDrift_rad = 0.03;

std::int64_t timeOf(const PlaceKeyframe& keyframe) { return keyframe.view->t_ns; }

/// A pair that geometry allows.
struct Found {
  std::size_t earlier = 0, later = 0;
  Pose T_w_c;
  Pose drift;             ///< from the later odometry's world to the earlier one's
  double distance_m = 0;  ///< of the points, median
  PlacePair pair;
};

int cellsWith(const Camera& camera, const std::vector<Eigen::Vector2f>& places) {
  std::set<int> cells;
  for (const Eigen::Vector2f& px : places)
    cells.insert(4 * static_cast<int>(4 * px.y() / static_cast<float>(camera.height)) +
                 static_cast<int>(4 * px.x() / static_cast<float>(camera.width)));
  return static_cast<int>(cells.size());
}

class Search {
 public:
  Search(const Camera& camera, const std::vector<PlaceKeyframe>& keyframes,
         const std::unordered_map<TrackId, Eigen::Vector3d>& points_w, const PlaceParams& params)
      : camera_(camera), keyframes_(keyframes), points_w_(points_w), params_(scaledTo(camera, params)) {
    for (const PlaceKeyframe& keyframe : keyframes) index_.add(*keyframe.view);
  }

  PlaceReport run(const std::function<bool(double)>& progress) {
    for (std::size_t later = 0; later < keyframes_.size(); ++later) {
      if (progress && !progress(static_cast<double>(later) / static_cast<double>(keyframes_.size()))) break;
      const std::vector<float> scores = index_.scores(*keyframes_[later].view, later);
      for (const bool same_run : {true, false}) {
        const std::size_t before = found_.size();
        for (const std::size_t earlier : candidatesOf(later, same_run, scores))
          if (found_.size() < before + kEnough) check(earlier, later);
      }
    }
    demandSupport();
    PlaceReport report;
    report.alignments = align();
    report.described = keyframes_.size();
    for (const Found& f : found_) report.pairs.push_back(f.pair);
    report.same = samePoints();
    return report;
  }

 private:
  /// Earlier keyframes of the same run, or of others, that look most alike, of different visits.
  std::vector<std::size_t> candidatesOf(std::size_t later, bool same_run, const std::vector<float>& scores) const {
    const auto separation_ns = static_cast<std::int64_t>(1e9 * params_.min_separation_s);
    std::vector<std::size_t> order, chosen;
    for (std::size_t i = 0; i < later; ++i) {
      if (scores[i] <= 0 || (keyframes_[i].run == keyframes_[later].run) != same_run) continue;
      if (!same_run || timeOf(keyframes_[later]) - timeOf(keyframes_[i]) > separation_ns) order.push_back(i);
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return scores[a] != scores[b] ? scores[a] > scores[b] : a < b; });
    for (const std::size_t i : order) {
      if (chosen.size() >= static_cast<std::size_t>(params_.candidates)) break;
      if (std::none_of(chosen.begin(), chosen.end(), [&](std::size_t c) {
            return keyframes_[c].run == keyframes_[i].run &&
                   std::abs(timeOf(keyframes_[c]) - timeOf(keyframes_[i])) < kApart_ns;
          }))
        chosen.push_back(i);
    }
    return chosen;
  }

  void check(std::size_t earlier, std::size_t later) {
    const PlaceView& view = *keyframes_[later].view;
    const std::vector<LocalPoint> points = localPoints(keyframes_, earlier, kReach, points_w_);
    const std::vector<LookAlike> matches = matchByLooks(points, view, params_.max_bits);
    std::vector<Sighting> sightings;
    sightings.reserve(matches.size());
    for (const LookAlike& m : matches)
      sightings.push_back({points[m.point].p_w, camera_.ray(view.features[m.feature].px.cast<double>()).normalized()});
    ResectionParams resection;
    resection.fine_rad = params_.max_error_px / camera_.meanFocal();
    resection.coarse_rad = 2 * resection.fine_rad;
    const auto resected = resect(sightings, keyframes_[later].T_w_c.q, resection);
    if (!resected || static_cast<int>(resected->inliers.size()) < params_.min_points) return;
    std::vector<Eigen::Vector2f> places;
    std::vector<double> distances, apart;
    for (const std::size_t i : resected->inliers) {
      places.push_back(view.features[matches[i].feature].px);
      distances.push_back((sightings[i].p_w - resected->T_w_c.p).norm());
      const Eigen::Vector3d expected = keyframes_[later].T_w_c.inverse() * sightings[i].p_w;
      apart.push_back(std::acos(std::clamp(expected.normalized().dot(sightings[i].bearing_c), -1.0, 1.0)));
    }
    Found f{
        earlier, later, resected->T_w_c, resected->T_w_c * keyframes_[later].T_w_c.inverse(), upperMedian(distances),
        {}};
    f.pair = {timeOf(keyframes_[earlier]),
              timeOf(keyframes_[later]),
              static_cast<int>(places.size()),
              0,
              f.T_w_c,
              (f.T_w_c.p - keyframes_[later].T_w_c.p).norm(),
              logRotation(f.drift.q).norm(),
              upperMedian(apart) * camera_.meanFocal(),
              {},
              keyframes_[earlier].run,
              keyframes_[later].run};
    const double way_m = keyframes_[later].travelled_m - keyframes_[earlier].travelled_m;
    if (cellsWith(camera_, places) < params_.min_cells) f.pair.refusal = "its points cover little of the image";
    if (!f.pair.joinsRuns() && f.pair.drift_m > params_.max_drift_m + params_.max_drift_share * way_m)
      f.pair.refusal = "the odometry cannot have drifted so far";
    found_.push_back(f);
  }

  /// Over a visit the odometry's drift does not change.
  bool findSameDrift(const Found& a, const Found& b) const {
    if (a.pair.earlier_run != b.pair.earlier_run || a.pair.later_run != b.pair.later_run) return false;
    const Eigen::Vector3d& p = keyframes_[a.later].T_w_c.p;
    const double limit_m = kSameDrift_m + kSameDriftShare * std::max(a.distance_m, b.distance_m);
    return (a.drift * p - b.drift * p).norm() < limit_m &&
           logRotation(a.drift.q.conjugate() * b.drift.q).norm() < kSameDrift_rad;
  }

  void demandSupport() {
    for (Found& f : found_) {
      std::set<std::size_t> others;
      for (const Found& o : found_)
        if (o.later != f.later && std::abs(f.pair.later_ns - o.pair.later_ns) <= kVisit_ns && findSameDrift(f, o))
          others.insert(o.later);
      f.pair.support = static_cast<int>(others.size());
      if (f.pair.refusal.empty() && f.pair.support < params_.min_support)
        f.pair.refusal = "keyframes beside it do not find the same drift";
    }
  }

  std::vector<RunAlignment> align() {
    std::vector<RunPair> pairs;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Found& f = found_[i];
      if (!f.pair.joinsRuns() || !f.pair.refusal.empty()) continue;
      const PlaceKeyframe &earlier = keyframes_[f.earlier], &later = keyframes_[f.later];
      pairs.push_back({earlier.run,
                       later.run,
                       f.later,
                       f.drift,
                       later.T_w_c.p,
                       f.distance_m,
                       earlier.travelled_m,
                       later.travelled_m,
                       {}});
      places.push_back(i);
    }
    auto alignments = alignRuns(pairs, params_.min_support + 1,
                                [this](int earlier, int later, const Pose& T) { return canFollow(earlier, later, T); });
    for (std::size_t k = 0; k < pairs.size(); ++k) found_[places[k]].pair.refusal = pairs[k].refusal;
    return alignments;
  }

  /// Whether the flight can have come from the end of one run to the begin of the other.
  bool canFollow(int earlier, int later, const Pose& earlier_from_later) const {
    const PlaceKeyframe *end = nullptr, *begin = nullptr;
    double fastest_m_s = 0;
    for (std::size_t k = 0; k < keyframes_.size(); ++k) {
      const PlaceKeyframe& here = keyframes_[k];
      if (here.run == earlier) end = &here;
      if (here.run == later && !begin) begin = &here;
      if (k == 0 || keyframes_[k - 1].run != here.run) continue;
      const double dt_s = 1e-9 * static_cast<double>(timeOf(here) - timeOf(keyframes_[k - 1]));
      fastest_m_s = std::max(fastest_m_s, (here.T_w_c.p - keyframes_[k - 1].T_w_c.p).norm() / std::max(dt_s, 0.01));
    }
    if (!end || !begin || end->flight != begin->flight) return true;
    const double between_s = 1e-9 * static_cast<double>(timeOf(*begin) - timeOf(*end));
    const double way_m = begin->travelled_m - end->travelled_m + kFaster * fastest_m_s * between_s;
    return (earlier_from_later * begin->T_w_c.p - end->T_w_c.p).norm() <=
           way_m + params_.max_drift_m + params_.max_drift_share * begin->travelled_m;
  }

  std::vector<SamePoint> samePoints() const {
    std::map<std::pair<TrackId, TrackId>, int> votes;
    for (const Found& f : found_) {
      if (!f.pair.refusal.empty()) continue;
      const std::vector<LocalPoint> points = localPoints(keyframes_, f.earlier, kReach, points_w_);
      for (const SamePoint& s :
           matchByPose(camera_, points, *keyframes_[f.later].view, f.T_w_c, params_.max_error_px, params_.max_bits))
        if (s.earlier != s.later) ++votes[{s.earlier, s.later}];
    }
    std::vector<SamePoint> same;
    same.reserve(votes.size());
    for (const auto& [tracks, n] : votes) same.push_back({tracks.first, tracks.second, n});
    return same;
  }

  const Camera& camera_;
  const std::vector<PlaceKeyframe>& keyframes_;
  const std::unordered_map<TrackId, Eigen::Vector3d>& points_w_;
  const PlaceParams params_;
  WordIndex index_;
  std::vector<Found> found_;
};

}  // namespace

PlaceReport findPlaces(const Camera& camera, const std::vector<PlaceKeyframe>& keyframes,
                       const std::unordered_map<TrackId, Eigen::Vector3d>& points_w, const PlaceParams& params,
                       const std::function<bool(double)>& progress) {
  checkRanges(params, "loops.");
  return Search(camera, keyframes, points_w, params).run(progress);
}

}  // namespace lintel
