// SPDX-License-Identifier: BSD-3-Clause
#include "TinyEuroc.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

namespace lintel::test {

namespace fs = std::filesystem;

namespace {

const char* kPose = R"(T_BS:
  cols: 4
  rows: 4
  data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,
         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,
         0.0, 0.0, 0.0, 1.0]
)";
const char* kIdentity =
    "T_BS: {cols: 4, rows: 4, data: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, "
    "1.0]}\n";

cv::Mat picture(int frame, int camera) {
  cv::Mat image(TinyEuroc::kHeight, TinyEuroc::kWidth, CV_8U);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      image.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>((x * 7 + y * 13 + frame * 31 + camera * 97 + x * y * frame) & 255);
  return image;
}

void writeCamera(const TinyEuroc& recording, const fs::path& folder, int camera) {
  fs::create_directories(folder / "data");
  writeText((folder / "sensor.yaml").string(),
            std::string("# Camera.\nsensor_type: camera\n") + kPose +
                "rate_hz: 20\nresolution: [32, 24]\ncamera_model: pinhole\n"
                "intrinsics: [31.654, 30.296, 15.215, 12.375] #fu, fv, cu, cv\n"
                "distortion_model: radial-tangential\n"
                "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n");
  std::string csv = "#timestamp [ns],filename\n";
  for (int i = 0; i < recording.frames; ++i) {
    const std::string stamp = std::to_string(TinyEuroc::frameStamp(i));
    csv.append(stamp).append(",").append(stamp).append(".png\r\n");
    cv::imwrite((folder / "data" / (stamp + ".png")).string(), picture(i, camera));
  }
  writeText((folder / "data.csv").string(), csv);
}

void writeImu(const TinyEuroc& recording, const fs::path& folder) {
  fs::create_directories(folder);
  writeText((folder / "sensor.yaml").string(),
            std::string("%YAML:1.0\n# IMU.\nsensor_type: imu\n") + kIdentity +
                "rate_hz: 200\ngyroscope_noise_density: 1.7e-04\n"
                "gyroscope_random_walk: 2.1e-05 # [ rad / s^2 / sqrt(Hz) ]\n"
                "accelerometer_noise_density: 2.3e-3\naccelerometer_random_walk: 3.3e-3\n");
  std::ostringstream csv;
  csv << std::setprecision(17) << "#timestamp [ns],w_RS_S_x [rad s^-1],…\n";
  const std::int64_t begin = TinyEuroc::kFirst_ns - std::llround(recording.imu_lead_s * 1e9) + 1234567;
  for (std::int64_t t = begin; t < TinyEuroc::frameStamp(recording.frames) + 20000000; t += 5000000) {
    const Eigen::Vector3d w = TinyEuroc::gyroAt(t), a = TinyEuroc::accelAt(t);
    csv << t << "," << w.x() << "," << w.y() << "," << w.z() << "," << a.x() << "," << a.y() << "," << a.z() << "\n";
  }
  writeText((folder / "data.csv").string(), csv.str());
}

void writeGroundtruth(const TinyEuroc& recording, const fs::path& folder) {
  fs::create_directories(folder);
  std::string csv = "#timestamp, p_RS_R_x [m], …\n";
  for (int i = 0; i < recording.frames; ++i)
    csv += std::to_string(TinyEuroc::frameStamp(i) + 3000000) + ",1.5,2.5," + std::to_string(i) +
           ",0.6,0.8,0,0,0,0,0,0,0,0,0,0,0\n";
  writeText((folder / "data.csv").string(), csv);
}

}  // namespace

void TinyEuroc::write(const std::string& root) const {
  const fs::path mav0 = fs::path(root) / "mav0";
  for (std::size_t i = 0; i < cameras.size(); ++i) writeCamera(*this, mav0 / cameras[i], static_cast<int>(i));
  writeImu(*this, mav0 / "imu0");
  if (groundtruth) writeGroundtruth(*this, mav0 / "state_groundtruth_estimate0");
}

Eigen::Vector3d TinyEuroc::gyroAt(std::int64_t t_ns) {
  const double s = static_cast<double>(t_ns - kFirst_ns) * 1e-9;
  return {0.1 + 0.3 * s, -0.2 + 0.1 * s, 0.7 * s};
}

Eigen::Vector3d TinyEuroc::accelAt(std::int64_t t_ns) {
  const double s = static_cast<double>(t_ns - kFirst_ns) * 1e-9;
  return {9.1 - 0.5 * s, 0.2 * s, -4.3 + s};
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

void replaceInFile(const std::string& path, const std::string& from, const std::string& to) {
  std::string text = bytesOf(path);
  const std::size_t place = text.find(from);
  ASSERT_NE(place, std::string::npos) << from << " is not in " << path;
  writeText(path, text.replace(place, from.size(), to));
}

Everything readAll(Recording& recording) {
  Everything all;
  try {
    while (auto step = recording.next()) all.steps.push_back(std::move(*step));
  } catch (const RecordingError& error) {
    all.error = error.what();
  }
  all.warnings = recording.warnings();
  return all;
}

Everything readAll(const std::string& path, const RecordingParams& params) {
  return readAll(*openRecording(path, params));
}

std::string openingError(const std::string& path, const RecordingParams& params) {
  try {
    openRecording(path, params);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "";
}

void expectSameSteps(const std::vector<FrameWithImu>& a, const std::vector<FrameWithImu>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].frame.t_ns, b[i].frame.t_ns) << "frame " << i;
    ASSERT_EQ(a[i].frame.image->pixels, b[i].frame.image->pixels) << "frame " << i;
    ASSERT_EQ(a[i].imu.size(), b[i].imu.size()) << "frame " << i;
    for (std::size_t k = 0; k < a[i].imu.size(); ++k) {
      ASSERT_EQ(a[i].imu[k].t_ns, b[i].imu[k].t_ns);
      ASSERT_EQ(a[i].imu[k].gyro, b[i].imu[k].gyro);
      ASSERT_EQ(a[i].imu[k].accel, b[i].imu[k].accel);
    }
  }
}

void expectSameRig(const Rig& a, const Rig& b) {
  const auto numbers = [](const Rig& rig) {
    const Camera& c = rig.camera;
    const Pose& T = rig.T_b_c;
    const ImuNoise& n = rig.imu_noise;
    return std::vector<double>{double(c.width),
                               double(c.height),
                               c.fx,
                               c.fy,
                               c.cx,
                               c.cy,
                               double(c.model),
                               c.lens[0],
                               c.lens[1],
                               c.lens[2],
                               c.lens[3],
                               c.lens[4],
                               c.lens[5],
                               c.lens[6],
                               c.lens[7],
                               T.q.w(),
                               T.q.x(),
                               T.q.y(),
                               T.q.z(),
                               T.p.x(),
                               T.p.y(),
                               T.p.z(),
                               rig.camera_rate_hz,
                               rig.imu_rate_hz,
                               n.gyro_noise,
                               n.gyro_walk,
                               n.accel_noise,
                               n.accel_walk};
  };
  EXPECT_EQ(numbers(a), numbers(b));
  EXPECT_EQ(a.axes.A, b.axes.A);
  EXPECT_EQ(a.axes.G, b.axes.G);
}

}  // namespace lintel::test
