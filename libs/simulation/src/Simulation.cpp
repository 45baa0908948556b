// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/Simulation.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "Motion.h"
#include "lintel/core/ParallelFor.h"
#include "lintel/geometry/LensNames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/EurocWriter.h"
#include "lintel/simulation/Random.h"

namespace lintel {

namespace {

constexpr double kLeadIn_s = 0.1;  // IMU before the first image and after the last
constexpr double kUsualDuration_s = 30;
constexpr double kImageGap_s = 0.3, kImuGap_s = 0.1;

/// Whether `t_s` lies in one of the gaps that come every `every_s`, the first after `every_s`.
bool inGap(double t_s, double every_s, double gap_s) {
  return every_s > 0 && t_s >= every_s && std::fmod(t_s, every_s) < gap_s;
}

/// Another sensor behind the same lens: as wide a view from left to right.
void resize(Camera& camera, int width, int height) {
  if (std::min(width, height) < 64 || std::max(width, height) > 8192)
    throw std::invalid_argument("images are 64 to 8192 pixels wide and high");
  const double scale = static_cast<double>(width) / camera.width;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = 0.5 * (width - 1) + scale * (camera.cx - 0.5 * (camera.width - 1));
  camera.cy = 0.5 * (height - 1) + scale * (camera.cy - 0.5 * (camera.height - 1));
  camera.width = width;
  camera.height = height;
}

Rig rigOf(const SimulationParams& params) {
  Rig rig = eurocRig();
  if (params.lens == "none") {
    rig.camera.lens = {};
  } else if (const auto model = lensModel(params.lens)) {
    rig.camera = lensCamera(*model);
  } else {
    throw std::invalid_argument("the lens " + params.lens + " is not known");
  }
  if (params.width > 0) resize(rig.camera, params.width, params.height);
  if (!(params.zoom >= 0.2 && params.zoom <= 20)) throw std::invalid_argument("the zoom is 0.2 to 20");
  rig.camera.fx *= params.zoom;
  rig.camera.fy *= params.zoom;
  if (!(params.rate_hz >= 1 && params.rate_hz <= rig.imu_rate_hz))
    throw std::invalid_argument("images come at 1 to " + std::to_string(std::lround(rig.imu_rate_hz)) + " Hz");
  rig.camera_rate_hz = params.rate_hz;
  rig.line_delay_s = params.camera.line_delay_s;
  return rig;
}

/// What a calibration gets wrong: some tenths of a percent, a pixel, a tenth of a degree, some millimetres.
Rig miscalibrated(Rig rig, double amount, std::uint64_t seed) {
  RandomStream random(seed, 0x63616c6962);
  rig.camera.fx *= 1 + amount * random.uniform(-0.002, 0.002);
  rig.camera.fy *= 1 + amount * random.uniform(-0.002, 0.002);
  rig.camera.cx += amount * random.uniform(-0.8, 0.8);
  rig.camera.cy += amount * random.uniform(-0.8, 0.8);
  rig.camera.lens[0] *= 1 + amount * random.uniform(-0.01, 0.01);
  rig.camera.lens[1] *= 1 + amount * random.uniform(-0.01, 0.01);
  rig.T_b_c.q = rig.T_b_c.q * expRotation(amount * 0.0025 * random.direction());
  rig.T_b_c.p += amount * 0.003 * random.direction();
  return rig;
}

}  // namespace

class Simulation::Impl {
 public:
  explicit Impl(const SimulationParams& params)
      : params_(params),
        rig_(rigOf(params)),
        kind_(sceneKind(params.scene)),
        motion_(buildMotion(params.motion, kind_, rig_)),
        duration_s_(durationOf(params, *motion_)),
        scene_(kind_.build(requestFor(kind_, params.motion, *motion_, duration_s_ + 2 * kLeadIn_s, params.seed))),
        renderer_(scene_, rig_.camera) {
    params_.imu.seed = mixBits(params.seed ^ 0x696d75);
    params_.camera.seed = mixBits(params.seed ^ 0x63616d);
    for (std::size_t k = 0; k < static_cast<std::size_t>(std::llround(duration_s_ * rig_.camera_rate_hz)); ++k) {
      const double since_first_s = static_cast<double>(k) / rig_.camera_rate_hz;
      if (!inGap(since_first_s, params_.drop_images_every_s, kImageGap_s)) frames_.push_back(k);
    }
  }

  SimulationSummary write(const std::string& folder, const std::function<void(std::size_t)>& progress) const {
    const EurocWriter writer(folder);
    writer.writeSensors(miscalibrated(rig_, params_.calibration_error, params_.seed));
    writer.writeScene(scene_);
    const SimulatedImu imu = writeInertial(writer);
    const std::vector<int> seen = writeImages(writer, progress);
    SimulationSummary summary = summarise(imu);
    writeLines(writer, seen, summary);
    return summary;
  }

  std::size_t images() const { return frames_.size(); }
  const Trajectory& trajectory() const { return *motion_; }
  const Scene& scene() const { return scene_; }

