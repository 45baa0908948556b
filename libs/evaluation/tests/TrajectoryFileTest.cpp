// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrajectoryFile.h"

#include <gmock/gmock.h>

#include "TestFiles.h"

namespace lintel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class TrajectoryFile : public test::TestFiles {
 protected:
  /// What readTrajectory complains about in a file of this content, without the folder.
  std::string complaintAbout(const std::string& text) const {
    const std::string file = write("t", text);
    try {
      readTrajectory(file);
    } catch (const EvaluationError& error) {
      const std::string what = error.what();
      EXPECT_THAT(what, StartsWith(file));
      return what.substr(file.size());
    }
    return "nothing";
  }
};

TEST_F(TrajectoryFile, ReadsTum) {
  const StampedPoses poses = readTrajectory(
      write("a.tum", "# a comment\n1403636580.838555648 1 2 3 0 0 0.6 0.8\r\n\n  1403636580.9\t4 5 6 0 0 0 1  \n"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].first, 1403636580838555648);
  EXPECT_EQ(poses[1].first, 1403636580900000000);
  EXPECT_EQ(poses[0].second.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(poses[0].second.q.z(), 0.6);
  EXPECT_DOUBLE_EQ(poses[0].second.q.w(), 0.8);
}

TEST_F(TrajectoryFile, ReadsScientificTimesToTheNanosecond) {
  const StampedPoses poses = readTrajectory(write("a.tum", "1.403715529112143517e+09 0 0 0 0 0 0 +1e0\n"));
  EXPECT_EQ(poses.at(0).first, 1403715529112143517);
}

TEST_F(TrajectoryFile, ReadsEurocStates) {
  const StampedPoses poses = readTrajectory(
      write("data.csv", "#timestamp [ns], p_RS_R_x [m], ...\n1403636580838555648,1, 2,3,0.8,0.6,0,0,9,9,9\n"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].first, 1403636580838555648);
  EXPECT_EQ(poses[0].second.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(poses[0].second.q.w(), 0.8);
  EXPECT_DOUBLE_EQ(poses[0].second.q.x(), 0.6);
}

TEST(AtImageStamps, AnImageWithStampTShowsTheWorldAtTPlusOffset) {
  const StampedPoses moved = atImageStamps({{1'000'000'000, {}}, {2'000'000'000, {}}}, 0.02);
  EXPECT_EQ(moved[0].first, 980'000'000);
  EXPECT_EQ(moved[1].first, 1'980'000'000);
}

TEST_F(TrajectoryFile, NormalisesRoundedQuaternions) {
  EXPECT_NEAR(readTrajectory(write("a", "1 0 0 0 0 0 0 1.01\n")).at(0).second.q.norm(), 1, 1e-15);
}

TEST_F(TrajectoryFile, NamesTheLineOfAFault) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(complaintAbout(good + "2 0 0 0 0 0 1\n"), AllOf(StartsWith(":2: "), HasSubstr("t x y z qx qy qz qw")));
  EXPECT_THAT(complaintAbout(good + "2 0 x 0 0 0 0 1\n"), StartsWith(":2: column 3 should be a number, but is 'x'"));
  EXPECT_THAT(complaintAbout(good + "2 0 1.5m 0 0 0 0 1\n"), StartsWith(":2: column 3"));
  EXPECT_THAT(complaintAbout(good + "2 0 nan 0 0 0 0 1\n"), StartsWith(":2: column 3 is not finite"));
  EXPECT_THAT(complaintAbout(good + "2 0 0 0 0 0 0 0.1\n"), AllOf(StartsWith(":2: "), HasSubstr("quaternion")));
  EXPECT_THAT(complaintAbout("\n" + good + "0.5 0 0 0 0 0 0 1\n"), StartsWith(":3: the time goes back"));
  EXPECT_THAT(complaintAbout("1403636580838555648 0 0 0 0 0 0 1\n"), StartsWith(":1: the time is not in seconds"));
  EXPECT_THAT(complaintAbout(good + "2,0,0,0,1,0,0,0\n"), StartsWith(":2: a TUM pose"));
  EXPECT_THAT(complaintAbout("1.5,0,0,0,1,0,0,0\n"),
              StartsWith(":1: column 1 should be a time in integer nanoseconds"));
}

TEST_F(TrajectoryFile, NamesFilesThatAreNoTrajectories) {
  EXPECT_THAT(complaintAbout("# only a comment\n"), StartsWith(": holds no poses"));
  EXPECT_THROW(readTrajectory(path("absent")), EvaluationError);
  EXPECT_THROW(readTrajectory(path("")), EvaluationError);  // a folder
}

TEST_F(TrajectoryFile, KeepsTwoPosesOfOneTime) {
  EXPECT_EQ(readTrajectory(write("a", "1 0 0 0 0 0 0 1\n1 5 0 0 0 0 0 1\n")).size(), 2u);
}

}  // namespace
}  // namespace lintel
