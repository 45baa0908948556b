// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/Simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/sensing/Recording.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/SegmentView.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

class SimulationTest : public testing::Test {
 protected:
  static SimulationParams quick() {
    SimulationParams params;
    params.duration_s = 0.2;
    return params;
  }
  std::string write(const std::string& name, const SimulationParams& params) const {
    std::string folder = folder_ / name;
    Simulation(params).write(folder);
    return folder;
  }

  test::TempFolder folder_;
};

TEST_F(SimulationTest, ThreadsAndRepetitionsGiveTheSameBytes) {
  SimulationParams params = quick();
  const fs::path one = write("one", params);
  params.threads = 2;
  const fs::path two = write("two", params);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(one)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_TRUE(test::bytesOf(entry.path()) == test::bytesOf(two / fs::relative(entry.path(), one))) << entry.path();
  }
  EXPECT_EQ(files, 4 + 1 + 1 + 1 + 1 + 1 + 4);  // yaml, image list, IMU, truth, lines, surfaces, images
  params.seed = 2;
  const fs::path other = write("other", params);
  EXPECT_NE(test::bytesOf(one / "mav0/imu0/data.csv"), test::bytesOf(other / "mav0/imu0/data.csv"));
}

TEST_F(SimulationTest, TheFolderReadsBackAsARecording) {
  const auto recording = openRecording(write("recording", quick()));
  const Rig expected = eurocRig(), rig = recording->rig();
  EXPECT_DOUBLE_EQ(rig.camera.fx, expected.camera.fx);
  EXPECT_DOUBLE_EQ(rig.camera.lens[1], expected.camera.lens[1]);
  EXPECT_LT((rig.T_b_c.p - expected.T_b_c.p).norm(), 1e-12);
  EXPECT_LT(rig.T_b_c.q.angularDistance(expected.T_b_c.q), 1e-7);
  EXPECT_DOUBLE_EQ(rig.imu_noise.accel_walk, expected.imu_noise.accel_walk);
  int frames = 0;
  while (const auto step = recording->next()) {
    EXPECT_EQ(step->frame.t_ns, kSimulationStart_ns + 100'000'000 + 50'000'000ll * frames);
    EXPECT_EQ(step->imu.size(), frames == 0 ? 21u : 11u);
    ++frames;
  }
  EXPECT_EQ(frames, 4);
  EXPECT_TRUE(recording->warnings().empty());
}

TEST_F(SimulationTest, GroundTruthIsTheTrajectory) {
  const Simulation simulation(quick());
  const std::string folder = folder_ / "truth";
  simulation.write(folder);
  const StampedPoses poses = readTrajectory(folder + "/mav0/state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(poses.size(), 81u);
  for (std::size_t k = 0; k < poses.size(); k += 7) {
    const Pose truth = simulation.trajectory().at(0.005 * static_cast<double>(k)).T_w_b;
    EXPECT_LT((poses[k].second.p - truth.p).norm(), 1e-9);
    EXPECT_LT(poses[k].second.q.angularDistance(truth.q), 1e-7);
  }
}

// True lines, projected by the camera model, against the grey levels across them: visible ones must be image edges.
TEST_F(SimulationTest, TrueLinesAreEdgesOfTheImages) {
  const Simulation simulation(quick());
  const Rig rig = eurocRig();
  const ImageRenderer renderer(simulation.scene(), rig.camera);
  const Pose T_w_c = simulation.trajectory().at(0.1).T_w_b * rig.T_b_c;
  const Radiance image = renderer.render(T_w_c);
  const std::vector<bool> visible = renderer.visibleLines(T_w_c);
  const ViewTest view(rig.camera, 6);
  const auto grey = [&](const Eigen::Vector2d& p) {
    return image[static_cast<std::size_t>(std::lround(p.y()) * rig.camera.width + std::lround(p.x()))];
  };
  int lines = 0, on_edge = 0, beside = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Segment3& s = simulation.scene().lines[i].segment_w;
    const auto seen =
        visible[i] ? viewSegment(view, {T_w_c.inverse() * s.start, T_w_c.inverse() * s.end}) : std::nullopt;
    if (!seen || seen->length_px() < 60) continue;
    const Eigen::Vector2d along = (seen->end_px - seen->start_px).normalized(), across(-along.y(), along.x());
    double here = 0, there = 0;  // contrast across the line, and across a parallel 5 px away
    for (const double u : {0.2, 0.35, 0.5, 0.65, 0.8}) {
      const Eigen::Vector2d p =
          rig.camera.project(seen->visible_c.start + u * (seen->visible_c.end - seen->visible_c.start));
      here += std::abs(grey(p + 1.5 * across) - grey(p - 1.5 * across));
      const Eigen::Vector2d q = p + 4.0 * across;
      there += std::abs(grey(q + 1.5 * across) - grey(q - 1.5 * across));
    }
    ++lines;
    on_edge += here > 5 * 0.015;
    beside += there > 5 * 0.015;
  }
  ASSERT_GT(lines, 25);
  EXPECT_GT(on_edge, 0.8 * lines);
  EXPECT_LT(beside, 0.6 * lines);
}

TEST_F(SimulationTest, FaultsAreWhatWasAskedFor) {
  SimulationParams params;
  params.duration_s = 1.2;
  params.drop_images_every_s = 0.5;
  EXPECT_EQ(Simulation(params).images(), 24u - 6 - 4);  // 0.5 to 0.8 s, and 1.0 s to the end
  params = quick();
  params.calibration_error = 1;
  const auto recording = openRecording(write("wrong", params));
  const double wrong_px = std::abs(recording->rig().camera.fx - eurocRig().camera.fx);
  EXPECT_GT(wrong_px, 0);
  EXPECT_LT(wrong_px, 1);
}

TEST_F(SimulationTest, ZoomedImagesShowTheMiddleLarger) {
  SimulationParams params = quick();
  params.lens = "none";
  const auto imageOf = [](const std::string& folder) {
    const fs::directory_iterator images(fs::path(folder) / "mav0/cam0/data");
    std::vector<fs::path> paths(begin(images), end(images));
    return cv::imread(std::min_element(paths.begin(), paths.end())->string(), cv::IMREAD_GRAYSCALE);
  };
  const cv::Mat wide = imageOf(write("wide", params));
  params.zoom = 2;
  const std::string folder = write("zoomed", params);
  const cv::Mat zoomed = imageOf(folder);
  const Camera camera = openRecording(folder)->rig().camera;
  EXPECT_NEAR(camera.fx, 2 * eurocRig().camera.fx, 1e-3);
  // what is at half the distance from the principal point of the one is in the other
  const cv::Matx23d larger{2, 0, -camera.cx, 0, 2, -camera.cy};
  cv::Mat expected;
  cv::warpAffine(wide, expected, larger, wide.size());
  const double apart = cv::norm(expected, zoomed, cv::NORM_L1), unlike = cv::norm(wide, zoomed, cv::NORM_L1);
  EXPECT_LT(apart, 0.3 * unlike);
}

TEST_F(SimulationTest, ImpossibleRequestsAreRefused) {
  SimulationParams params = quick();
  params.zoom = 0.1;
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
  params = quick();
  params.scene = "cellar";
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
  params = quick();
  params.motion.figure = "waltz";
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
  params = quick();
  params.motion.trajectory_file = folder_ / "nothing.tum";
  EXPECT_THROW(Simulation{params}, EvaluationError);
}

}  // namespace
}  // namespace lintel