 private:
  static double durationOf(const SimulationParams& params, const Trajectory& motion) {
    const double most = motion.duration() - 2 * kLeadIn_s;
    if (params.duration_s > most + 1e-9) {
      throw std::invalid_argument("the trajectory is too short for " + std::to_string(params.duration_s) +
                                  " s; at most " + std::to_string(most) + " s, or leave --duration out");
    }
    const double wanted = params.duration_s > 0 ? params.duration_s : std::isfinite(most) ? most : kUsualDuration_s;
    if (wanted < 0.1) throw std::invalid_argument("the duration must be at least 0.1 s");
    return wanted;
  }

  std::int64_t stamp(std::size_t frame) const {
    return kSimulationStart_ns + std::llround(kLeadIn_s * rig_.imu_rate_hz) * imuStep_ns(rig_) +
           std::llround(1e9 * static_cast<double>(frame) / rig_.camera_rate_hz);
  }

  SimulatedImu writeInertial(const EurocWriter& writer) const {
    const auto count = static_cast<std::size_t>(std::llround((duration_s_ + 2 * kLeadIn_s) * rig_.imu_rate_hz)) + 1;
    SimulatedImu imu = simulateImu(*motion_, rig_, params_.imu, count);
    std::vector<ImuSample> delivered;
    for (const ImuSample& sample : imu.samples) {
      const double t_s = 1e-9 * static_cast<double>(sample.t_ns - kSimulationStart_ns) - kLeadIn_s;
      if (!inGap(t_s, params_.drop_imu_every_s, kImuGap_s)) delivered.push_back(sample);
    }
    writer.writeImu(delivered);
    writer.writeGroundTruth(imu.truth);
    return imu;
  }

  /// Returns in how many frames each line of the scene was seen.
  std::vector<int> writeImages(const EurocWriter& writer, const std::function<void(std::size_t)>& progress) const {
    const CameraSensor sensor(renderer_, rig_.camera, rig_.T_b_c, params_.camera);
    std::vector<int> seen(scene_.lines.size(), 0);
    std::mutex seen_mutex;
    const auto takeFrame = [&](std::size_t i) {
      const std::int64_t t_ns = stamp(frames_[i]);
      const double t_s = 1e-9 * static_cast<double>(t_ns - kSimulationStart_ns) - params_.camera_delay_s;
      writer.writeImage(t_ns, sensor.take(*motion_, t_s));
      const std::vector<bool> visible = renderer_.visibleLines(motion_->at(t_s).T_w_b * rig_.T_b_c);
      const std::lock_guard<std::mutex> lock(seen_mutex);
      for (std::size_t k = 0; k < visible.size(); ++k) seen[k] += visible[k] ? 1 : 0;
    };
    parallelFor(frames_.size(), params_.threads, takeFrame, progress);
    std::vector<std::int64_t> stamps;
    for (const std::size_t frame : frames_) stamps.push_back(stamp(frame));
    writer.writeImageList(stamps);
    return seen;
  }

  void writeLines(const EurocWriter& writer, const std::vector<int>& seen, SimulationSummary& summary) const {
    const std::vector<int> groups = directionGroups(scene_.lines);
    std::vector<TrueLine> lines;
    for (std::size_t i = 0; i < scene_.lines.size(); ++i) {
      lines.push_back({scene_.lines[i], groups[i], seen[i]});
      summary.lines_seen += seen[i] > 0 ? 1 : 0;
    }
    summary.lines = lines.size();
    writer.writeLines(lines);
  }

  SimulationSummary summarise(const SimulatedImu& imu) const {
    SimulationSummary summary;
    summary.images = frames_.size();
    summary.imu_samples = imu.samples.size();
    summary.duration_s = duration_s_;
    for (std::size_t i = 0; i < imu.truth.size(); ++i) {
      const KinematicState& state = imu.truth[i].state;
      if (i > 0) summary.path_m += (state.T_w_b.p - imu.truth[i - 1].state.T_w_b.p).norm();
      summary.max_rate_rad_s = std::max(summary.max_rate_rad_s, state.omega_b.norm());
      summary.max_accel_m_s2 = std::max(summary.max_accel_m_s2, state.a_w_b.norm());
    }
    summary.mean_speed_m_s = summary.path_m / (duration_s_ + 2 * kLeadIn_s);
    return summary;
  }

  SimulationParams params_;
  Rig rig_;
  const SceneKind& kind_;
  std::shared_ptr<const Trajectory> motion_;
  double duration_s_;
  Scene scene_;
  ImageRenderer renderer_;
  std::vector<std::size_t> frames_;  // numbers of the frames that are not dropped
};

Simulation::Simulation(const SimulationParams& params) : impl_(std::make_unique<Impl>(params)) {}
Simulation::~Simulation() = default;
std::size_t Simulation::images() const { return impl_->images(); }
const Trajectory& Simulation::trajectory() const { return impl_->trajectory(); }
const Scene& Simulation::scene() const { return impl_->scene(); }
SimulationSummary Simulation::write(const std::string& folder, const std::function<void(std::size_t)>& progress) const {
  return impl_->write(folder, progress);
}

}  // namespace lintel
