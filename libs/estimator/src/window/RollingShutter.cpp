// SPDX-License-Identifier: BSD-3-Clause
#include "window/RollingShutter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/PluckerLine.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kShort_s = 0.001;  ///< the residuals' first order is enough for shorter ones
constexpr double kSame_px = 0.01;   ///< a sighting that moves by less is left as it is: far below its noise

/// The camera during one image.
struct MovingCamera {
  Pose T_w_c;
  Eigen::Vector3d v_c, omega_c;  ///< its own axes
};

class Unroller {
 public:
  explicit Unroller(SlidingWindow& window) : window_(window), camera_(window.correctedCamera()) {
    const Pose T_b_c = window.T_b_c();
    for (const WindowFrame& frame : window.frames) {
      const FrameMotion motion = frame.bodyMotion();
      const Eigen::Quaterniond R_c_b = T_b_c.q.conjugate();
      cameras_[frame.id] = {window.T_w_c(frame), R_c_b * (motion.v_b + motion.omega_b.cross(T_b_c.p)),
                            R_c_b * motion.omega_b};
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
        const Eigen::Vector2d start = lineEnd(track, cameras_.at(s.frame), s.seen_start_px),
                              end = lineEnd(track, cameras_.at(s.frame), s.seen_end_px);
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

  /// Of the points that the newest frame sees; 0 without any.
  double usualInverseDistance() const {
    std::vector<double> inverse;
    for (const auto& [id, track] : window_.points)
      if (track.triangulated && !track.sightings.empty() && track.sightings.back().frame == window_.frames.back().id)
        inverse.push_back(inverseDistance(cameras_.at(window_.frames.back().id), window_.positionOf(track)));
    return inverse.empty() ? 0 : upperMedian(inverse);
  }

  Eigen::Vector2d lineEnd(const LineTrack& track, const MovingCamera& camera, const Eigen::Vector2d& seen_px) const {
    double inverse = usual_inverse_distance_;
    if (track.triangulated && track.distance_known) {
      const PluckerLine about_camera =
          movedOrigin(lineFromBlock(track.line.data()).plucker(), camera.T_w_c.p - track.origin_w);
      const Eigen::Quaterniond R_c_w = camera.T_w_c.q.conjugate();
      Eigen::Vector3d p_c;
      if (closestPointToRay({R_c_w * about_camera.n, R_c_w * about_camera.d}, camera_.ray(seen_px), p_c))
        inverse = 1 / std::max(p_c.norm(), 1e-3);
    }
    return moved(camera, seen_px, inverse);
  }

  Eigen::Vector2d moved(const MovingCamera& camera, const Eigen::Vector2d& seen_px, double inverse_distance) const {
    const double dt_s = window_.shareOfReadout(seen_px) * window_.unrolled_s;
    if (dt_s == 0) return seen_px;
    const Eigen::Vector3d ray =
        expRotation(camera.omega_c * dt_s) * camera_.ray(seen_px).normalized() + camera.v_c * dt_s * inverse_distance;
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
