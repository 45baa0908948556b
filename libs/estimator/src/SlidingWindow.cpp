// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/SlidingWindow.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

namespace lintel {

SlidingWindow::SlidingWindow(const Rig& rig) : extrinsics(toBlock(rig.T_b_c)), camera_(rig.camera) {}

PinholeRadtan SlidingWindow::correctedCamera() const {
  PinholeRadtan c = camera_;
  c.fx += correction[0];
  c.fy += correction[1];
  c.cx += correction[2];
  c.cy += correction[3];
  c.k1 += correction[4];
  c.k2 += correction[5];
  return c;
}

bool SlidingWindow::contains(FrameId id) const {
  return std::any_of(frames.begin(), frames.end(), [id](const WindowFrame& f) { return f.id == id; });
}

const WindowFrame& SlidingWindow::frame(FrameId id) const {
  for (const WindowFrame& f : frames)
    if (f.id == id) return f;
  throw std::out_of_range("SlidingWindow: no frame " + std::to_string(id));
}

WindowFrame& SlidingWindow::frame(FrameId id) { return const_cast<WindowFrame&>(std::as_const(*this).frame(id)); }

double* SlidingWindow::block(const BlockKey& key) {
  switch (key.kind) {
    case BlockKey::kPose: return frame(key.id).pose.data();
    case BlockKey::kMotion: return frame(key.id).motion.data();
    case BlockKey::kExtrinsics: return extrinsics.data();
    case BlockKey::kCorrection: return correction.data();
    case BlockKey::kDepth: return &points.at(key.id).inverse_depth;
    case BlockKey::kLine: return lines.at(key.id).line.data();
  }
  throw std::out_of_range("SlidingWindow: unknown kind of block");
}

void SlidingWindow::addFrame(WindowFrame frame, const FrameTracks& tracks, const FeatureVelocities& velocities) {
  for (const PointObservation& o : tracks.points) {
    PointTrack& track = points[o.id];
    track.id = o.id;
    track.sightings.push_back({frame.id, makeObservation(camera_, o.normalised, velocities.point(o.id)), o.px});
  }
  for (const LineObservation& o : tracks.lines) {
    LineTrack& track = lines[o.id];
    track.id = o.id;
    track.sightings.push_back({frame.id, makeObservation(camera_, o.start, velocities.lineStart(o.id)),
                               makeObservation(camera_, o.end, velocities.lineEnd(o.id)), o.start_px, o.end_px,
                               o.sigma_px, o.detected});
  }
  frames.push_back(std::move(frame));
}

void SlidingWindow::removeFrame(FrameId id, bool keyframe) {
  for (auto& [point_id, track] : points) {
    auto it = std::find_if(track.sightings.begin(), track.sightings.end(),
                           [id](const PointSighting& s) { return s.frame == id; });
    if (it == track.sightings.end()) continue;
    if (it == track.sightings.begin() && track.triangulated && track.sightings.size() > 1) {
      const PointSighting& next = track.sightings[1];
      track.inverse_depth = transferredInverseDepth(track, T_w_c(this->frame(id)), T_w_c(this->frame(next.frame)),
                                                    it->observation.corrected(correction.data()));
    }
    if (keyframe) track.former.push_back(*it);
    track.sightings.erase(it);
  }
  for (auto& [line_id, track] : lines) {
    auto it = std::find_if(track.sightings.begin(), track.sightings.end(),
                           [id](const LineSighting& s) { return s.frame == id; });
    if (it == track.sightings.end()) continue;
    if (keyframe) track.former.push_back(*it);
    track.sightings.erase(it);
  }
  frames.erase(std::find_if(frames.begin(), frames.end(), [id](const WindowFrame& f) { return f.id == id; }));
}

double SlidingWindow::transferredInverseDepth(const PointTrack& track, const Pose& T_w_c_old, const Pose& T_w_c_new,
                                              const Eigen::Vector2d& x_old) {
  const double lambda = std::max(track.inverse_depth, 1e-4);
  const Eigen::Vector3d p_c = T_w_c_new.inverse() * (T_w_c_old * (x_old.homogeneous() / lambda));
  return p_c.z() > 1e-3 ? 1.0 / p_c.z() : track.inverse_depth;
}

Eigen::Vector3d SlidingWindow::positionOf(const PointTrack& track) const {
  const PointSighting& host = track.sightings.front();
  const Eigen::Vector3d ray = host.observation.corrected(correction.data()).homogeneous();
  return T_w_c(frame(host.frame)) * (ray / std::max(track.inverse_depth, 1e-4));
}

FeatureVelocities::FeatureVelocities(const FrameTracks& before, const FrameTracks& now) {
  const double dt = 1e-9 * static_cast<double>(now.t_ns - before.t_ns);
  if (dt <= 0) return;
  std::map<TrackId, const PointObservation*> old_points;
  for (const PointObservation& o : before.points) old_points[o.id] = &o;
  for (const PointObservation& o : now.points)
    if (auto it = old_points.find(o.id); it != old_points.end())
      points_[o.id] = (o.normalised - it->second->normalised) / dt;
  std::map<TrackId, const LineObservation*> old_lines;
  for (const LineObservation& o : before.lines) old_lines[o.id] = &o;
  for (const LineObservation& o : now.lines) {
    auto it = old_lines.find(o.id);
    if (it == old_lines.end()) continue;
    // End points may slide along the line from frame to frame: only the motion across it is meant.
    const Eigen::Vector2d direction = (o.end - o.start).normalized(), normal(-direction.y(), direction.x());
    const Eigen::Vector2d old_direction = (it->second->end - it->second->start).normalized();
    const auto across = [&](const Eigen::Vector2d& end) -> Eigen::Vector2d {
      const Eigen::Vector2d offset = end - it->second->start;
      const double old_distance = old_direction.x() * offset.y() - old_direction.y() * offset.x();
      return normal * old_distance / dt;
    };
    starts_[o.id] = across(o.start);
    ends_[o.id] = across(o.end);
  }
}

namespace {
Eigen::Vector2d findOrZero(const std::map<TrackId, Eigen::Vector2d>& map, TrackId id) {
  const auto it = map.find(id);
  return it == map.end() ? Eigen::Vector2d::Zero() : it->second;
}
}  // namespace

Eigen::Vector2d FeatureVelocities::point(TrackId id) const { return findOrZero(points_, id); }
Eigen::Vector2d FeatureVelocities::lineStart(TrackId id) const { return findOrZero(starts_, id); }
Eigen::Vector2d FeatureVelocities::lineEnd(TrackId id) const { return findOrZero(ends_, id); }

NormalisedObservation makeObservation(const PinholeRadtan& camera, const Eigen::Vector2d& normalised,
                                      const Eigen::Vector2d& velocity) {
  NormalisedObservation o;
  o.position = normalised;
  const Eigen::Vector2d distorted = camera.distort(normalised);
  const double r2 = normalised.squaredNorm();
  // distort(x) = (px - c) / f: both sides differentiated
  Eigen::Matrix<double, 2, 6> d_distorted;
  d_distorted << -distorted.x() / camera.fx, 0, -1 / camera.fx, 0, -normalised.x() * r2, -normalised.x() * r2 * r2, 0,
      -distorted.y() / camera.fy, 0, -1 / camera.fy, -normalised.y() * r2, -normalised.y() * r2 * r2;
  o.correction_jacobian.leftCols<6>() = camera.distortJacobian(normalised).inverse() * d_distorted;
  o.correction_jacobian.col(kTimeOffsetAt) = -velocity;
  return o;
}

}  // namespace lintel
