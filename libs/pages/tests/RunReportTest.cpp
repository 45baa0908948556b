// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pages/RunReport.h"

#include <gmock/gmock.h>

#include "RunAdvice.h"

namespace lintel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A run without a fault: 10 s along a curve.
struct GoodRun {
  OdometryResult result;
  RunSeries series;
  RunRecord record;

  GoodRun() {
    record.input = "/data/hall/mav0";
    record.configuration = record.defaults = "a: 1\nb:\n  c: 2\n";
    record.calibration.camera.fx = record.calibration.camera.fy = 460;
    result.rig = record.calibration;
    OdometryStatistics& s = result.statistics;
    for (int i = 0; i < 200; ++i) {
      const std::int64_t t_ns = i * std::int64_t{50000000};
      const Pose T_w_b{Eigen::Quaterniond::Identity(), {0.05 * i, std::sin(0.05 * i), 0}};
      result.trajectory.push_back({t_ns, T_w_b});
      record.groundtruth.emplace_back(t_ns, T_w_b);
      FrameTracks tracks;
      tracks.points.resize(120);
      WindowUpdate update;
      update.t_ns = t_ns;
      update.status = EstimatorStatus::kTracking;
      update.points_used = 100;
      series.add(tracks, update);
    }
    s.frames = s.frames_with_pose = s.window_frames = 200;
    s.last_frame_ns = result.trajectory.back().t_ns;
    s.first_pose_s = 0.9;
    s.mean_points_used = 100;
  }
  std::vector<std::string> advice() const {
    return adviceFor(result, record.calibration, series, record.recording_warnings);
  }
};

