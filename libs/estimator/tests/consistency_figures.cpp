// SPDX-License-Identifier: BSD-3-Clause
// A measuring program, not a test: errors and consistency on simulated tracks with white noise and an exact model. Not
// built by default:
//
//   ninja -C build/release consistency_figures
//   build/release/libs/estimator/consistency_figures SEEDS DURATION_S LINES
//
// Every seed draws the motion, landmarks, noise, biases, and a calibration that is wrong by what the priors allow.
// LINES: 25 or 0. Prints the error of the causal trajectory (RMSE after alignment of position and yaw) and, at some
// times, mean and median over the seeds of the squared errors of the calibration in units of the estimated variances: 1
// where the standard deviations are right. The true time offset is 0, the mean of its prior, so its figure is too
// small.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "TestWindow.h"
#include "lintel/estimator/Estimator.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Rotation.h"

using namespace lintel;

namespace {

constexpr double kPixelSigma = 0.7;  // of the tracks, and what the estimator assumes

struct Draw {
  std::mt19937_64 engine;
  std::normal_distribution<double> normal;
  double operator()(double sigma) { return sigma * normal(engine); }
  Eigen::Vector3d vector(double sigma) { return {(*this)(sigma), (*this)(sigma), (*this)(sigma)}; }
};

/// A rig that is wrong by one draw from the priors.
Rig wrongRig(const Rig& rig, const CalibrationParams& p, Draw& draw) {
  Rig wrong = rig;
  wrong.camera.fx += draw(p.focal_sigma_px);
  wrong.camera.fy += draw(p.focal_sigma_px);
  wrong.camera.cx += draw(p.centre_sigma_px);
  wrong.camera.cy += draw(p.centre_sigma_px);
  wrong.camera.lens[0] += draw(p.distortion_sigma);
  wrong.camera.lens[1] += draw(p.distortion_sigma);
  wrong.T_b_c.p += draw.vector(p.extrinsic_translation_sigma_m);
  wrong.T_b_c.q = wrong.T_b_c.q * expRotation(draw.vector(p.extrinsic_rotation_sigma_rad));
  return wrong;
}

/// The tracks as a front end with this camera sees them.
FrameTracks seenWith(const Camera& camera, FrameTracks tracks) {
  for (PointObservation& o : tracks.points) o.ray = camera.ray(o.px);
  for (LineObservation& o : tracks.lines) {
    o.start = camera.normalise(o.start_px);
    o.end = camera.normalise(o.end_px);
  }
  return tracks;
}

using Squares = std::map<std::string, double>;  // mean squared error in sigmas

Squares calibrationSquares(const CalibrationEstimate& e, const Rig& truth) {
  Squares result;
  if (!e.sigma) return result;
  const auto mean = [](const Eigen::VectorXd& error, const Eigen::VectorXd& sigma) {
    return error.cwiseQuotient(sigma).squaredNorm() / static_cast<double>(error.size());
  };
  const Camera &c = e.camera, &t = truth.camera;
  result["focal"] = mean(Eigen::Vector2d(c.fx - t.fx, c.fy - t.fy), e.sigma->camera.head<2>());
  result["centre"] = mean(Eigen::Vector2d(c.cx - t.cx, c.cy - t.cy), e.sigma->camera.segment<2>(2));
  result["distortion"] = mean(Eigen::Vector2d(c.lens[0] - t.lens[0], c.lens[1] - t.lens[1]), e.sigma->camera.tail<2>());
  result["lever arm"] = mean(e.T_b_c.p - truth.T_b_c.p, e.sigma->p_b_c_m);
  result["rotation"] = mean(logRotation(truth.T_b_c.q.conjugate() * e.T_b_c.q), e.sigma->R_b_c_rad);
  result["offset"] =
      mean(Eigen::VectorXd::Constant(1, e.time_offset_s), Eigen::VectorXd::Constant(1, e.sigma->time_offset_s));
  return result;
}

struct Flight {
  double rmse_m = -1;
  int lost = 0;
  std::map<double, Squares> at;  // by time since the start
};

Flight runOne(std::uint64_t seed, double duration_s, int lines) {
  Draw draw{std::mt19937_64(seed), {}};
  FigureParams figure;
  figure.seed = seed;
  ImuSimulatorParams imu;
  imu.seed = seed;
  TrackSimulationParams tracks;
  tracks.duration_s = duration_s;
  tracks.seed = seed;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = lines;
  tracks.point_noise_px = tracks.line_noise_px = kPixelSigma;
  const test::TrackedFlight flight = test::fly(imu, tracks, FigureTrajectory(figure));
  EstimatorParams params;
  params.factors.point_sigma_px = kPixelSigma;
  const Rig rig = wrongRig(flight.rig, params.calibration, draw);
  Estimator estimator(rig, params);
  Flight result;
  std::vector<Eigen::Vector3d> estimate, truth;
  const std::int64_t t0 = flight.sim.frames.front().tracks.t_ns;
  std::vector<double> times{6, 15, 30, 60, 120};
  for (const SimulatedFrame& frame : flight.sim.frames) {
    const WindowUpdate update = estimator.process(seenWith(rig.camera, frame.tracks), frame.imu);
    result.lost += update.status == EstimatorStatus::kLost;
    if (update.hasPose()) {
      estimate.push_back(update.T_w_b.p);
      truth.push_back(frame.truth.state.T_w_b.p);
    }
    const double t_s = 1e-9 * static_cast<double>(frame.tracks.t_ns - t0);
    if (!times.empty() && t_s >= times.front() - 1e-6) {
      result.at[times.front()] = calibrationSquares(estimator.calibration(), flight.rig);
      times.erase(times.begin());
    }
  }
  if (estimate.size() < 20) return result;
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  result.rmse_m = std::sqrt(sum / static_cast<double>(truth.size()));
  return result;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0 : v[v.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  const double duration_s = argc > 2 ? std::atof(argv[2]) : 30;
  const int lines = argc > 3 ? std::atoi(argv[3]) : 25;
  std::vector<double> errors;
  std::map<double, std::map<std::string, std::vector<double>>> squares;
  int lost = 0;
  double logs = 0;
  for (int s = 1; s <= seeds; ++s) {
    const Flight flight = runOne(static_cast<std::uint64_t>(s), duration_s, lines);
    lost += flight.lost;
    if (flight.rmse_m < 0) {
      std::printf("seed %d: no trajectory\n", s);
      continue;
    }
    errors.push_back(flight.rmse_m);
    logs += std::log(flight.rmse_m);
    std::printf("%.4f ", flight.rmse_m);
    std::fflush(stdout);
    for (const auto& [t, by_name] : flight.at)
      for (const auto& [name, value] : by_name) squares[t][name].push_back(value);
  }
  std::printf("\nRMSE median %.4f geometric mean %.4f m, %d lost\n", median(errors),
              std::exp(logs / static_cast<double>(errors.size())), lost);
  for (const auto& [t, by_name] : squares) {
    std::printf("%5.0f s", t);
    for (const auto& [name, values] : by_name) {
      double sum = 0;
      for (double v : values) sum += v;
      std::printf("  %s %.2f (median %.2f)", name.c_str(), sum / static_cast<double>(values.size()), median(values));
    }
    std::printf("\n");
  }
  return 0;
}
