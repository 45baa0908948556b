// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/TrackSimulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "TrackBook.h"
#include "lintel/simulation/Random.h"
#include "lintel/simulation/SegmentView.h"

namespace lintel {

namespace {

/// A point on the faces of `shell`, up to half a metre before them.
Eigen::Vector3d pointOnShell(const Eigen::AlignedBox3d& shell, RandomStream& random) {
  const Eigen::Vector3d size = shell.sizes();
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) p[i] = shell.min()[i] + random.uniform() * size[i];
  // faces in proportion to their areas
  const Eigen::Vector3d areas(size.y() * size.z(), size.x() * size.z(), size.x() * size.y());
  double pick = random.uniform() * areas.sum();
  int axis = 0;
  while (axis < 2 && pick >= areas[axis]) pick -= areas[axis++];
  const double before = random.uniform(0, 0.5);
  p[axis] = random.uniform() < 0.5 ? shell.min()[axis] + before : shell.max()[axis] - before;
  return p;
}

void drawLandmarks(const Eigen::AlignedBox3d& shell, const TrackSimulationParams& params, SimulatedTracks& out) {
  RandomStream random(params.seed, 0x6c616e64);
  for (int i = 0; i < params.points; ++i) out.points_w.push_back(pointOnShell(shell, random));
  out.lines_w = params.lines_w;
  out.line_groups.assign(params.lines_w.size(), -1);
  for (int i = 0; i < (params.lines_w.empty() ? params.lines : 0); ++i) {
    const Eigen::Vector3d middle = pointOnShell(shell, random);
    const bool parallel = random.uniform() < params.axis_parallel_share;
    const int axis = random.index(3);
    const Eigen::Vector3d direction = random.direction(), d = parallel ? Eigen::Vector3d::Unit(axis) : direction;
    const double half = random.uniform(0.4, 1.5);
    out.lines_w.push_back({middle - half * d, middle + half * d});
    out.line_groups.push_back(parallel ? axis : -1);
  }
}

class Projector {
 public:
  Projector(const Rig& rig, const TrackSimulationParams& params, SimulatedTracks& out)
      : view_(rig.camera, params.border_px),
        T_b_c_(rig.T_b_c),
        params_(params),
        out_(out),
        noise_(params.seed, 0x7078),
        points_(params.max_points_per_frame),
        lines_(params.max_lines_per_frame) {}

  FrameTracks observe(const InertialTruth& truth) {
    const Pose T_c_w = (truth.state.T_w_b * T_b_c_).inverse();
    FrameTracks frame;
    frame.t_ns = truth.t_ns;
    observePoints(T_c_w, frame);
    observeLines(T_c_w, frame);
    return frame;
  }

 private:
  void observePoints(const Pose& T_c_w, FrameTracks& frame) {
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < out_.points_w.size(); ++i) {
      if (view_.project(T_c_w * out_.points_w[i])) seen.push_back(i);
    }
    for (const TrackBook::Entry& entry : points_.update(seen, out_.point_of_track)) {
      PointObservation o;
      o.id = entry.id;
      o.track_length = entry.length;
      o.px = *view_.project(T_c_w * out_.points_w[entry.landmark]) + noisePx(params_.point_noise_px);
      const double share = noise_.uniform();
      const Eigen::Vector2d wrong(noise_.uniform(-30, 30), noise_.uniform(-30, 30));
      if (share < params_.outlier_share) o.px += wrong;
      o.ray = view_.camera().ray(o.px);
      frame.points.push_back(o);
    }
  }

  void observeLines(const Pose& T_c_w, FrameTracks& frame) {
    std::vector<std::size_t> seen;
    std::vector<SegmentView> views(out_.lines_w.size());
    for (std::size_t i = 0; i < out_.lines_w.size(); ++i) {
      const auto view = viewSegment(view_, {T_c_w * out_.lines_w[i].start, T_c_w * out_.lines_w[i].end});
      if (!view || view->length_px() < params_.min_line_px) continue;
      views[i] = *view;
      seen.push_back(i);
    }
    for (const TrackBook::Entry& entry : lines_.update(seen, out_.line_of_track)) {
      LineObservation o;
      o.id = entry.id;
      o.track_length = entry.length;
      o.start_px = views[entry.landmark].start_px;
      o.end_px = views[entry.landmark].end_px;
      disturb(o);
      o.start = view_.camera().ray(o.start_px);
      o.end = view_.camera().ray(o.end_px);
      if (params_.line_noise_px > 0) o.sigma_px = params_.line_noise_px;
      frame.lines.push_back(o);
    }
  }

  void disturb(LineObservation& o) {
    const Eigen::Vector2d along = (o.end_px - o.start_px).normalized(), across(-along.y(), along.x());
    for (Eigen::Vector2d* end : {&o.start_px, &o.end_px}) {
      *end += across * (params_.line_noise_px * noise_.gaussian());
      *end += along * (params_.line_end_jitter_px * noise_.gaussian());
    }
  }

  Eigen::Vector2d noisePx(double sigma_px) {
    const double x = noise_.gaussian(), y = noise_.gaussian();
    return sigma_px * Eigen::Vector2d(x, y);
  }

  ViewTest view_;
  Pose T_b_c_;
  const TrackSimulationParams& params_;
  SimulatedTracks& out_;
  RandomStream noise_;
  TrackBook points_, lines_;
};

}  // namespace

SimulatedTracks simulateTracks(const Trajectory& trajectory, const Rig& rig, const ImuSimulatorParams& imu_params,
                               const TrackSimulationParams& params) {
  const auto per_frame = static_cast<std::size_t>(imuPerFrame(rig));
  const auto lead_in = static_cast<std::size_t>(std::lround(params.lead_in_s * rig.imu_rate_hz));
  const auto frames = static_cast<std::size_t>(std::lround(params.duration_s * rig.camera_rate_hz)) + 1;
  const std::size_t count = lead_in + (frames - 1) * per_frame + 1;
  if (static_cast<double>(count - 1) / rig.imu_rate_hz > trajectory.duration() + 1e-9) {
    throw std::invalid_argument("simulateTracks: the trajectory is shorter than lead_in_s + duration_s");
  }
  const SimulatedImu imu = simulateImu(trajectory, rig, imu_params, count);
  Eigen::AlignedBox3d shell;
  for (const InertialTruth& truth : imu.truth) shell.extend(truth.state.T_w_b.p);
  shell.min().array() -= params.margin_m;
  shell.max().array() += params.margin_m;

  SimulatedTracks out;
  drawLandmarks(shell, params, out);
  Projector projector(rig, params, out);
  for (std::size_t k = 0; k < frames; ++k) {
    const std::size_t now = lead_in + k * per_frame, before = k == 0 ? 0 : now - per_frame;
    const auto begin = imu.samples.begin();
    out.frames.push_back(
        {projector.observe(imu.truth[now]),
         ImuBatch(begin + static_cast<std::ptrdiff_t>(before), begin + static_cast<std::ptrdiff_t>(now) + 1),
         imu.truth[now]});
  }
  return out;
}

}  // namespace lintel