/// What recordings say is shown, never run.
TEST(RunReport, EscapesWhatRecordingsSay) {
  const std::string hostile = "<script>alert('&')</script>";
  GoodRun run;
  run.record.input = "/data/" + hostile;
  run.record.configuration = "a: " + hostile + "\n";
  run.record.recording_warnings = {"topic " + hostile + ": image missing"};
  run.record.truth_fault = hostile;
  run.record.groundtruth.clear();
  run.result.statistics.failures = {hostile};
  run.result.statistics.resets = 1;
  run.result.verdict = run.result.error = run.result.refinement.verdict = hostile;
  const std::string page = runReport(run.record, run.result, run.series);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert("));
}

TEST(RunAdvice, AGoodRunNeedsNone) { EXPECT_THAT(GoodRun().advice(), IsEmpty()); }

TEST(RunAdvice, SaysWhatToDoAboutEachFault) {
  GoodRun run;
  run.result.statistics.resets = 1;
  run.result.statistics.failures = {"at 3.20 s: too few points"};
  run.result.rig.camera.fx = 480;
  run.result.rig.T_b_c.p.x() = 0.05;
  run.result.time_offset_s = 0.012;
  run.result.refinement.accepted = true;
  run.result.refinement.least_offset_s = -0.004, run.result.refinement.most_offset_s = 0.0045;
  run.record.recording_warnings = {"data.csv:7: image missing"};
  const auto advice = run.advice();
  for (const char* words :
       {"at 3.20 s: too few points", "Calibrate it again", "5.0 cm", "12.0 ms", "changed by 8.5 ms", "data.csv:7"})
    EXPECT_THAT(advice, Contains(HasSubstr(words)));
}

TEST(RunAdvice, WithoutAPoseItSaysHowToGetOne) {
  GoodRun run;
  run.result.statistics.frames_with_pose = 0;
  run.result.statistics.main_wait = "too little parallax";
  EXPECT_THAT(run.advice(), Contains(HasSubstr("(too little parallax). Start where the camera moves")));
}

TEST(RunReport, ShowsErrorsOnlyWithGroundTruth) {
  GoodRun run;
  EXPECT_THAT(runReport(run.record, run.result, run.series), HasSubstr("position error (RMSE)"));
  run.record.groundtruth.clear();
  const std::string page = runReport(run.record, run.result, run.series);
  EXPECT_THAT(page, Not(HasSubstr("position error (RMSE)")));
  EXPECT_THAT(page, HasSubstr("carries no ground truth"));
  EXPECT_THAT(page, HasSubstr("<h1>Run on hall</h1>"));
}

TEST(RunReport, ErrorsAreThoseAtTheTimesThatImagesShow) {
  GoodRun run;
  const std::string right = "0.0000 m, at most 0.0000 m";
  ASSERT_THAT(runReport(run.record, run.result, run.series), HasSubstr(right));
  for (auto& [t_ns, pose] : run.record.groundtruth) t_ns += 50'000'000;  // the IMU's clock
  EXPECT_THAT(runReport(run.record, run.result, run.series), Not(HasSubstr(right)));
  run.result.time_offset_s = 0.05;
  EXPECT_THAT(runReport(run.record, run.result, run.series), HasSubstr(right));
}

TEST(RunReport, ShowsPlacesSeenAgainAndWhyOthersWereRefused) {
  GoodRun run;
  EXPECT_THAT(runReport(run.record, run.result, run.series), Not(HasSubstr("Places seen again"))) << "not looked for";
  LoopResult& loops = run.result.loops;
  loops.searched = true;
  EXPECT_THAT(runReport(run.record, run.result, run.series), HasSubstr("0 pairs of 0 images"));
  const auto at = [&](int i) { return run.result.trajectory[static_cast<std::size_t>(i)].t_ns; };
  PlacePair pair;
  pair.points = 33;
  for (const int i : {150, 154, 190}) {  // two visits
    pair.earlier_ns = at(i - 150), pair.later_ns = at(i);
    pair.drift_m = 0.25;
    loops.places.pairs.push_back(pair);
    loops.drift_before_m.push_back(0.25);
    loops.drift_after_m.push_back(0.0125);
  }
  loops.places.pairs.back().earlier_ns = at(120);
  pair.refusal = "its points cover little of the image";
  loops.places.pairs.push_back(pair);
  const std::string page = runReport(run.record, run.result, run.series);
  EXPECT_THAT(page, HasSubstr("3 pairs of"));
  EXPECT_THAT(page, HasSubstr("7.5 to 7.7"));
  EXPECT_THAT(page, HasSubstr("6.0 to 6.0"));
  EXPECT_THAT(page, HasSubstr("0.250"));
  EXPECT_THAT(page, HasSubstr("0.013"));
  EXPECT_THAT(page, HasSubstr("1: its points cover little of the image"));
}

TEST(RunReport, SaysWhichPiecesAreInOneFrame) {
  GoodRun run;
  EXPECT_THAT(runReport(run.record, run.result, run.series), Not(HasSubstr("Pieces between interruptions")));
  const auto at = [&](int i) { return run.result.trajectory[static_cast<std::size_t>(i)].t_ns; };
  run.result.map.pieces = {
      {0, at(0), at(50), 0, 0, 0}, {5, at(60), at(90), 60, 1, 0}, {9, at(100), at(150), 100, 0, 0}};
  const std::string page = runReport(run.record, run.result, run.series);
  EXPECT_THAT(page, HasSubstr("Pieces between interruptions"));
  EXPECT_THAT(page, HasSubstr("its own"));
  EXPECT_THAT(page, HasSubstr("No place of piece 2 was found in those before"));
}

TEST(RunReport, ShowsOptionsThatDiffer) {
  GoodRun run;
  run.record.configuration = "a: 1\nb:\n  c: 3\n";
  const std::string page = runReport(run.record, run.result, run.series);
  EXPECT_THAT(page, HasSubstr("<pre>b.c = 3\n</pre>"));
}

TEST(RunReport, OfARunThatFoundNothing) {
  GoodRun run;
  run.result = {};
  EXPECT_THAT(runReport(run.record, run.result, RunSeries()), HasSubstr("No pose was found"));
}

}  // namespace
}  // namespace lintel
