// SPDX-License-Identifier: BSD-3-Clause
#include "EurocSensorYaml.h"

#include <iomanip>
#include <sstream>

#include "lintel/geometry/LensNames.h"

namespace lintel {

namespace {

std::ostringstream text() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(15);
  return out;
}

std::string extrinsics(const Pose& T_b_s) {
  auto out = text();
  const Eigen::Matrix3d R = T_b_s.R();
  out << "# Sensor extrinsics wrt. the body-frame.\nT_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out << R(r, c) << ", ";
    out << T_b_s.p[r] << ",\n         ";
  }
  out << "0.0, 0.0, 0.0, 1.0]\n";
  return out.str();
}

}  // namespace

/// Model and intrinsics: two more of a lens that is a camera model by itself.
std::string lensText(const Camera& c) {
  auto out = text();
  const std::string name = lensName(c.model).name;
  const bool own = c.model >= LensModel::kDoubleSphere;
  std::string lens;
  for (const double value : lensCoefficients(c)) {
    auto number = text();
    number << value;
    lens += (lens.empty() ? "" : ", ") + number.str();
  }
  out << "camera_model: " << (own ? name : "pinhole") << "\nintrinsics: [" << (own ? lens + ", " : "") << c.fx << ", "
      << c.fy << ", " << c.cx << ", " << c.cy << "] #" << (own ? "lens, " : "") << "fu, fv, cu, cv\n";
  if (!own) out << "distortion_model: " << name << "\ndistortion_coefficients: [" << lens << "]\n";
  return out.str();
}

std::string cameraYaml(const Rig& rig) {
  auto out = text();
  const Camera& c = rig.camera;
  out << "# General sensor definitions.\nsensor_type: camera\ncomment: simulated cam0 (lintel-sim)\n\n"
      << extrinsics(rig.T_b_c) << "\n# Camera specific definitions.\nrate_hz: " << rig.camera_rate_hz
      << "\nresolution: [" << c.width << ", " << c.height << "]\n"
      << lensText(c);
  if (rig.line_delay_s != 0) out << "line_delay_s: " << rig.line_delay_s << " #from row to row; stamp: middle row\n";
  return out.str();
}

std::string imuYaml(const Rig& rig) {
  auto out = text();
  const ImuNoise& n = rig.imu_noise;
  out << "#Default imu sensor yaml file\nsensor_type: imu\ncomment: simulated imu0 (lintel-sim)\n\n"
      << extrinsics(Pose{}) << "rate_hz: " << rig.imu_rate_hz
      << "\n\n# inertial sensor noise model parameters (static)\ngyroscope_noise_density: " << n.gyro_noise
      << "     # [ rad / s / sqrt(Hz) ]   ( gyro \"white noise\" )\ngyroscope_random_walk: " << n.gyro_walk
      << "       # [ rad / s^2 / sqrt(Hz) ] ( gyro bias diffusion )\naccelerometer_noise_density: " << n.accel_noise
      << "  # [ m / s^2 / sqrt(Hz) ]   ( accel \"white noise\" )\naccelerometer_random_walk: " << n.accel_walk
      << "    # [ m / s^3 / sqrt(Hz) ].  ( accel bias diffusion )\n";
  return out.str();
}

std::string groundTruthYaml() {
  return "# General sensor definitions.\nsensor_type: visual-inertial\ncomment: exact states of a simulation "
         "(lintel-sim); gravity is (0, 0, -9.81)\n\n" +
         extrinsics(Pose{});
}

}  // namespace lintel
