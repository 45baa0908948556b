// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Results.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "lintel/mapping/MapFile.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

OdometryResult refinedResult() {
  OdometryResult result;
  result.trajectory = {{1'000'000'007, {{1, 0, 0, 0}, {1, 2, 3}}}};
  result.refined_trajectory = {{1'000'000'007, {{1, 0, 0, 0}, {1, 2, 4}}}};
  result.refinement.accepted = true;
  result.map.configuration = "estimator:\n  keyframes: 8\n";
  MapLine line;
  line.segment_w = {{0, 0, 0}, {0, 0, 2}};
  result.map.lines.push_back(line);
  return result;
}

TEST(TrajectoryText, IsTumWithNineDecimals) {
  const Pose pose{{0.5, 0.5, -0.5, 0.5}, {1.25, -2, 3e-9}};  // w x y z
  EXPECT_EQ(trajectoryText({{1'403'636'579'763'555'584, pose}, {1'000'000'007, pose}}),
            "# timestamp tx ty tz qx qy qz qw\n"
            "1403636579.763555584 1.250000000 -2.000000000 0.000000003 0.500000000 -0.500000000 0.500000000 "
            "0.500000000\n"
            "1.000000007 1.250000000 -2.000000000 0.000000003 0.500000000 -0.500000000 0.500000000 0.500000000\n");
}

TEST(TrajectoryText, NoPosesAreAHeader) { EXPECT_EQ(trajectoryText({}), "# timestamp tx ty tz qx qy qz qw\n"); }

TEST(CovarianceText, IsARowOfTheUpperTriangleForEachPose) {
  OdometryPose pose{1'000'000'007, Pose(), {}};
  for (std::size_t k = 0; k < pose.covariance.size(); ++k) pose.covariance[k] = static_cast<float>(k + 1);
  const std::string text = covarianceText({pose});
  EXPECT_EQ(text.find("# timestamp,x_x,x_y,x_z,x_yaw,x_pitch,x_roll,y_y,"), 0u) << text;
  // upright: yaw turns about z, the last of the tangent's axes, and roll about x
  EXPECT_NE(text.find("\n1.000000007,1.000000000e+00,2.000000000e+00,3.000000000e+00,6.000000000e+00,5.000000000e+00,"
                      "4.000000000e+00,7.000000000e+00,"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(covarianceText({}).find('\n'), covarianceText({}).size() - 1) << "no poses are a header";
}

TEST(WriteResults, WritesEveryFileIntoAFolderThatItMakes) {
  const test::TempFolder work;
  const std::string out = work / "deep/out";
  const OdometryResult result = refinedResult();
  const auto exported = writeResults(result, out, {"csv", "obj"});
  EXPECT_EQ(exported, (std::vector<std::string>{out + "/map.csv", out + "/map.obj"}));
  EXPECT_EQ(bytesOf(out + "/trajectory.tum"), trajectoryText(result.trajectory));
  EXPECT_EQ(bytesOf(out + "/trajectory_covariance.csv"), covarianceText(result.trajectory));
  EXPECT_EQ(bytesOf(out + "/trajectory_refined.tum"), trajectoryText(result.refined_trajectory));
  EXPECT_EQ(bytesOf(out + "/config.yaml"), result.map.configuration);
  const LineMap map = readMap(out + "/map.lintel");
  EXPECT_EQ(map.lines.size(), 1u);
  EXPECT_EQ(map.configuration, result.map.configuration);
  for (const std::string& file : exported) EXPECT_FALSE(bytesOf(file).empty()) << file;
}

TEST(WriteResults, RefinedTrajectoryAndStatisticsOfAnEarlierRunDoNotStay) {
  const test::TempFolder work;
  OdometryResult result = refinedResult();
  writeResults(result, work / "out");
  std::ofstream(work / "out/stats.json") << "{}";
  result.refinement.accepted = false;
  writeResults(result, work / "out");
  EXPECT_FALSE(fs::exists(work / "out/trajectory_refined.tum"));
  EXPECT_FALSE(fs::exists(work / "out/stats.json")) << "a run killed from here on would be taken for whole";
  EXPECT_TRUE(fs::exists(work / "out/trajectory.tum"));
}

TEST(WriteResults, AMaskThatWasFoundIsAGraymap) {
  const test::TempFolder work;
  OdometryResult result = refinedResult();
  result.found_mask = std::make_shared<GrayImage>(GrayImage{3, 2, {255, 255, 255, 0, 0, 255}});
  writeResults(result, work / "out");
  EXPECT_EQ(bytesOf(work / "out/mask.pgm"), std::string("P5\n3 2\n255\n\xff\xff\xff\0\0\xff", 17));
}

TEST(WriteResults, AMaskOfAnEarlierRunStaysOnlyIfItMayHaveBeenGiven) {
  const test::TempFolder work;
  OdometryResult result = refinedResult();
  std::ofstream(work / "mask.pgm") << "P5";
  result.rig.mask = std::make_shared<GrayImage>();
  writeResults(result, work / "");
  EXPECT_TRUE(fs::exists(work / "mask.pgm"));
  result.rig.mask.reset();
  writeResults(result, work / "");
  EXPECT_FALSE(fs::exists(work / "mask.pgm"));
}

TEST(WriteResults, AFolderThatCannotBeMadeIsNamed) {
  const test::TempFolder work;
  std::ofstream(work / "file") << "in the way";
  try {
    writeResults(refinedResult(), work / "file/out");
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("file/out: cannot be made"), std::string::npos) << error.what();
  }
}

TEST(WriteResults, AnUnknownFormIsRefused) {
  const test::TempFolder work;
  EXPECT_THROW(writeResults(refinedResult(), work / "out", {"unheardof"}), std::runtime_error);
}

}  // namespace
}  // namespace lintel
