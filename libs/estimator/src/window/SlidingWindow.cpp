// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/SlidingWindow.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace lintel {

void WindowFrame::joinInterval(const WindowFrame& before) {
  auto joined = std::make_shared<Preintegration>(*before.imu);
  joined->append(*imu);
  imu = std::move(joined);
  still = still && before.still;
}

SlidingWindow::SlidingWindow(const Rig& rig)
    : extrinsics(toBlock(rig.T_b_c)),
      camera_(rig.camera),
      given_readout_s_(rig.readout_s()),
      gravity_m_s2_(rig.gravity_m_s2) {}

Camera SlidingWindow::correctedCamera() const { return lintel::correctedCamera(camera_, correction.data()); }

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
    case BlockKey::kPose:
      return frame(key.id).pose.data();
    case BlockKey::kMotion:
      return frame(key.id).motion.data();
    case BlockKey::kExtrinsics:
      return extrinsics.data();
    case BlockKey::kCorrection:
      return correction.data();
    case BlockKey::kMeanBias:
      return mean_bias.data();
    case BlockKey::kAxes:
      return axes.data();
    case BlockKey::kDirection:
      return directions.at(key.id).d_w.data();
    case BlockKey::kPoint:
      return points.at(key.id).point.data();
    case BlockKey::kLine:
      return lines.at(key.id).line.data();
  }
  throw std::out_of_range("SlidingWindow: unknown kind of block");
}

void SlidingWindow::addFrame(WindowFrame frame, const FrameTracks& tracks) {
  for (const PointObservation& o : tracks.points) {
    PointTrack& track = points[o.id];
    track.id = o.id;
    track.sightings.push_back({frame.id, makeObservation(camera_, o.px, linearised_at_), o.px, o.px});
  }
  for (const LineObservation& o : tracks.lines) {
    LineTrack& track = lines[o.id];
    track.id = o.id;
    const auto [start, end] = makeLineEnds(camera_, o.start_px, o.end_px, linearised_at_);
    track.sightings.push_back({frame.id, start, end, o.start_px, o.end_px, o.sigma_px, o.start_px, o.end_px});
  }
  frames.push_back(std::move(frame));
  for (std::size_t i = frames.size() - std::min<std::size_t>(frames.size(), 2); i < frames.size(); ++i)
    if (const auto imu = imuAtFrame(i)) frames[i].gyro = imu->gyro;
}

std::optional<ImuAt> SlidingWindow::imuAtFrame(std::size_t i, double reach_s) const {
  return imuAt(frames[i].imu.get(), i + 1 < frames.size() ? frames[i + 1].imu.get() : nullptr, reach_s);
}

void SlidingWindow::relinearise() {
  CorrectionBlock small;  // what the observations are linear within, to 0.05 px in the corners of EuRoC's images
  const double px = 0.0005 * camera_.meanFocal(), distortion = 0.00075;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  small << px, px, px, px, distortion, distortion, kAny, kAny;
  if (((correction - linearised_at_).cwiseAbs().array() <= small.array()).all()) return;
  linearised_at_ = correction;
  const auto renewPoint = [&](PointSighting& s) { s.observation = makeObservation(camera_, s.px, linearised_at_); };
  const auto renewLine = [&](LineSighting& s) {
    std::tie(s.start, s.end) = makeLineEnds(camera_, s.start_px, s.end_px, linearised_at_);
  };
  for (auto& [id, track] : points) {
    std::for_each(track.sightings.begin(), track.sightings.end(), renewPoint);
  }
  for (auto& [id, track] : lines) {
    std::for_each(track.sightings.begin(), track.sightings.end(), renewLine);
  }
}

void SlidingWindow::removeFrame(FrameId id, bool keyframe) {
  for (auto& [point_id, track] : points) {
    auto it = std::find_if(track.sightings.begin(), track.sightings.end(),
                           [id](const PointSighting& s) { return s.frame == id; });
    if (it == track.sightings.end()) continue;
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

Eigen::Vector3d SlidingWindow::positionOf(const PointTrack& track) const {
  constexpr double kLeast = 1e-6;  // of the homogeneous coordinate: a point farther away is at infinity
  return track.origin_w + track.point.head<3>() / std::max(track.point[3], kLeast);
}

}  // namespace lintel
