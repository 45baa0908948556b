// SPDX-License-Identifier: BSD-3-Clause
#include "FourStepLineTracker.h"

#include <algorithm>

namespace lintel {
namespace {

constexpr double kBits = 256;  ///< of a descriptor

}  // namespace

FourStepLineTracker::FourStepLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params)
    : params_(params),
      camera_(rig.camera, mask),
      detector_(camera_, params),
      matcher_(camera_, params),
      flow_(camera_, params),
      merger_(camera_, params) {}

void FourStepLineTracker::process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
                                  FrontEndStatistics& statistics) {
  StageTimer timer(statistics, "lines_four_steps");
  LineStatistics& counts = statistics.lines;
  const std::vector<ImageLine> lines = detector_.detectLong(pyramid);
  counts.detections += static_cast<std::int64_t>(lines.size());
  std::vector<std::optional<Place>> predicted(tracks_.size());
  const std::vector<Place> detected = describe(pyramid, lines, predict(pyramid, gyro, points, counts), predicted);

  std::vector<char> taken(detected.size(), 0);
  std::vector<Track> tracks = merge(detected, match(detected, gyro), predicted, taken, counts);
  addNew(detected, taken, tracks, counts);
  tracks_ = std::move(tracks);

  observations_.clear();
  for (const Track& track : tracks_)
    observations_.push_back(
        lineObservation(camera_, track.id, track.line, LineDetector::kSigma_px, track.length, track.undetected == 0));
}

std::vector<std::optional<ImageLine>> FourStepLineTracker::predict(const ImagePyramid& pyramid,
                                                                   const GyroPrediction& gyro,
                                                                   const PointMotion& points,
                                                                   LineStatistics& statistics) const {
  std::vector<std::optional<ImageLine>> lines(tracks_.size());
  if (!pyramid.hasPrevious()) return lines;
  std::vector<CarriedLine> carried;
  for (const Track& track : tracks_) carried.push_back({track.line, {}, {}});
  const auto predicted = flow_.predict(carried, pyramid, gyro, points);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!predicted[i]) continue;
    if (!predicted[i]->by_flow)
      ++statistics.flow_failed;
    else if (predicted[i]->line.length() >= params_.keep_length_px)
      lines[i] = predicted[i]->line;
  }
  return lines;
}

std::vector<FourStepLineTracker::Place> FourStepLineTracker::describe(
    const ImagePyramid& pyramid, const std::vector<ImageLine>& detected,
    const std::vector<std::optional<ImageLine>>& predicted, std::vector<std::optional<Place>>& places) const {
  std::vector<ImageLine> all = detected;
  for (const auto& line : predicted)
    if (line) all.push_back(*line);
  const cv::Mat descriptors = matcher_.describe(pyramid.image(), all);
  int row = 0;
  std::vector<Place> described;
  described.reserve(detected.size());
  for (const ImageLine& line : detected) described.push_back({line, descriptors.row(row++)});
  for (std::size_t i = 0; i < predicted.size(); ++i)
    if (predicted[i]) places[i] = Place{*predicted[i], descriptors.row(row++)};
  return described;
}

std::vector<std::optional<std::size_t>> FourStepLineTracker::match(const std::vector<Place>& detected,
                                                                   const GyroPrediction& gyro) const {
  std::vector<ImageLine> expected, lines;
  cv::Mat from, to;
  for (const Track& track : tracks_) {
    expected.push_back(camera_.turned(track.line, gyro.R_c1_c0()));
    from.push_back(track.descriptor);
  }
  for (const Place& place : detected) {
    lines.push_back(place.line);
    to.push_back(place.descriptor);
  }
  return matcher_.match(expected, from, lines, to);
}

double FourStepLineTracker::score(const Track& track, const Place& place) const {
  const double agreement = 1 - LineMatcher::distance(track.descriptor, place.descriptor) / kBits;
  return agreement * std::min(1.0, place.line.length() / track.line.length());
}

std::vector<FourStepLineTracker::Track> FourStepLineTracker::merge(
    const std::vector<Place>& detected, const std::vector<std::optional<std::size_t>>& matches,
    const std::vector<std::optional<Place>>& predicted, std::vector<char>& taken, LineStatistics& statistics) const {
  std::vector<std::optional<std::size_t>> match_of(tracks_.size());
  for (std::size_t d = 0; d < detected.size(); ++d)
    if (matches[d]) match_of[*matches[d]] = d;

  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track track = tracks_[i];
    const Place* place = nullptr;
    // A prediction that does not look like the line any more is on another edge.
    if (predicted[i] &&
        LineMatcher::distance(track.descriptor, predicted[i]->descriptor) <= params_.descriptor_distance &&
        track.undetected < params_.max_frames_without_detection)
      place = &*predicted[i];
    const bool matched = match_of[i] && (!place || score(track, detected[*match_of[i]]) >= score(track, *place));
    if (matched) {
      place = &detected[*match_of[i]];
      taken[*match_of[i]] = 1;
    }
    const bool duplicate = place && std::any_of(kept.begin(), kept.end(), [&](const Track& older) {
                             return merger_.duplicates(older.line, place->line);
                           });
    if (!place || duplicate) {
      ++(duplicate ? statistics.lost_duplicate : statistics.lost_unmatched);
      statistics.lifetimes.add(track.length);
      continue;
    }
    track.line = place->line;
    track.descriptor = place->descriptor;
    track.undetected = matched ? 0 : track.undetected + 1;
    ++track.length;
    ++statistics.tracked;
    statistics.tracked_detected += matched;
    kept.push_back(track);
  }
  return kept;
}

void FourStepLineTracker::addNew(const std::vector<Place>& detected, const std::vector<char>& taken,
                                 std::vector<Track>& tracks, LineStatistics& statistics) {
  const std::size_t old = tracks.size();
  for (std::size_t d = 0; d < detected.size(); ++d) {
    if (taken[d]) continue;
    const bool known = std::any_of(tracks.begin(), tracks.begin() + static_cast<std::ptrdiff_t>(old),
                                   [&](const Track& t) { return merger_.score(t.line, detected[d].line) > 0; });
    if (known) {  // a piece of a line that its prediction has replaced
      ++statistics.merged;
      continue;
    }
    if (static_cast<int>(tracks.size()) >= params_.max_lines) continue;
    Track track;
    track.id = next_id_++;
    track.line = detected[d].line;
    track.descriptor = detected[d].descriptor;
    tracks.push_back(track);
    ++statistics.created;
  }
}

}  // namespace lintel
