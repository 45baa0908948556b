// SPDX-License-Identifier: BSD-3-Clause
// Consistency of a written recording, without Lintel's code: files are read line by line, lines are projected and
// edges found by OpenCV, the IMU is integrated in the plainest way.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <sstream>

#include "lintel/simulation/Simulation.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using Row = std::vector<double>;

/// Numbers of a CSV file; words become 0.
std::vector<Row> readRows(const fs::path& path) {
  std::ifstream file(path);
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    Row row;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::atof(field.c_str()));
    rows.push_back(row);
  }
  return rows;
}

/// The numbers in brackets behind a key of sensor.yaml.
Row listOf(const fs::path& path, const std::string& key) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::size_t at = text.find(key);
  at = text.find('[', at) + 1;
  std::istringstream fields(text.substr(at, text.find(']', at) - at));
  Row row;
  for (std::string field; std::getline(fields, field, ',');) row.push_back(std::atof(field.c_str()));
  return row;
}

class RecordingFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    SimulationParams params;
    params.duration_s = 1;
    params.imu.noise = params.imu.biases = false;
    params.threads = 2;
    Simulation(params).write(folder_->path().string());
    mav0_ = folder_->path() / "mav0";
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Eigen::Matrix4d truthAt(std::int64_t t_ns) {
    std::ifstream file(mav0_ / "state_groundtruth_estimate0/data.csv");
    for (std::string line; std::getline(file, line);) {
      if (line[0] == '#' || std::atoll(line.c_str()) != t_ns) continue;
      Row v;
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) v.push_back(std::atof(field.c_str()));
      Eigen::Matrix4d T_w_b = Eigen::Matrix4d::Identity();
      T_w_b.topLeftCorner<3, 3>() = Eigen::Quaterniond(v[4], v[5], v[6], v[7]).toRotationMatrix();
      T_w_b.topRightCorner<3, 1>() = Eigen::Vector3d(v[1], v[2], v[3]);
      return T_w_b;
    }
    throw std::runtime_error("no true pose");
  }
  static inline std::unique_ptr<test::TempFolder> folder_;
  static inline fs::path mav0_;
};

TEST_F(RecordingFiles, TheImuIntegratesToThePoses) {
  const auto imu = readRows(mav0_ / "imu0/data.csv"), truth = readRows(mav0_ / "state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(imu.size(), truth.size());
  const Row& first = truth.front();
  Eigen::Vector3d p(first[1], first[2], first[3]), v(first[8], first[9], first[10]);
  Eigen::Quaterniond q(first[4], first[5], first[6], first[7]);
  constexpr double kStep_s = 0.005;
  for (std::size_t k = 0; k + 1 < imu.size(); ++k) {
    const auto middle = [&](int i) { return 0.5 * (imu[k][i] + imu[k + 1][i]); };
    const Eigen::Vector3d w(middle(1), middle(2), middle(3)), f(middle(4), middle(5), middle(6));
    const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5 * kStep_s * w.norm(), w.normalized()));
    const Eigen::Vector3d a = (q * half) * f - Eigen::Vector3d(0, 0, 9.81);
    p += kStep_s * v + 0.5 * kStep_s * kStep_s * a;
    v += kStep_s * a;
    q = q * half * half;
  }
  const Row& last = truth.back();
  EXPECT_LT((p - Eigen::Vector3d(last[1], last[2], last[3])).norm(), 1e-3);
  EXPECT_LT((v - Eigen::Vector3d(last[8], last[9], last[10])).norm(), 1e-3);
  EXPECT_LT(q.angularDistance(Eigen::Quaterniond(last[4], last[5], last[6], last[7])), 1e-4);
}

TEST_F(RecordingFiles, ProjectedLinesLieOnImageEdges) {
  const Row K = listOf(mav0_ / "cam0/sensor.yaml", "intrinsics"),
            D = listOf(mav0_ / "cam0/sensor.yaml", "distortion_coefficients"),
            T = listOf(mav0_ / "cam0/sensor.yaml", "data:");
  ASSERT_EQ(K.size(), 4u);
  ASSERT_EQ(T.size(), 16u);
  const Eigen::Matrix4d T_b_c = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(T.data());
  const auto lines = readRows(mav0_ / "lines0/data.csv");
  int right = 0, beside = 0, points = 0;
  for (const auto& entry : fs::directory_iterator(mav0_ / "cam0/data")) {
    const std::int64_t t_ns = std::atoll(entry.path().stem().c_str());
    if (t_ns / 50000000 % 5 != 0) continue;  // four of twenty
    const cv::Mat image = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
    cv::Mat smooth, edges, distance;
    cv::GaussianBlur(image, smooth, {}, 1);
    cv::Canny(smooth, edges, 20, 50);
    cv::distanceTransform(255 - edges, distance, cv::DIST_L2, 3);
    const Eigen::Matrix4d T_c_w = (truthAt(t_ns) * T_b_c).inverse();
    for (const Row& line : lines) {
      if (line[9] < 15) continue;  // hidden for much of the second
      std::vector<cv::Point3d> points_c;
      for (const double s : {0.2, 0.35, 0.5, 0.65, 0.8, 0.801}) {
        const Eigen::Vector3d a(line[1], line[2], line[3]), b(line[4], line[5], line[6]);
        const Eigen::Vector4d p_c = T_c_w * (a + s * (b - a)).homogeneous();
        if (p_c.z() > 0.3) points_c.emplace_back(p_c.x(), p_c.y(), p_c.z());
      }
      if (points_c.size() < 6) continue;
      std::vector<cv::Point2d> px;
      const cv::Matx33d camera(K[0], 0, K[2], 0, K[1], K[3], 0, 0, 1);
      cv::projectPoints(points_c, cv::Vec3d(), cv::Vec3d(), camera, D, px);
      cv::Point2d across(px[0].y - px[4].y, px[4].x - px[0].x);
      if (cv::norm(across) < 40) continue;
      across *= 5 / cv::norm(across);
      for (int i = 0; i < 5; ++i) {
        const cv::Point2d shifted = px[static_cast<std::size_t>(i)] + across;
        const cv::Rect2d inside(6, 6, image.cols - 12, image.rows - 12);
        if (!inside.contains(px[static_cast<std::size_t>(i)]) || !inside.contains(shifted)) continue;
        ++points;
        right += distance.at<float>(cv::Point(px[static_cast<std::size_t>(i)])) <= 1.5f;
        beside += distance.at<float>(cv::Point(shifted)) <= 1.5f;
      }
    }
  }
  ASSERT_GT(points, 300);
  EXPECT_GT(right, 0.75 * points) << right << " of " << points << ", beside " << beside;
  EXPECT_LT(beside, 0.6 * right) << right << " of " << points << ", beside " << beside;
}

}  // namespace
}  // namespace lintel
