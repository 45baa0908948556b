// SPDX-License-Identifier: BSD-3-Clause
#include "PointTracker.h"

#include <algorithm>
#include <cmath>

#include "DistanceGrid.h"
#include "PatchFlow.h"

namespace lintel {
namespace {

constexpr double kPointSettled_px = 0.03;  ///< a smaller step ends optical flow: PatchAnchors places old points exactly
constexpr double kPointTexture = 0.1;      ///< patches with less are lost: far below a corner [grey levels^2/px^2]
constexpr int kSteadyLevels = 2;           ///< of the pyramid for points whose motion is known: 10 px of change
constexpr int kFailures = 3;      ///< to be found as its patch, in a row, that a track survives: blur, short occlusions
constexpr int kFailuresWide = 1;  ///< through a wide lens a patch is distorted as it moves, and what flow finds slides
constexpr int kBackwardLevels = 1;   ///< of the pyramid for tracking back, which starts at the result
constexpr int kProven = 5;           ///< frames after which a point that matches its patch is not tracked back
constexpr double kCrowded = 0.5;     ///< of the distance that new points keep: tracks may approach, but not coincide
constexpr int kInliersForGyro = 15;  ///< with fewer their rotation does not correct that of the gyroscope
constexpr int kInliersForDirection = 10;  ///< of a translation

TwoViewParams twoViewParams(const Camera& camera, double threshold_px) {
  TwoViewParams params;
  params.focal_px = camera.meanFocal();
  params.threshold_px = threshold_px;
  params.wide = camera.wide();
  return params;
}

}  // namespace

PointTracker::PointTracker(const Rig& rig, const ImageMask& mask, const PointTrackerParams& params)
    : camera_(rig.camera),
      mask_(mask),
      params_(params),
      detector_(mask_, params),
      drift_(params.drift_frames, twoViewParams(rig.camera, params.drift_px)),
      anchors_(rig.camera.wide() ? kFailuresWide : kFailures),
      step_(rig.camera.meanFocal(), rig.camera.wide()) {}

bool PointTracker::mayBeAt(const cv::Point2f& px) const {
  return camera_.contains({px.x, px.y}, params_.border_px) && !mask_.covers({px.x, px.y});
}

PatchFlowParams PointTracker::flowParams(int levels) const {
  return {params_.window_px, levels, params_.max_iterations, kPointSettled_px, kPointTexture};
}

std::vector<cv::Point2f> PointTracker::pixels() const {
  std::vector<cv::Point2f> px;
  px.reserve(points_.size());
  for (const PointObservation& p : points_) px.emplace_back(static_cast<float>(p.px.x()), static_cast<float>(p.px.y()));
  return px;
}

void PointTracker::process(const ImagePyramid& pyramid, GyroPrediction& gyro, FrontEndStatistics& statistics) {
  flow_.clear();
  followed_.clear();
  turn_.reset();
  if (pyramid.hasPrevious() && !points_.empty()) {
    StageTimer timer(statistics, "points_klt");
    Followed followed = follow(pyramid, gyro, statistics.points);
    noteFollowed(followed, gyro);
    startAnchors(pyramid, followed);
    rejectByEpipolarGeometry(followed, gyro, statistics.points);
    rejectCrowded(followed, statistics.points);
    accept(followed, gyro, statistics.points);
    rejectDrifting(gyro, statistics.points);
  }
  if (++frames_since_detection_ >= params_.detect_every_n ||
      points_.size() * 3 < static_cast<std::size_t>(params_.max_points)) {
    StageTimer timer(statistics, "points_detect");
    addNew(pyramid, statistics.points);
    frames_since_detection_ = 0;
  }
  anchors_.keepOnly(points_);
}

void PointTracker::followFrom(const ImagePyramid& pyramid, const std::vector<std::size_t>& indices, int levels,
                              Followed& followed) {
  if (indices.empty()) return;
  std::vector<cv::Point2f> from, to;
  for (const std::size_t i : indices) {
    from.emplace_back(static_cast<float>(points_[i].px.x()), static_cast<float>(points_[i].px.y()));
    to.push_back(followed.px[i]);
  }
  const std::vector<unsigned char> found =
      followPatches(pyramid.previous(), pyramid.current(), from, flowParams(levels), to);
  const auto align = [&](std::size_t i) { return anchors_.align(points_[i].id, pyramid.image(), followed.px[i]); };
  std::vector<std::size_t> unsure, young;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const std::size_t i = indices[k];
    followed.px[i] = to[k];
    followed.outcome[i] = Outcome::kLost;
    if (!found[k] || !mayBeAt(to[k])) continue;
    const bool is_young = points_[i].track_length < kProven;
    const AnchorVerdict verdict = is_young ? AnchorVerdict::kUnsure : align(i);
    if (is_young) young.push_back(i);
    if (verdict == AnchorVerdict::kHeld) followed.outcome[i] = Outcome::kTracked;
    if (verdict == AnchorVerdict::kUnsure) unsure.push_back(i);
  }
  followBack(pyramid, unsure, followed);
  for (const std::size_t i : young)
    if (followed.outcome[i] == Outcome::kTracked && align(i) == AnchorVerdict::kLost)
      followed.outcome[i] = Outcome::kLost;
}

