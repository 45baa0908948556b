// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelSim.h"

#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <ostream>
#include <string>
#include <thread>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "StopSignals.h"
#include "lintel/core/FolderLock.h"
#include "lintel/reporting/Progress.h"
#include "lintel/simulation/Simulation.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;
class LintelSim {
 public:
  static constexpr const char* kName = "lintel-sim";

  LintelSim(std::ostream& out, std::ostream& err) : out_(out), err_(err) {
    params_.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    addOptions();
    addMotionOptions();
    addFaultOptions();
  }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    const fs::path folder = fs::path(folder_ + "/.").lexically_normal().parent_path();  // without a slash at the end
    refuseToOverwrite(folder);
    if (noise_free_) {
      params_.imu.noise = params_.imu.biases = false;
      params_.camera.noise = 0;
    }
    params_.imu.initial_gyro_bias *= imu_bias_;
    params_.imu.initial_accel_bias *= imu_bias_;
    readSize();
    const Simulation simulation(params_);
    const SimulationSummary summary = write(simulation, folder);
    if (!quiet_) print(summary, folder);
    return 0;
  }

 private:
  void addOptions() {
    std::string scenes;
    std::vector<std::string> names;
    for (const SceneKind& kind : sceneKinds()) {
      scenes += (scenes.empty() ? "" : "; ") + kind.name + ": " + kind.description;
      names.push_back(kind.name);
    }
    line_.option("-o,--output", folder_, "Folder to make, in the form of the EuRoC recordings")
        .required()
        .type("FOLDER");
    line_.option("--scene", params_.scene, scenes).oneOf(names).showDefault();
    line_.option("--duration", params_.duration_s, "Length [s]; 0 = 30, or the whole trajectory file")
        .notNegative()
        .showDefault();
    line_.option("--seed", params_.seed, "Another seed: other textures, furniture, noise, biases").showDefault();
    line_.option("--threads", params_.threads, "Threads; the files do not depend on their number")
        .positive()
        .showDefault();
    line_.flag("--noise-free", noise_free_, "No IMU noise, zero biases, no image noise");
    line_.flag("-w,--overwrite", overwrite_, "Replace the folder if it is there");
    line_.flag("-q,--quiet", quiet_, "Print nothing");
  }

  void addMotionOptions() {
    MotionParams& motion = params_.motion;
    line_.option("--trajectory", motion.trajectory_file, "Follow these poses: TUM, or an EuRoC state CSV").type("GT");
    line_.option("--start", motion.start_s, "Skip so much of the trajectory file [s]").notNegative().showDefault();
    line_
        .option("--figure", motion.figure,
                "Built-in motion: full, translation (fixed attitude) or rotation (fixed place)")
        .oneOf({"full", "translation", "rotation"})
        .showDefault();
    line_.option("--speed", motion.speed, "How fast the figure is flown").positive().showDefault();
    line_.option("--static-start", motion.static_s, "Rest at the start [s]").notNegative().showDefault();
  }

  void addFaultOptions() {
    line_
        .option(
            "--lens", params_.lens,
            "Lens of the camera: that of EuRoC without or with its distortion, another model, or a fisheye of 166 x "
            "107 degrees (equidistant, double-sphere, eucm)")
        .oneOf({"none", "radial-tangential", "rational", "equidistant", "double-sphere", "eucm"})
        .showDefault();
    line_.option("--size", size_, "Size of the images, the width's field of view kept").type("WIDTHxHEIGHT");
    line_.option("--zoom", params_.zoom, "Focal length; 2 = twice that of the lens: a narrower view")
        .positive()
        .showDefault();
    line_.option("--rate", params_.rate_hz, "Images a second").positive().showDefault();
    CameraSensorParams& camera = params_.camera;
    const auto number = [this](const char* name, double& value, const char* help) {
      return line_.option(name, value, help).notNegative().showDefault();
    };
    number("--image-noise", camera.noise, "Image noise; 1 = about one grey level");
    number("--imu-noise", params_.imu.noise_scale, "IMU noise; 1 = EuRoC's");
    number("--imu-bias", imu_bias_, "IMU biases at the start; 1 = as EuRoC's");
    number("--bias-walk", params_.imu.walk_scale, "How fast the IMU biases drift; 1 = EuRoC's");
    number("--blur", camera.exposure_time_s, "Exposure time: motion blur [s]");
    number("--line-delay", camera.line_delay_s,
           "Rolling shutter: from row to row; the stamp is that of the middle row [s]");
    number("--exposure-change", camera.exposure_change, "Changes of the exposure (deviation of its logarithm)");
    number("--vignetting", camera.vignetting, "Darkening in the corners").range(0.0, 1.0);
    line_.option("--camera-delay", params_.camera_delay_s, "Images are older than their stamps by so much [s]")
        .range(-0.1, 0.1)
        .showDefault();
    number("--calibration-error", params_.calibration_error,
           "sensor.yaml is wrong by so much; 1 = as a fair calibration");
    number("--drop-images", params_.drop_images_every_s, "0.3 s without images so often [s]; 0 = never");
    number("--drop-imu", params_.drop_imu_every_s, "0.1 s without IMU so often [s]; 0 = never");
  }

  void readSize() {
    if (size_.empty()) return;
    char end = 0;
    if (std::sscanf(size_.c_str(), "%dx%d%c", &params_.width, &params_.height, &end) != 2 || params_.width <= 0)
      throw UsageError("--size must be like 1280x720");
  }

  void refuseToOverwrite(const fs::path& folder) const {
    if (!fs::exists(folder)) return;
    if (!overwrite_) throw std::runtime_error(folder.string() + ": is there already; give -w to replace it");
    const bool replaceable = fs::is_directory(folder) && (fs::is_empty(folder) || fs::exists(folder / "mav0"));
    if (!replaceable)
      throw std::runtime_error(folder.string() + ": is no recording; not replaced, choose another folder");
  }

  /// Written beside the folder, then renamed: the folder is never half a recording.
  SimulationSummary write(const Simulation& simulation, const fs::path& folder) const {
    const fs::path part = folder.string() + ".part";
    const bool left_behind = fs::exists(part / "mav0") || (fs::is_directory(part) && fs::is_empty(part));
    if (fs::exists(part) && !left_behind) throw std::runtime_error(part.string() + ": is in the way; move it");
    fs::create_directories(part);
    const FolderLock lock(part.string());
    fs::remove_all(part / "mav0");
    try {
      const SimulationSummary summary = render(simulation, part);
      replace(folder, part);
      return summary;
    } catch (...) {
      std::error_code ignored;
      fs::remove_all(part, ignored);
      throw;
    }
  }

  SimulationSummary render(const Simulation& simulation, const fs::path& part) const {
    const StopSignals stop;
    Progress progress(err_, progressStyleFor(err_, quiet_), "rendering", "frames", simulation.images());
    const SimulationSummary summary = simulation.write(part.string(), [&](std::size_t done) {
      stop.check();
      progress.update(done);
    });
    progress.clear();
    return summary;
  }

  /// `part` takes the place of the folder; what was there is removed when that is done.
  static void replace(const fs::path& folder, const fs::path& part) {
    const fs::path old = folder.string() + ".old";
    if (fs::exists(folder)) {
      fs::remove_all(old);
      fs::rename(folder, old);
    }
    fs::rename(part, folder);
    fs::remove_all(old);
  }

  void print(const SimulationSummary& s, const fs::path& folder) const {
    const fs::path mav0 = folder / "mav0";
    out_ << std::fixed << std::setprecision(2) << params_.scene << ": " << s.duration_s << " s, " << s.images
         << " images, " << s.imu_samples << " IMU samples\n"
         << "motion: path " << s.path_m << " m, mean speed " << s.mean_speed_m_s << " m/s, greatest rate "
         << s.max_rate_rad_s << " rad/s, greatest acceleration " << s.max_accel_m_s2 << " m/s^2\n"
         << "lines: " << s.lines << ", seen " << s.lines_seen << "\n"
         << "recording:    " << folder.string() << "\n"
         << "ground truth: " << (mav0 / "state_groundtruth_estimate0/data.csv").string() << "\n"
         << "true lines:   " << (mav0 / "lines0/data.csv").string() << "\n"
         << "true surface: " << (mav0 / "scene0/scene.ply").string() << "\n";
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName, "Makes a simulated recording: images, IMU, and everything true about them."};
  std::string folder_, size_;
  SimulationParams params_;
  double imu_bias_ = 1;
  bool noise_free_ = false, overwrite_ = false, quiet_ = false;
};

}  // namespace

int runLintelSim(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(LintelSim::kName, err, [&] { return LintelSim(out, err).run(argc, argv); });
}

}  // namespace lintel
