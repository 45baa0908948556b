// SPDX-License-Identifier: BSD-3-Clause
#include "FlowLineTracker.h"

#include <algorithm>

namespace lintel {
namespace {

constexpr double kSupportWithoutFlow = 0.7;  ///< an edge found without optical flow must be a clear one
constexpr double kSupportOfNew = 0.7;        ///< of a new line: there are more candidates than places
constexpr double kSlack = 1.5;               ///< of a jump's limit: the edge is not where optical flow ended
constexpr double kFade = 0.8;                ///< decay of a drift per frame: a mean over about five frames

// Pixels of the image, whatever the focal length: they are multiples of the error with which an edge is found.
constexpr double kEndNoise_px = 0.35;  ///< of an end across the line, from frame to frame
constexpr double kUsedDepth_px =
    1.0;                            ///< depths that predict the line less exactly are not used: three times the noise
constexpr double kMaxDrift_px = 4;  ///< a line that drifts further follows another edge: a dozen times the noise
constexpr double kJump_px = 2.5;    ///< so far from where it was expected a line must look as before
constexpr double kSame_px = 1.0;    ///< between two detections of one edge in the same image
constexpr double kWithoutFlow_px = 2;  ///< by which a line may be farther off when optical flow did not find it

}  // namespace

FlowLineTracker::FlowLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params)
    : params_(params),
      camera_(rig.camera, mask),
      detector_(camera_, params),
      flow_(camera_, params),
      merger_(camera_, params),
      steps_(camera_),
      refiner_(camera_) {}

void FlowLineTracker::process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
                              FrontEndStatistics& statistics) {
  followed_.clear();
  steps_.turn(gyro.R_c1_c0());
  if (pyramid.hasPrevious()) {
    StageTimer timer(statistics, "lines_flow");
    predict(pyramid, gyro, points, statistics.lines);
  }
  {
    StageTimer timer(statistics, "lines_refine");
    refine(pyramid, points.step, statistics.lines);
  }
  if (frames_since_detection_ == 0) {
    StageTimer timer(statistics, "lines_detect");
    const std::vector<ImageLine> fresh = mergeDetections(pyramid, statistics);
    dropDuplicates(statistics.lines);  // not more often: lines that touch for a frame or two separate again
    addNew(pyramid, fresh);
  }
  frames_since_detection_ = (frames_since_detection_ + 1) % params_.detect_every_n;
  publish(statistics.lines);
}

void FlowLineTracker::end(const Track& track, std::int64_t& reason, LineStatistics& statistics) const {
  if (track.id == 0) {
    ++statistics.lost_unconfirmed;
    return;
  }
  ++reason;
  statistics.lifetimes.add(track.length);
}

void FlowLineTracker::predict(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
                              LineStatistics& statistics) {
  std::vector<CarriedLine> lines;
  for (Track& track : tracks_) {
    if (track.motion) *track.motion *= gyro.stepRatio();
    lines.push_back({track.line, track.motion, track.depth});
  }
  const auto predicted = flow_.predict(lines, pyramid, gyro, points);
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track track = tracks_[i];
    if (!predicted[i] || predicted[i]->line.length() < params_.keep_length_px) {
      end(track, statistics.lost_view, statistics);
      continue;
    }
    track.line = predicted[i]->line;
    track.turned = predicted[i]->turned;
    track.expected = predicted[i]->expected;
    track.limit_px = predicted[i]->limit_px;
    track.typical_px = predicted[i]->typical_px;
    track.carried = predicted[i]->depth;
    track.by_flow = predicted[i]->by_flow;
    track.detected = false;
    if (!track.by_flow) ++statistics.flow_failed;
    ++track.undetected;
    kept.push_back(track);
  }
  tracks_ = std::move(kept);
}

std::vector<ImageLine> FlowLineTracker::mergeDetections(const ImagePyramid& pyramid, FrontEndStatistics& statistics) {
  const std::vector<ImageLine> detected = detector_.detect(pyramid);
  followed_ = steps_.followed(detected);
  std::vector<ImageLine> predicted;
  for (const Track& track : tracks_) predicted.push_back(track.line);
  MergedLines merged = merger_.merge(predicted, detected);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    tracks_[i].detected = merged.detections[i] > 0;
    if (!tracks_[i].detected) continue;
    extend(pyramid, merged.lines[i], tracks_[i]);
    tracks_[i].undetected = 0;
    ++tracks_[i].sightings;
  }
  statistics.lines.detections += static_cast<std::int64_t>(detected.size());
  statistics.lines.merged += static_cast<std::int64_t>(detected.size() - merged.fresh.size());
  return std::move(merged.fresh);
}

/// Moves a track to the edge that was found for it; false when motion or appearance are those of another edge.
bool FlowLineTracker::moveTo(const ImagePyramid& pyramid, const ImageLine& line, const StepTranslation& step,
                             Track& track) const {
  const Eigen::Vector2d deviation = normalMotion(track.expected, line);
  const double deviation_px = deviation.cwiseAbs().maxCoeff();
  if (track.motion && deviation_px > kSlack * track.limit_px) return false;
  const auto sides = sideLevels(camera_, pyramid.image(), line);
  if (track.motion && deviation_px > kJump_px && sides && track.sides && !maybeSameEdge(*sides, *track.sides))
    return false;
  if (sides) track.sides = sides;
  const double noise_px = std::max(kEndNoise_px, track.typical_px);
  if (track.carried) {
    const bool sure = track.carried->sigma_px.maxCoeff() < kUsedDepth_px;
    track.drift *= kFade;
    if (sure) track.drift += deviation * (kEndNoise_px / noise_px);
    if (track.drift.cwiseAbs().maxCoeff() > kMaxDrift_px) return false;
    const Eigen::Vector3d t = camera_.camera().wide() ? LineCamera::R_c_a(line.axis).transpose() * step.t_c1()
                                                      : step.t_c1();  // axes of the line's own camera
    track.depth = observe(*track.carried, track.turned, line, t, camera_.focal(), noise_px);
  } else {
    track.depth.reset();
    track.drift.setZero();
    if (step.typicalInverseDepth() > 0) track.depth = assumedDepth(step);
  }
  track.motion = normalMotion(track.turned, line);
  track.line = line;
  return true;
}

