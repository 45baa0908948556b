// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>

#include "lintel/geometry/LensNames.h"
#include "lintel/sensing/Calibration.h"

namespace lintel {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

/// The IMU's axis that a camera's axis is nearest to, and the angle between.
std::string axisInWords(const Eigen::Vector3d& direction_b) {
  Eigen::Index axis = 0;
  direction_b.cwiseAbs().maxCoeff(&axis);
  const double angle = std::acos(std::min(1.0, std::abs(direction_b[axis]))) * kDegrees;
  return std::string("the IMU's ") + (direction_b[axis] < 0 ? "-" : "+") + "xyz"[axis] +
         (angle < 0.05 ? "" : " (" + rounded(angle, 2) + " deg off)");
}

/// Density outside of what MEMS and better sensors have, from tactical-grade units to those of telephones, with a
/// decade to spare on either side.
struct NoiseRange {
  const char* what;
  double value, min, max;
};

void doubtNoise(const ImuNoise& noise, std::vector<std::string>& doubts) {
  for (const NoiseRange& range :
       {NoiseRange{"gyroscope's noise density [rad/s/sqrt(Hz)]", noise.gyro_noise, 1e-6, 1e-2},
        NoiseRange{"accelerometer's noise density [m/s^2/sqrt(Hz)]", noise.accel_noise, 1e-5, 1e-1},
        NoiseRange{"gyroscope's random walk [rad/s^2/sqrt(Hz)]", noise.gyro_walk, 1e-8, 1e-2},
        NoiseRange{"accelerometer's random walk [m/s^3/sqrt(Hz)]", noise.accel_walk, 1e-7, 1e-1}})
    if (range.value < range.min || range.value > range.max)
      doubts.push_back(std::string("the ") + range.what + " is " + rounded(range.value, 3) + ", no sensor has that (" +
                       rounded(range.min, 2) + " to " + rounded(range.max, 2) + "): check its unit");
}

void doubtCamera(const Camera& camera, std::vector<std::string>& doubts) {
  const double width = camera.width, height = camera.height;
  if (std::abs(camera.cx / width - 0.5) > 0.2 || std::abs(camera.cy / height - 0.5) > 0.2)
    doubts.push_back("the principal point (" + rounded(camera.cx, 4) + ", " + rounded(camera.cy, 4) +
                     ") is far from the middle of the image of " + std::to_string(camera.width) + "x" +
                     std::to_string(camera.height) + ": is the calibration of another image size?");
  if (std::abs(std::log(camera.fx / camera.fy)) > 0.1)
    doubts.push_back("the focal lengths " + rounded(camera.fx, 4) + " and " + rounded(camera.fy, 4) +
                     " differ by more than 10 %: pixels of cameras are square");
  if (camera.fx < 0.2 * width || camera.fx > 5 * width)
    doubts.push_back("a focal length of " + rounded(camera.fx, 4) + " px is strange for an image " +
                     std::to_string(camera.width) + " px wide: is the calibration of another image size?");
}

/// Between a pixel and the optical axis [rad]; of lenses that are not wide without distortion.
double angleAt(const Camera& camera, const Eigen::Vector2d& px) {
  if (camera.wide()) {
    const Eigen::Vector3d ray = camera.ray(px);
    return std::atan2(ray.head<2>().norm(), ray.z());
  }
  return std::atan(std::hypot((px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy));
}

std::string lensInWords(const Camera& camera) {
  const LensName& lens = lensName(camera.model);
  std::string text = lens.name;
  const std::vector<double> values = lensCoefficients(camera);
  for (std::size_t i = 0; i < values.size(); ++i)
    text += std::string(i > 0 ? ", " : " ") + lens.coefficients[i] + " " + rounded(values[i], 4);
  return text;
}

/// Nothing of right ones.
std::string axesInWords(const Eigen::Matrix3d& errors) {
  if (errors.isZero(0)) return {};
  return "    its axes are wrong by up to " + rounded(100 * errors.cwiseAbs().maxCoeff(), 2) +
         " %, which its samples are corrected for\n";
}

}  // namespace

std::vector<std::string> rigDoubts(const Rig& rig, double time_shift_s) {
  std::vector<std::string> doubts;
  doubtCamera(rig.camera, doubts);
  doubtNoise(rig.imu_noise, doubts);
  if (rig.T_b_c.p.norm() > 2)
    doubts.push_back("camera and IMU are " + rounded(rig.T_b_c.p.norm(), 3) +
                     " m apart: positions are in metres, were millimetres given?");
  if (std::abs(time_shift_s) > 0.5)
    doubts.push_back("the clocks of camera and IMU differ by " + rounded(time_shift_s, 3) +
                     " s: times are in seconds, were milliseconds given?");
  return doubts;
}

std::string rigInWords(const Rig& rig, double time_shift_s) {
  const Camera& c = rig.camera;
  const Eigen::Matrix3d R_b_c = rig.T_b_c.q.toRotationMatrix();
  const double across = (angleAt(c, {0, c.cy}) + angleAt(c, {c.width, c.cy})) * kDegrees;
  const double down = (angleAt(c, {c.cx, 0}) + angleAt(c, {c.cx, c.height})) * kDegrees;
  std::ostringstream text;
  text << "camera: " << c.width << "x" << c.height << " px, focal lengths " << rounded(c.fx, 6) << " and "
       << rounded(c.fy, 6) << " px, centre " << rounded(c.cx, 6) << ", " << rounded(c.cy, 6) << "\n"
       << "  field of view " << rounded(across, 3) << " x " << rounded(down, 3)
       << (c.wide() ? " deg; " : " deg without distortion; ") << lensInWords(c) << "\n"
       << "  looks along " << axisInWords(R_b_c.col(2)) << "; right in the image is " << axisInWords(R_b_c.col(0))
       << ", down is " << axisInWords(R_b_c.col(1)) << "\n"
       << "  sits at x " << rounded(rig.T_b_c.p.x(), 4) << ", y " << rounded(rig.T_b_c.p.y(), 4) << ", z "
       << rounded(rig.T_b_c.p.z(), 4) << " m of the IMU\n"
       << "  " << rounded(rig.camera_rate_hz, 4) << " images a second; "
       << (time_shift_s == 0
               ? std::string("same clock as the IMU")
               : "an image's time on the IMU's clock is its stamp " + std::string(time_shift_s < 0 ? "- " : "+ ") +
                     rounded(1e3 * std::abs(time_shift_s), 4) + " ms")
       << (rig.line_delay_s == 0 ? std::string()
                                 : "; rolling shutter, " + rounded(1e3 * rig.line_delay_s * c.height, 4) +
                                       " ms from the first row to the last")
       << "\n"
       << "IMU: " << rounded(rig.imu_rate_hz, 4) << " samples a second\n"
       << "  gyroscope: noise " << rounded(rig.imu_noise.gyro_noise, 4) << " rad/s/sqrt(Hz), random walk "
       << rounded(rig.imu_noise.gyro_walk, 4) << " rad/s^2/sqrt(Hz)\n"
       << axesInWords(rig.axes.G) << "  accelerometer: noise " << rounded(rig.imu_noise.accel_noise, 4)
       << " m/s^2/sqrt(Hz), random walk " << rounded(rig.imu_noise.accel_walk, 4) << " m/s^3/sqrt(Hz)\n"
       << axesInWords(rig.axes.A);
  return text.str();
}

}  // namespace lintel
