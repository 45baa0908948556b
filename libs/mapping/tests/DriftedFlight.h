// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <map>

#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/TrackSimulation.h"

namespace lintel::test {

/// A simulated flight of four seconds, every fifth frame a keyframe; the causal poses drift away from the truth.
class DriftedFlight : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    TrackSimulationParams tracks;
    tracks.duration_s = 4;
    tracks.max_points_per_frame = 60;
    tracks.max_lines_per_frame = 20;
    tracks.point_noise_px = tracks.line_noise_px = 0.3;
    ImuSimulatorParams imu;
    imu.initial_gyro_bias = imu.initial_accel_bias = 0;
    flight_ = simulateTracks(FigureTrajectory(), eurocRig(), imu, tracks);
  }
  static void TearDownTestSuite() { flight_ = {}; }

  DriftedFlight() {
    MapBuilder builder(rig_, {});
    const Eigen::Vector3d drift(0.02, -0.03, 0.01), turn(0.001, 0.001, 0.006);  // a second
    std::shared_ptr<Preintegration> imu;
    std::map<TrackId, RetiredPoint> points;
    std::map<TrackId, RetiredLine> lines;
    WindowUpdate last;
    for (std::size_t i = 0; i < flight_.frames.size(); ++i) {
      const SimulatedFrame& frame = flight_.frames[i];
      const double t = 1e-9 * static_cast<double>(frame.tracks.t_ns - flight_.frames[0].tracks.t_ns);
      if (imu) imu->append(frame.imu);
      WindowUpdate update;
      update.t_ns = frame.tracks.t_ns;
      update.status = EstimatorStatus::kTracking;
      update.T_w_b = frame.truth.state.T_w_b;
      update.T_w_b.p += t * drift;
      update.T_w_b.q = expRotation(t * turn) * update.T_w_b.q;
      builder.add(update);
      if (i % 5 != 0) continue;
      last.keyframes.push_back(
          {i, update.t_ns, update.T_w_b, frame.truth.state.v_w_b + drift, {}, imu, false, false, {}, {}, 0});
      imu = std::make_shared<Preintegration>(ImuBias{}, rig_.imu_noise);
      imu->append({frame.imu.back()});
      for (const PointObservation& o : frame.tracks.points) {
        points[o.id].triangulated = false;
        points[o.id].id = o.id;
        points[o.id].sightings.push_back({i, {}, o.px});
      }
      for (const LineObservation& o : frame.tracks.lines) {
        lines[o.id].triangulated = false;
        lines[o.id].id = o.id;
        lines[o.id].sightings.push_back({i, {}, {}, o.start_px, o.end_px, 1.0});
      }
    }
    for (auto& [id, point] : points) last.points.push_back(point);
    for (auto& [id, line] : lines) last.lines.push_back(line);
    builder.add(last);
    material_ = builder.material();
    estimator_.calibration.refine_camera = estimator_.calibration.refine_extrinsics =
        estimator_.calibration.refine_time_offset = false;
  }

  Similarity alignment(const MapMaterial& material) const {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (std::size_t i = 0; i < material.trajectory.size(); ++i) {
      estimate.push_back(material.trajectory[i].second.p);
      truth.push_back(flight_.frames[i].truth.state.T_w_b.p);
    }
    return alignPositions(AlignmentKind::kYaw, estimate, truth);
  }
  double scale(const MapMaterial& material) const {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (const RetiredKeyframe& k : material.keyframes) {
      estimate.push_back(k.T_w_b.p);
      truth.push_back(flight_.frames[k.id].truth.state.T_w_b.p);
    }
    return alignPositions(AlignmentKind::kSim3, estimate, truth).scale;
  }
  double error(const MapMaterial& material) const {
    const Similarity T = alignment(material);
    double sum = 0;
    for (std::size_t i = 0; i < material.trajectory.size(); ++i)
      sum += (T * material.trajectory[i].second.p - flight_.frames[i].truth.state.T_w_b.p).squaredNorm();
    return std::sqrt(sum / static_cast<double>(material.trajectory.size()));
  }
  RefinementReport refine(MapMaterial& material, const std::vector<PointJoin>& joins = {}) const {
    return BatchRefinement(rig_, estimator_, map_, params_).refine(material, {}, joins);
  }
  /// In the middle of the flight it is dark for a second: points are other tracks afterwards; the joins say which.
  std::vector<PointJoin> splitTracks() {
    constexpr TrackId kAfter = 1'000'000;
    const FrameId dark = flight_.frames.size() / 2 - 10, light = dark + 20;
    std::vector<PointJoin> joins;
    std::vector<PointRecord> split;
    for (const PointRecord& point : material_.points) {
      PointRecord before = point, after = point;
      after.id += kAfter;
      before.views.clear();
      after.views.clear();
      for (const PointView& view : point.views) {
        if (view.keyframe < dark) before.views.push_back(view);
        if (view.keyframe >= light) after.views.push_back(view);
      }
      if (before.views.size() > 3 && after.views.size() > 3) joins.push_back({before.id, after.id, 1});
      if (before.views.size() > 1) split.push_back(before);
      if (after.views.size() > 1) split.push_back(after);
    }
    std::sort(split.begin(), split.end(), [](const PointRecord& a, const PointRecord& b) { return a.id < b.id; });
    material_.points = split;
    return joins;
  }

  /// All points but those held out, every twentieth, slide by three pixels from keyframe to keyframe.
  static void slideAllButHeldOut(RefinementParams& params, MapMaterial& material) {
    params.lines = false;
    params.max_imu_error = params.max_moved_m = 1000;
    for (PointRecord& point : material.points)
      if (point.id % 20 != 1)
        for (PointView& view : point.views) view.px.x() += 0.6F * static_cast<float>(view.keyframe);
  }

  /// From keyframe `first` on the images' stamps are late: they show the world of so much earlier. Points only.
  void delayStamps(FrameId first, double late_s) {
    material_.lines.clear();
    for (PointRecord& point : material_.points)
      for (PointView& view : point.views) {
        if (view.keyframe < first) continue;
        const InertialTruth& truth = flight_.frames[view.keyframe].truth;
        const Pose &now = truth.state.T_w_b,
                   then{now.q * expRotation(-late_s * truth.state.omega_b), now.p - late_s * truth.state.v_w_b};
        const Eigen::Vector3d& p_w = flight_.points_w[flight_.point_of_track[point.track]];
        view.px += (rig_.camera.project((then * rig_.T_b_c).inverse() * p_w) -
                    rig_.camera.project((now * rig_.T_b_c).inverse() * p_w))
                       .cast<float>();
      }
  }

  static inline SimulatedTracks flight_;
  const Rig rig_ = eurocRig();
  EstimatorParams estimator_;
  MapParams map_;
  RefinementParams params_;
  MapMaterial material_;
};

}  // namespace lintel::test
