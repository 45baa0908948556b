// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "lintel/core/Rig.h"
#include "lintel/simulation/CameraSensor.h"
#include "lintel/simulation/ImuSimulator.h"
#include "lintel/simulation/SceneLibrary.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// How the body moves.
struct MotionParams {
  std::string trajectory_file;  ///< a TUM or EuRoC trajectory to follow; empty: the scene's figure
  double start_s = 0;           ///< skip so much of the file [s]
  std::string figure = "full";  ///< full, translation or rotation
  double static_s = 0;          ///< rest at the start [s]
  double speed = 1;             ///< how fast the figure is flown
};

struct SimulationParams {
  std::string scene = "room";
  MotionParams motion;
  double duration_s = 0;  ///< from the first image to after the last; 0: 30 s, or the whole trajectory file
  std::uint64_t seed = 1;
  int threads = 1;
  std::string lens = "radial-tangential";  ///< none, or a name of LensNames.h
  int width = 0, height = 0;               ///< of the images, the width's field of view kept; 0: 752 x 480
  double zoom = 1;                         ///< focal length over that of the lens
  double rate_hz = 20;                     ///< of the images
  ImuSimulatorParams imu;                  ///< its seed is derived from `seed`
  CameraSensorParams camera;               ///< its seed is derived from `seed`
  double camera_delay_s = 0;               ///< images show what was so much before their stamps [s]
  double calibration_error = 0;            ///< sensor.yaml differs from the true camera; 1: as a fair calibration does
  double drop_images_every_s = 0;          ///< a gap of 0.3 s without images so often [s]; 0 = never
  double drop_imu_every_s = 0;             ///< a gap of 0.1 s without IMU so often [s]; 0 = never
};

struct SimulationSummary {
  std::size_t images = 0, imu_samples = 0, lines = 0, lines_seen = 0;
  double duration_s = 0, path_m = 0, mean_speed_m_s = 0, max_rate_rad_s = 0, max_accel_m_s2 = 0;
};

/// A whole simulated recording: scene, motion, IMU and images, written as an EuRoC folder.
class Simulation {
 public:
  /// Builds everything that does not depend on time. Throws std::invalid_argument or EvaluationError (trajectory file).
  explicit Simulation(const SimulationParams& params);
  ~Simulation();

  std::size_t images() const;
  const Trajectory& trajectory() const;
  const Scene& scene() const;

  /// Writes the folder (created; nothing in it is removed). `progress` is told the number of images done, from one
  /// thread at a time. Throws std::runtime_error on what cannot be written.
  SimulationSummary write(const std::string& folder, const std::function<void(std::size_t)>& progress = {}) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
