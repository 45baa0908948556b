// SPDX-License-Identifier: BSD-3-Clause
#include "MapTimes.h"

#include <algorithm>
#include <memory>

#include "lintel/inertial/Preintegration.h"

namespace lintel {

namespace {

constexpr std::int64_t kBetween_ns = 100'000'000'000;

/// The sum, whatever a damaged map says of a landmark's times.
std::int64_t moved(std::int64_t t_ns, std::int64_t by_ns) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(t_ns) + static_cast<std::uint64_t>(by_ns));
}

std::shared_ptr<const Preintegration> moved(const Preintegration& imu, std::int64_t by_ns) {
  ImuBatch samples = imu.samples();
  for (ImuSample& sample : samples) sample.t_ns = moved(sample.t_ns, by_ns);
  auto result = std::make_shared<Preintegration>(imu.bias(), imu.noise());
  result->append(samples);
  return result;
}

}  // namespace

std::vector<std::int64_t> timesBehindOneAnother(const std::vector<MapPiece>& pieces) {
  std::vector<std::pair<std::int64_t, std::int64_t>> spans;  // by recording
  for (const MapPiece& piece : pieces) {
    const auto at = static_cast<std::size_t>(piece.recording);
    if (at >= spans.size()) spans.resize(at + 1, {INT64_MAX, INT64_MIN});
    spans[at].first = std::min(spans[at].first, piece.first_ns);
    spans[at].second = std::max(spans[at].second, piece.last_ns);
  }
  std::vector<std::int64_t> by_ns(spans.size(), 0);
  for (std::size_t i = 1; i < spans.size(); ++i) {
    if (spans[i].first > spans[i].second || spans[i - 1].first > spans[i - 1].second) continue;
    by_ns[i] = spans[i - 1].second + by_ns[i - 1] + kBetween_ns - spans[i].first;
  }
  return by_ns;
}

void moveTimes(const std::vector<std::int64_t>& by_ns, LineMap& map) {
  const auto ofPiece = [&](std::size_t piece) { return by_ns[static_cast<std::size_t>(map.pieces[piece].recording)]; };
  const auto ofKeyframe = [&](std::uint64_t id) { return ofPiece(pieceOf(map.pieces, id)); };
  for (MapKeyframe& keyframe : map.keyframes) {
    const std::int64_t by = ofKeyframe(keyframe.id);
    keyframe.t_ns += by;
    if (keyframe.imu && by != 0) keyframe.imu = moved(*keyframe.imu, by);
  }
  const auto moveSeen = [&](auto& landmark) {
    if (landmark.observations.empty()) return;
    landmark.first_t_ns = moved(landmark.first_t_ns, ofKeyframe(landmark.observations.front().keyframe_id));
    landmark.last_t_ns = moved(landmark.last_t_ns, ofKeyframe(landmark.observations.back().keyframe_id));
  };
  for (MapPoint& point : map.points) moveSeen(point);
  for (MapLine& line : map.lines) moveSeen(line);
  for (MapView& view : map.views) view.looks.t_ns += ofPiece(static_cast<std::size_t>(view.piece));
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const auto [from, to] = posesOf(map.pieces, p, map.trajectory.size());
    for (std::size_t i = from; i < to; ++i) map.trajectory[i].first += ofPiece(p);
    map.pieces[p].first_ns += ofPiece(p), map.pieces[p].last_ns += ofPiece(p);
  }
}

}  // namespace lintel
