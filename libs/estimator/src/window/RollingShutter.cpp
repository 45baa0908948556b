// SPDX-License-Identifier: BSD-3-Clause
#include "window/RollingShutter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "lintel/core/Quantiles.h"
#include "lintel/factors/RowMotion.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/PluckerLine.h"

namespace lintel {
namespace {

constexpr double kShort_s = 0.001;  ///< the residuals' first order is enough for shorter ones
constexpr double kSame_px = 0.01;   ///< a sighting that moves by less is left as it is: far below its noise

/// The camera during one image.
struct MovingCamera {
  Pose T_w_c;
  RowMotion rows;
};

class Unroller {
 public:
  explicit Unroller(SlidingWindow& window) : window_(window), camera_(window.correctedCamera()) {
    const Pose T_b_c = window.T_b_c();
    for (std::size_t i = 0; i < window.frames.size(); ++i) {
      const WindowFrame& frame = window.frames[i];
      cameras_.emplace(frame.id, MovingCamera{window.T_w_c(frame), RowMotion(T_b_c, frame.bodyMotion(), changeAt(i))});
    }
    usual_inverse_distance_ = usualInverseDistance();
  }

  void points() {
    for (auto& [id, track] : window_.points)
      for (PointSighting& s : track.sightings) {
        const MovingCamera& camera = cameras_.at(s.frame);
        const double inverse =
            track.triangulated ? inverseDistance(camera, window_.positionOf(track)) : usual_inverse_distance_;
        const Eigen::Vector2d px = moved(camera, s.seen_px, inverse);
        if ((px - s.px).norm() < kSame_px) continue;
        s.px = px;
        s.observation = makeObservation(window_.camera(), px, window_.linearisedAt());
      }
  }

  void lines() {
    for (auto& [id, track] : window_.lines)
      for (LineSighting& s : track.sightings) {
        const MovingCamera& camera = cameras_.at(s.frame);
        const auto [start, end] = lineAtFrameTime(
            window_.camera(), camera_, s.seen_start_px, s.seen_end_px,
            [&](const Eigen::Vector2d& px) { return movedRay(camera, px, inverseDistance(camera, track, px)); });
        if (std::max((start - s.start_px).norm(), (end - s.end_px).norm()) < kSame_px) continue;
        s.start_px = start;
        s.end_px = end;
        std::tie(s.start, s.end) = makeLineEnds(window_.camera(), start, end, window_.linearisedAt());
      }
  }

 private:
  static double inverseDistance(const MovingCamera& camera, const Eigen::Vector3d& p_w) {
    return 1 / std::max((p_w - camera.T_w_c.p).norm(), 1e-3);
  }

  MotionChange changeAt(std::size_t i) const {
    const WindowFrame& frame = window_.frames[i];
    const auto imu = window_.imuAtFrame(i, std::max(kImuReach_s, 0.5 * std::abs(window_.unrolled_s)));
    if (!imu) return {};
    return motionChange(*imu, biasOf(frame.motion.data()).accel, frame.T_w_b().q, gravityW(window_.gravity_m_s2()));
  }

  /// Of the points that the newest frame sees; 0 without any.
  double usualInverseDistance() const {
    std::vector<double> inverse;
    for (const auto& [id, track] : window_.points)
      if (track.triangulated && !track.sightings.empty() && track.sightings.back().frame == window_.frames.back().id)
        inverse.push_back(inverseDistance(cameras_.at(window_.frames.back().id), window_.positionOf(track)));
    return inverse.empty() ? 0 : upperMedian(inverse);
  }

  /// Of what a pixel on a line sees.
  double inverseDistance(const MovingCamera& camera, const LineTrack& track, const Eigen::Vector2d& seen_px) const {
    if (!track.triangulated || !track.distance_known) return usual_inverse_distance_;
    const PluckerLine about_camera =
        movedOrigin(lineFromBlock(track.line.data()).plucker(), camera.T_w_c.p - track.origin_w);
    const Eigen::Quaterniond R_c_w = camera.T_w_c.q.conjugate();
    Eigen::Vector3d p_c;
    if (!closestPointToRay({R_c_w * about_camera.n, R_c_w * about_camera.d}, camera_.ray(seen_px), p_c))
      return usual_inverse_distance_;
    return 1 / std::max(p_c.norm(), 1e-3);
  }

  Eigen::Vector3d movedRay(const MovingCamera& camera, const Eigen::Vector2d& seen_px, double inverse_distance) const {
    return camera.rows.rayAtFrameTime(camera_.ray(seen_px).normalized(),
                                      window_.shareOfReadout(seen_px) * window_.unrolled_s, inverse_distance);
  }

  Eigen::Vector2d moved(const MovingCamera& camera, const Eigen::Vector2d& seen_px, double inverse_distance) const {
    const Eigen::Vector3d ray = movedRay(camera, seen_px, inverse_distance);
    return camera_.projects(ray) ? camera_.project(ray) : seen_px;
  }

  SlidingWindow& window_;
  Camera camera_;
  std::map<FrameId, MovingCamera> cameras_;
  double usual_inverse_distance_ = 0;
};

}  // namespace

void unroll(SlidingWindow& window) {
  const double former_s = window.unrolled_s, readout_s = window.readout_s();
  window.unrolled_s = std::abs(readout_s) > kShort_s ? readout_s : 0;
  if ((window.unrolled_s == 0 && former_s == 0) || window.frames.empty()) return;
  Unroller unroller(window);
  unroller.points();
  unroller.lines();
}

}  // namespace lintel