void PointTracker::followBack(const ImagePyramid& pyramid, const std::vector<std::size_t>& indices,
                              Followed& followed) const {
  if (indices.empty()) return;
  std::vector<cv::Point2f> from, to;
  for (const std::size_t i : indices) {
    from.push_back(followed.px[i]);
    to.emplace_back(static_cast<float>(points_[i].px.x()), static_cast<float>(points_[i].px.y()));
  }
  const std::vector<cv::Point2f> before = to;
  const std::vector<unsigned char> found =
      followPatches(pyramid.current(), pyramid.previous(), from, flowParams(kBackwardLevels), to);
  for (std::size_t k = 0; k < indices.size(); ++k)
    followed.outcome[indices[k]] = found[k] && cv::norm(to[k] - before[k]) <= params_.forward_backward_px
                                       ? Outcome::kTracked
                                       : Outcome::kNotReturned;
}

PointTracker::Followed PointTracker::follow(const ImagePyramid& pyramid, const GyroPrediction& gyro,
                                            PointStatistics& statistics) {
  Followed followed;
  followed.outcome.assign(points_.size(), Outcome::kLost);
  for (auto& residual : residuals_) residual.second *= gyro.stepRatio();
  std::vector<std::size_t> steady, others;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    followed.px.push_back(gyro.turnedPixel(camera_, points_[i].ray));
    const auto before = residuals_.find(points_[i].id);
    (before == residuals_.end() ? others : steady).push_back(i);
    if (before != residuals_.end()) followed.px[i] += before->second;
  }
  // Points that move as before need few levels; new points and those that were not found use all.
  followFrom(pyramid, steady, kSteadyLevels, followed);
  for (const std::size_t i : steady)
    if (followed.outcome[i] != Outcome::kTracked) {
      followed.px[i] = gyro.turnedPixel(camera_, points_[i].ray);
      others.push_back(i);
    }
  followFrom(pyramid, others, pyramid.levels(), followed);
  for (const Outcome outcome : followed.outcome) {
    statistics.lost_klt += outcome == Outcome::kLost;
    statistics.lost_backward += outcome == Outcome::kNotReturned;
  }
  return followed;
}

void PointTracker::noteFollowed(const Followed& followed, const GyroPrediction& gyro) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (followed.outcome[i] != Outcome::kTracked) continue;
    const cv::Point2f from(static_cast<float>(points_[i].px.x()), static_cast<float>(points_[i].px.y()));
    followed_.push_back({from, followed.px[i], gyro.turnedPixel(camera_, points_[i].ray)});
  }
}

void PointTracker::startAnchors(const ImagePyramid& pyramid, const Followed& followed) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (followed.outcome[i] == Outcome::kTracked && !anchors_.has(points_[i].id))
      anchors_.add(points_[i].id, pyramid.image(), followed.px[i]);
}