void FlowLineTracker::refine(const ImagePyramid& pyramid, const StepTranslation& step, LineStatistics& statistics) {
  std::vector<Track> kept;
  for (Track& track : tracks_) {
    // Without flow the prediction is worse, and the edge may lie further off.
    const double search_px = track.by_flow ? params_.refine_px : params_.refine_px + kWithoutFlow_px;
    const auto refined = refiner_.refine(pyramid, track.line, search_px, params_.grow_px);
    if (!refined || refined->line.length() < params_.keep_length_px ||
        (!track.by_flow && refined->support < kSupportWithoutFlow)) {
      end(track, statistics.lost_edge, statistics);
      continue;
    }
    if (track.undetected > params_.max_frames_without_detection) {
      end(track, statistics.lost_undetected, statistics);
      continue;
    }
    const auto clipped = camera_.clip(refined->line, params_.border_px);
    if (!clipped) {
      end(track, statistics.lost_view, statistics);
      continue;
    }
    if (!moveTo(pyramid, *clipped, step, track)) {
      end(track, statistics.lost_jump, statistics);
      continue;
    }
    track.sigma_px = refined->sigma_px;
    kept.push_back(track);
  }
  tracks_ = std::move(kept);
}

/// Takes what the detector adds to a line, if it is the same edge: where the line has been seen so far the longer one
/// must coincide with it, and beyond must lie within what its direction leaves open.
void FlowLineTracker::extend(const ImagePyramid& pyramid, const ImageLine& united, Track& track) const {
  if (united.length() < track.line.length() + params_.grow_px) return;
  const auto refined = refiner_.refine(pyramid, united, params_.refine_px, 0);
  if (!refined || refined->line.length() < track.line.length()) return;
  const auto clipped = camera_.clip(refined->line, params_.border_px);
  if (!clipped) return;
  const LineRelation own = relate(*clipped, track.line);
  if (own.distance_px > kSame_px || own.angle_rad > params_.merge_angle_rad) return;
  const double reach = clipped->length() / track.line.length();
  if (relate(track.line, *clipped).distance_px > kSame_px * reach) return;
  if (track.depth) track.depth = alongLine(*track.depth, track.line, *clipped);
  track.line = *clipped;
  track.sigma_px = refined->sigma_px;
  if (track.motion) track.motion = normalMotion(track.turned, track.line);
}

void FlowLineTracker::dropDuplicates(LineStatistics& statistics) {
  std::vector<char> dropped(tracks_.size(), 0);
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    for (std::size_t j = i + 1; j < tracks_.size() && !dropped[i]; ++j) {
      if (dropped[j] || !merger_.duplicates(tracks_[i].line, tracks_[j].line)) continue;
      dropped[j] = 1;  // the younger one
    }
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (dropped[i])
      end(tracks_[i], statistics.lost_duplicate, statistics);
    else
      kept.push_back(tracks_[i]);
  }
  tracks_ = std::move(kept);
}

void FlowLineTracker::addNew(const ImagePyramid& pyramid, const std::vector<ImageLine>& fresh) {
  for (const ImageLine& candidate : fresh) {  // longest first
    if (static_cast<int>(tracks_.size()) >= params_.max_lines) return;
    if (candidate.length() < params_.min_length_px) continue;
    const auto known = [&](const ImageLine& line) {
      return std::any_of(tracks_.begin(), tracks_.end(),
                         [&](const Track& track) { return merger_.duplicates(track.line, line); });
    };
    if (known(candidate)) continue;
    const auto refined = refiner_.refine(pyramid, candidate, params_.refine_px, params_.grow_px);
    if (!refined || refined->support < kSupportOfNew) continue;
    const auto clipped = camera_.clip(refined->line, params_.border_px);
    if (!clipped || clipped->length() < params_.min_length_px) continue;
    if (known(*clipped)) continue;
    Track track;
    track.line = *clipped;
    track.sigma_px = refined->sigma_px;
    tracks_.push_back(track);
  }
}

void FlowLineTracker::publish(LineStatistics& statistics) {
  observations_.clear();
  for (Track& track : tracks_) {
    if (track.id == 0) {
      if (track.sightings < params_.sightings_before_use) continue;
      track.id = next_id_++;
      ++statistics.created;
    } else {
      ++statistics.tracked;
      statistics.tracked_detected += track.detected;
    }
    ++track.length;
    observations_.push_back(
        lineObservation(camera_, track.id, track.line, track.sigma_px, track.length, track.detected));
  }
  std::sort(observations_.begin(), observations_.end(),
            [](const LineObservation& a, const LineObservation& b) { return a.id < b.id; });
}

}  // namespace lintel
