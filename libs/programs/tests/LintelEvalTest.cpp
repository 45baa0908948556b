// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelEval.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class LintelEvalProgram : public ::testing::Test {
 protected:
  int run(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv = {"lintel-eval"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    out_.str("");
    err_.str("");
    return runLintelEval(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string path(const std::string& name) const { return folder_ / name; }
  static nlohmann::json read(const std::string& file) { return nlohmann::json::parse(std::ifstream(file)); }

  /// A true flight of 4 s and a map in a frame of its own: turned by 90 degrees, the second line 3 cm off.
  void writeRecordingAndMap() {
    std::string states = "#timestamp\n";
    LineMap map;
    const Pose T_e_w{expRotation({0, 0, 1.5707963267948966}), {5, 6, 7}};
    for (int i = 0; i <= 4; ++i) {
      const Pose T_w_b{Eigen::Quaterniond::Identity(), {1.0 * i, 0.5 * i * i, 0}};
      states += std::to_string(i) + "000000000," + std::to_string(T_w_b.p.x()) + "," + std::to_string(T_w_b.p.y()) +
                ",0,1,0,0,0\n";
      map.trajectory.emplace_back(i * std::int64_t{1000000000}, T_e_w * T_w_b);
    }
    write("mav0/state_groundtruth_estimate0/data.csv", states);
    write("mav0/lines0/data.csv", "#x0 [m],y0,z0,x1,y1,z1,frames_seen\n0,0,1,2,0,1,100\n0,5,0,0,5,2,100\n");
    for (const Segment3& segment : {Segment3{{0, 0, 1}, {2, 0, 1}}, Segment3{{0, 5.03, 0}, {0, 5.03, 2}}}) {
      MapLine line;
      line.id = map.lines.size();
      line.segment_w = {T_e_w * segment.start, T_e_w * segment.end};
      map.lines.push_back(line);
    }
    writeMap(map, path("map.lintel"));
  }

  const test::TempFolder folder_;
  std::ostringstream out_, err_;
};

TEST_F(LintelEvalProgram, EvaluatesATrajectory) {
  const std::string truth = write("gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  const std::string estimate = write("est.tum", "0 0 0 0 0 0 0 1\n1 1 2 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  ASSERT_EQ(run({"--trajectory", estimate, "--groundtruth", truth, "--align", "none", "--distances", "1,2", "--json",
                 path("out.json")}),
            0);
  EXPECT_EQ(err_.str(), "");
  EXPECT_THAT(out_.str(), HasSubstr("RMSE 1.0000  mean 0.5000  median 0.0000  max 2.0000 m"));
  EXPECT_THAT(out_.str(), HasSubstr("100.0 % of 3.0 s"));
  const auto json = read(path("out.json"));
  EXPECT_EQ(json["trajectory"]["position_m"]["rmse"], 1.0);
  EXPECT_EQ(json["trajectory"]["alignment"], "none");
  EXPECT_EQ(json["trajectory"]["relative"].size(), 3u);
  EXPECT_FALSE(json.contains("lines"));
}

TEST_F(LintelEvalProgram, ATimeOffsetMovesTheEstimatesStamps) {
  // the truth moves by 1 m/s; the estimate's stamps are 0.5 s late
  const std::string truth = write("gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 1 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  const std::string estimate =
      write("est.tum", "0.5 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n2.5 2 1 0 0 0 0 1\n3.5 3 0 0 0 0 0 1\n");
  ASSERT_EQ(run({"--trajectory", estimate, "--groundtruth", truth, "--time-offset", "-0.5", "--between", "1,3"}), 0)
      << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("3 with ground truth"));
  EXPECT_THAT(out_.str(), HasSubstr("max 0.0000 m"));
  EXPECT_EQ(run({"--trajectory", estimate, "--groundtruth", truth}), 1) << "no pose within 10 ms";
}

TEST_F(LintelEvalProgram, CovariancesBesideTheTrajectoryGiveNees) {
  const std::string truth = write("gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  const std::string estimate =
      write("est.tum", "0 0 0 0 0 0 0 1\n1 1 0.2 0 0 0 0 1\n2 2 0 0.3 0 0 0 1\n3 3 0 0 0 0 0 1\n");
  std::string rows = "# timestamp\n";
  for (int i = 0; i < 4; ++i) {
    rows += std::to_string(i);
    for (int a = 0; a < 6; ++a)
      for (int b = a; b < 6; ++b) rows += a != b || (i == 0 && a < 3) ? ",0" : ",0.01";
    rows += "\n";
  }
  write("est_covariance.csv", rows);
  const std::vector<std::string> arguments{"--trajectory", estimate,         "--groundtruth", truth,
                                           "--json",       path("out.json"), "--report",      path("out.html")};
  ASSERT_EQ(run(arguments), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("NEES"));
  const auto json = read(path("out.json"));
  EXPECT_EQ(json["consistency"]["poses"], 3);
  EXPECT_NEAR(json["consistency"]["nees_position"]["mean"].get<double>(), (4.0 + 9.0) / 3, 1e-9);
  EXPECT_NEAR(json["consistency"]["nees_yaw"]["mean"].get<double>(), 0, 1e-9);
  std::stringstream page;
  page << std::ifstream(path("out.html")).rdbuf();
  EXPECT_THAT(page.str(), HasSubstr("three standard deviations"));
  write("other.csv", "7,1\n");
  EXPECT_EQ(run({"--trajectory", estimate, "--groundtruth", truth, "--covariance", path("other.csv")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("other.csv:1"));
  EXPECT_EQ(run({"--map", "m", "--lines", "l", "--covariance", path("other.csv")}), 2);
}

TEST_F(LintelEvalProgram, AlignsTheMapByItsOwnTrajectory) {
  writeRecordingAndMap();
  ASSERT_EQ(run({"--map", path("map.lintel"), "--lines", path("mav0/lines0/data.csv"), "--json", path("out.json")}), 0)
      << err_.str();
  const auto json = read(path("out.json"));
  EXPECT_LE(json["map_trajectory"]["position_m"]["max"], 1e-9);
  EXPECT_NEAR(json["lines"]["precision"][0], 0.5, 1e-9);  // the line 3 cm off is wrong at 2 cm
  EXPECT_NEAR(json["lines"]["precision"][1], 1.0, 1e-9);
  EXPECT_NEAR(json["lines"]["recall"][0], 0.5, 1e-9);
  EXPECT_NEAR(json["lines"]["all_matched"]["distance_median_m"], 0.03, 1e-9);
  EXPECT_THAT(out_.str(), HasSubstr("map alignment   se3 by 5 poses"));
  EXPECT_EQ(json["line_sigmas"]["near_an_edge"]["tracked"]["ends"], 4);
  EXPECT_EQ(json["line_sigmas"]["edge_seen"]["tracked"]["ends"], 0) << "no keyframe saw them";
  EXPECT_THAT(out_.str(), HasSubstr("ends within 1 and 2 sigmas"));

  ASSERT_EQ(run({"--map", path("map.lintel"), "--lines", path("mav0/lines0/data.csv"), "--align", "none"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("map alignment   none"));
  EXPECT_THAT(out_.str(), HasSubstr("0.000 @10 cm  of the map"));
}

TEST_F(LintelEvalProgram, QuietPrintsNothing) {
  const std::string truth = write("gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  EXPECT_EQ(run({"--trajectory", truth, "--groundtruth", truth, "--quiet"}), 0);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(LintelEvalProgram, BadFilesAreOneLineAndOne) {
  const std::string good = write("gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  const std::string bad = write("bad.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 one\n");
  EXPECT_EQ(run({"--trajectory", bad, "--groundtruth", good}), 1);
  EXPECT_THAT(err_.str(), StartsWith("lintel-eval: " + bad + ":2: column 8"));
  const std::string other = write("other.tum", "1000 0 0 0 0 0 0 1\n");
  EXPECT_EQ(run({"--trajectory", other, "--groundtruth", good}), 1);
  EXPECT_THAT(err_.str(), StartsWith("lintel-eval: " + other + ": only 0 of 1 poses"));
  EXPECT_EQ(run({"--map", bad, "--lines", good}), 1);
  EXPECT_THAT(err_.str(), HasSubstr(bad));
  EXPECT_EQ(run({"--trajectory", good, "--groundtruth", good, "--json", path("absent/out.json")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("absent"));
}

TEST_F(LintelEvalProgram, WrongUseIsTwo) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"--trajectory", "a"}), 2);
  EXPECT_EQ(run({"--map", "a"}), 2);
  EXPECT_EQ(run({"--trajectory", "a", "--groundtruth", "b", "--align", "affine"}), 2);
  EXPECT_THAT(err_.str(), StartsWith("lintel-eval: "));
}

}  // namespace
}  // namespace lintel