void PointTracker::rejectByEpipolarGeometry(Followed& followed, GyroPrediction& gyro, PointStatistics& statistics) {
  std::vector<TwoViewPair> pairs;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (followed.outcome[i] != Outcome::kTracked) continue;
    pairs.push_back({points_[i].ray, camera_.ray({followed.px[i].x, followed.px[i].y})});
    index.push_back(i);
  }
  turn_ = turnOfPoints(pairs, twoViewParams(camera_, params_.epipolar_px));  // before the gyroscope chooses among them
  const TwoViewMotion motion =
      twoViewMotion(pairs, gyro.R_c1_c0(), gyro.information(), twoViewParams(camera_, params_.epipolar_px));
  for (std::size_t k = 0; k < index.size(); ++k)
    if (!motion.inlier[k]) {
      followed.outcome[index[k]] = Outcome::kLost;
      ++statistics.lost_epipolar;
    }
  // No epipolar geometry fits half of the points: the scene moves or the images are bad; the gyroscope's bias is not
  // estimated from them.
  if (motion.inliers >= kInliersForGyro && 2 * static_cast<std::size_t>(motion.inliers) > pairs.size())
    gyro.correct(motion.delta, motion.information);
  std::vector<StepTranslation::Pair> inliers;
  for (std::size_t k = 0; k < index.size(); ++k)
    if (motion.inlier[k]) inliers.push_back({points_[index[k]].id, pairs[k].x0, pairs[k].x1});
  const bool known =
      motion.inliers >= kInliersForDirection && 2 * static_cast<std::size_t>(motion.inliers) > pairs.size();
  step_.update(inliers, gyro.R_c1_c0(), known ? std::make_optional(motion.direction) : std::nullopt);
}

void PointTracker::rejectCrowded(Followed& followed, PointStatistics& statistics) const {
  // Ids ascend, so that the older one stays.
  DistanceGrid occupied(camera_.width, camera_.height, kCrowded * params_.min_distance_px);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (followed.outcome[i] != Outcome::kTracked) continue;
    if (occupied.isFree(followed.px[i])) {
      occupied.insert(followed.px[i]);
    } else {
      followed.outcome[i] = Outcome::kLost;
      ++statistics.lost_crowded;
    }
  }
}

void PointTracker::accept(const Followed& followed, const GyroPrediction& gyro, PointStatistics& statistics) {
  std::vector<PointObservation> kept;
  std::map<TrackId, cv::Point2f> residuals;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (followed.outcome[i] != Outcome::kTracked) {
      statistics.lifetimes.add(points_[i].track_length);
      continue;
    }
    PointObservation p = points_[i];
    PointFlow flow{followed.px[i], followed.px[i] - gyro.turnedPixel(camera_, p.ray), std::nullopt};
    if (const auto before = residuals_.find(p.id); before != residuals_.end())
      flow.change = flow.residual - before->second;
    residuals[p.id] = flow.residual;
    flow_.push_back(flow);
    p.px = {followed.px[i].x, followed.px[i].y};
    p.ray = camera_.ray(p.px);
    ++p.track_length;
    kept.push_back(p);
  }
  statistics.tracked += static_cast<std::int64_t>(kept.size());
  points_ = std::move(kept);
  residuals_ = std::move(residuals);
}

void PointTracker::rejectDrifting(const GyroPrediction& gyro, PointStatistics& statistics) {
  drift_.push(points_, gyro.R_c1_c0());
  const std::vector<TrackId> drifting = drift_.drifting();
  if (drifting.empty()) return;
  std::vector<PointObservation> kept;
  for (const PointObservation& p : points_) {
    if (!std::binary_search(drifting.begin(), drifting.end(), p.id)) {
      kept.push_back(p);
      continue;
    }
    ++statistics.lost_drift;
    statistics.lifetimes.add(p.track_length - 1);
  }
  points_ = std::move(kept);
}

void PointTracker::addNew(const ImagePyramid& pyramid, PointStatistics& statistics) {
  const int wanted = params_.max_points - static_cast<int>(points_.size());
  for (const cv::Point2f& px : detector_.detect(pyramid, pixels(), wanted)) {
    PointObservation p;
    p.id = next_id_++;
    p.px = {px.x, px.y};
    p.ray = camera_.ray(p.px);
    anchors_.add(p.id, pyramid.image(), px);
    points_.push_back(p);
    ++statistics.detected;
  }
}

}  // namespace lintel
