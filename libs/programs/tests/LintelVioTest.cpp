// SPDX-License-Identifier: BSD-3-Clause
// lintel-vio in process on a short simulated recording, which all cases share.
#include "lintel/programs/LintelVio.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "VioTestRuns.h"
#include "lintel/core/FolderLock.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pipeline/Results.h"
#include "lintel/simulation/Simulation.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using namespace test;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDuration_s = 4;
constexpr char kNoSearch[] = "densification.enabled=false";  // a third of the time; one test is about it
constexpr int kStartFrames = 19;  // of the shortest start: ten window frames at 10 Hz, and those between

class LintelVioTest : public testing::Test {
 protected:
  /// The recording, and the run on it that the others are compared with: made once, for the derived suite too.
  static void SetUpTestSuite() {
    if (work_) return;
    work_ = std::make_unique<TempFolder>();
    SimulationParams params;
    params.duration_s = kDuration_s;
    params.threads = 2;
    Simulation(params).write(recording());
    reference_ = runVio({recording(), "-o", out("reference"), "-c", eurocConfig(), "--export", "none", "--threads", "1",
                         "--set", kNoSearch});
  }

  void SetUp() override { ASSERT_EQ(reference_.exit_code, 0) << reference_.err; }

  static std::string recording() { return *work_ / "recording"; }
  static std::string out(const std::string& name) { return *work_ / ("out_" + name); }

  static ProgramRun run(const std::string& input, const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {input, "-o", out(name), "-c", eurocConfig(), "--export", "none", "--quiet", "--set", kNoSearch});
    return runVio(more);
  }
  static void expectSameAsReference(const std::string& name) {
    for (const char* file : {"/trajectory.tum", "/map.lintel"}) {
      EXPECT_FALSE(bytesOf(out(name) + file).empty());
      EXPECT_TRUE(bytesOf(out(name) + file) == bytesOf(out("reference") + file)) << file << " differs in " << name;
    }
  }
  /// One line on stderr that starts with the program's name and contains `what`.
  static void expectOneLine(const ProgramRun& run, const std::string& what) {
    EXPECT_THAT(run.err, StartsWith("lintel-vio: "));
    EXPECT_THAT(run.err, HasSubstr(what));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  /// A copy of the recording with its own files (no links).
  static std::string copyOfRecording(const std::string& name) {
    std::string copy = *work_ / name;
    fs::copy(recording(), copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    return copy;
  }
  /// The recording as a rawlog with its images inside, made when it is first asked for.
  static std::string embeddedRawlog() {
    std::string rawlog = *work_ / "embedded.rawlog";
    if (!fs::exists(rawlog)) {
      EXPECT_EQ(runConverter({"-q", "--embed", "-z", "1", "-i", recording(), "-o", rawlog}).exit_code, 0);
    }
    return rawlog;
  }
  /// The map has poses of the frames that the start was made of, and of those that `causal` has.
  static void expectPosesOfTheMap(const std::string& name, const StampedPoses& causal) {
    const auto poses = readMap(out(name) + "/map.lintel").trajectory;
    const auto causal_from =
        std::find_if(poses.begin(), poses.end(), [&](const auto& pose) { return pose.first == causal.front().first; });
    EXPECT_EQ(causal_from - poses.begin(), kStartFrames - 1) << "frames at 20 Hz from the first of the start";
    EXPECT_EQ(static_cast<std::size_t>(poses.end() - causal_from), causal.size());
  }
  /// A run that broke off: what was computed until then is there and fits together.
  static void expectKept(const std::string& name) {
    const StampedPoses part = readTrajectory(out(name) + "/trajectory.tum");
    const StampedPoses whole = readTrajectory(out("reference") + "/trajectory.tum");
    ASSERT_FALSE(part.empty());
    ASSERT_LT(part.size(), whole.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      EXPECT_EQ(part[i].first, whole[i].first);
      EXPECT_EQ(part[i].second.p, whole[i].second.p) << "pose " << i;
    }
    expectPosesOfTheMap(name, part);
    const auto statistics = nlohmann::json::parse(bytesOf(out(name) + "/stats.json"));
    EXPECT_NE(statistics["ended_early"], "");
  }

  static inline std::unique_ptr<TempFolder> work_;
  static inline ProgramRun reference_;
};

TEST_F(LintelVioTest, InfoDescribesARecordingAndSavesItsRig) {
  const std::string rig = *work_ / "rig.yaml";
  const ProgramRun info = runVio({recording(), "--info", "--save-calibration", rig});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("cam0"));
  EXPECT_THAT(info.out, HasSubstr("20.0 Hz  images"));
  EXPECT_THAT(info.out, HasSubstr("looks along"));
  EXPECT_EQ(runVio({recording(), "--info", "--save-calibration", rig}).exit_code, 1);  // exists
  const ProgramRun again = runVio({"--info", "--calibration", rig, "--save-calibration", rig, "--form", "vins", "-w"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, info.out.substr(info.out.find("camera: ")));
  EXPECT_THAT(bytesOf(rig), HasSubstr("!!opencv-matrix"));
  EXPECT_EQ(runVio({"--info"}).exit_code, 2);
}

TEST_F(LintelVioTest, WritesWhatItPromisesAndSaysSo) {
  const StampedPoses trajectory = readTrajectory(out("reference") + "/trajectory.tum");
  EXPECT_GE(trajectory.size(), 30u);
  const LineMap map = readMap(out("reference") + "/map.lintel");
  expectPosesOfTheMap("reference", trajectory);
  const StampedPoses refined = readTrajectory(out("reference") + "/trajectory_refined.tum");
  ASSERT_EQ(refined.size(), map.trajectory.size());
  EXPECT_EQ(refined.front().first, map.trajectory.front().first);
  EXPECT_GT(map.keyframes.size(), 3u);
  EXPECT_GT(map.points.size(), 20u);
  EXPECT_EQ(map.configuration, bytesOf(out("reference") + "/config.yaml"));
  const auto statistics = nlohmann::json::parse(bytesOf(out("reference") + "/stats.json"));
  EXPECT_EQ(statistics["frames"], kDuration_s * 20);
  EXPECT_EQ(statistics["frames_with_pose"], trajectory.size());
  EXPECT_EQ(statistics["map_lines"], map.lines.size());
  EXPECT_EQ(statistics["ended_early"], "");
  EXPECT_THAT(reference_.out, HasSubstr(std::to_string(trajectory.size()) + " with a pose"));
  EXPECT_THAT(reference_.out, HasSubstr("trajectory.tum"));
}

TEST_F(LintelVioTest, ResumesWhatBrokeOffAndLeavesWhatIsDone) {
  const std::string before = bytesOf(out("reference") + "/stats.json");
  const std::vector<std::string> command{recording(),   "-o",       out("reference"), "-c",
                                         eurocConfig(), "--export", "none",           "--threads",
                                         "1",           "--set",    kNoSearch,        "--resume"};
  ProgramRun again = runVio(command);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("holds the whole results of this command already"));
  EXPECT_EQ(bytesOf(out("reference") + "/stats.json"), before);

  again = runVio({recording(), "-o", out("reference"), "--resume", "--from", "1"});
  EXPECT_EQ(again.exit_code, 1);
  expectOneLine(again, "holds the results of another command or configuration");
  EXPECT_EQ(bytesOf(out("reference") + "/stats.json"), before);

  fs::create_directories(out("killed"));
  fs::copy_file(out("reference") + "/trajectory.tum", out("killed") + "/trajectory.partial.tum");
  {
    const FolderLock other(out("killed"));  // a run that goes on has such a file too
    again = run(recording(), "killed", {"--threads", "1", "--resume"});
    EXPECT_EQ(again.exit_code, 1);
    expectOneLine(again, "another run is writing to it");
  }
  again = run(recording(), "killed", {"--threads", "1", "--resume"});
  EXPECT_EQ(again.exit_code, 0);
  expectOneLine(again, "the earlier run broke off (it was killed)");
  expectSameAsReference("killed");
  EXPECT_FALSE(fs::exists(out("killed") + "/trajectory.partial.tum"));
}

TEST_F(LintelVioTest, LeavesOutLinesThatCrowdTheMapAndSaysSo) {
  const ProgramRun r = runVio({recording(), "-o", out("spaced"), "-c", eurocConfig(), "--export", "none", "--set",
                               kNoSearch, "--set", "map.spacing.min_m=0.5", "--set", "map.spacing.min_relative=1"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto spaced = nlohmann::json::parse(bytesOf(out("spaced") + "/stats.json"));
  const auto reference = nlohmann::json::parse(bytesOf(out("reference") + "/stats.json"));
  const int beside = spaced["map_lines_beside"];
  EXPECT_GT(beside, reference["map_lines_beside"].get<int>());
  EXPECT_EQ(spaced["map_lines"].get<int>() + beside,
            reference["map_lines"].get<int>() + reference["map_lines_beside"].get<int>())
      << "the lines are the same";
  EXPECT_EQ(readMap(out("spaced") + "/map.lintel").lines.size(), spaced["map_lines"]);
  EXPECT_THAT(r.out, HasSubstr(std::to_string(beside) + " more lines run beside better seen ones"));
}

TEST_F(LintelVioTest, FollowsTheTruth) {
  const TrajectoryErrors errors =
      evaluateTrajectory(readTrajectory(out("reference") + "/trajectory.tum"),
                         readTrajectory(recording() + "/mav0/state_groundtruth_estimate0/data.csv"));
  EXPECT_LT(errors.position_m.rmse, 0.05);
}

class LintelVioCancelTest : public LintelVioTest {
 protected:
  /// The same run by the C++ interface, on one thread or two.
  OdometryResult run(const RunOptions& options) {
    Configuration configuration;
    readConfiguration(eurocConfig(), configuration);
    configuration.refinement.enabled = refine_;
    return runOdometry(*openRecording(recording()), configuration, options);
  }
  static void expectSamePoses(const std::vector<OdometryPose>& poses, std::size_t number) {
    const StampedPoses reference = readTrajectory(out("reference") + "/trajectory.tum");
    ASSERT_LE(number, reference.size());
    ASSERT_EQ(poses.size(), number);
    for (std::size_t i = 0; i < number; ++i) {
      EXPECT_EQ(poses[i].t_ns, reference[i].first);
      EXPECT_LT((poses[i].T_w_b.p - reference[i].second.p).norm(), 1e-8) << "pose " << i;
    }
  }
  bool refine_ = true;
};

TEST_F(LintelVioCancelTest, ARunCancelledOnItsWayKeepsTrajectoryAndMapUntilThen) {
  for (const int threads : {1, 2}) {
    std::size_t done = 0;
    RunOptions options;
    options.threads = threads;
    options.progress = [&](const RunProgress& progress) {
      EXPECT_EQ(progress.stage, RunStage::kFrames) << "there is no time for a refinement";
      done = progress.done;
    };
    options.cancelled = [&] { return done >= 60; };
    const OdometryResult result = run(options);
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(result.statistics.frames, 60u);
    EXPECT_EQ(result.refinement.verdict, "not refined: the run was cancelled");
    EXPECT_TRUE(result.refined_trajectory.empty());
    expectSamePoses(result.trajectory, result.statistics.frames_with_pose);
    EXPECT_GT(result.trajectory.size(), 20u);
    EXPECT_EQ(result.map.trajectory.size(), result.trajectory.size() + kStartFrames - 1) << "the start's frames, too";
    EXPECT_GT(result.map.keyframes.size(), 3u);
    EXPECT_GT(result.map.lines.size(), 3u);
    writeResults(result, out("cancelled"));
    EXPECT_EQ(readMap(out("cancelled") + "/map.lintel").lines.size(), result.map.lines.size());
  }
}

TEST_F(LintelVioCancelTest, ARefinementThatIsCancelledLeavesTheCausalMap) {
  double refined = 0;
  RunOptions options;
  options.progress = [&](const RunProgress& progress) {
    if (progress.stage == RunStage::kRefinement) refined = static_cast<double>(progress.done);
  };
  options.cancelled = [&] { return refined >= 30; };
  const OdometryResult result = run(options);
  refine_ = false;
  const OdometryResult causal = run({});
  EXPECT_TRUE(result.cancelled);
  EXPECT_FALSE(causal.cancelled);
  EXPECT_FALSE(result.refinement.accepted);
  EXPECT_EQ(result.refinement.verdict, "not refined: the run was cancelled");
  expectSamePoses(result.trajectory, causal.trajectory.size());
  ASSERT_EQ(result.map.lines.size(), causal.map.lines.size());
  for (std::size_t i = 0; i < causal.map.lines.size(); ++i)
    EXPECT_EQ(result.map.lines[i].segment_w.start, causal.map.lines[i].segment_w.start);
}

/// Sends this process a signal as soon as the run has saved poses.
ProgramRun runStoppedBy(int signal, const std::string& recording, const std::string& out) {
  const auto before = std::signal(signal, [](int) {});  // for a signal that comes too late
  std::atomic<bool> ended{false};
  std::thread sender([&] {
    while (!ended && !fs::exists(out + "/trajectory.partial.tum")) std::this_thread::yield();
    kill(getpid(), signal);
  });
  ProgramRun run = runVio(
      {recording, "-o", out, "-c", eurocConfig(), "--export", "none", "--checkpoint", "0.001", "--threads", "1", "-q"});
  ended = true;
  sender.join();
  std::signal(signal, before);
  return run;
}

TEST_F(LintelVioTest, ASignalEndsTheRunWithWhatThereIs) {
  for (const auto& [signal, name] : {std::pair<int, std::string>{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}) {
    SCOPED_TRACE(name);
    const ProgramRun r = runStoppedBy(signal, recording(), out(name));
    EXPECT_EQ(r.exit_code, 128 + signal);
    expectOneLine(r, "stopped by " + name + " after ");
    EXPECT_THAT(r.err, HasSubstr("trajectory and map until then are in " + out(name)));
    const auto statistics = nlohmann::json::parse(bytesOf(out(name) + "/stats.json"));
    EXPECT_EQ(statistics["partial"], true);
    EXPECT_THAT(statistics["ended_early"].get<std::string>(), StartsWith("stopped by " + name));
    EXPECT_THAT(bytesOf(out(name) + "/report.html"), HasSubstr("stopped by " + name));
    const StampedPoses part = readTrajectory(out(name) + "/trajectory.tum");
    const StampedPoses whole = readTrajectory(out("reference") + "/trajectory.tum");
    ASSERT_FALSE(part.empty());
    ASSERT_LE(part.size(), whole.size());
    for (std::size_t i = 0; i < part.size(); ++i) EXPECT_EQ(part[i].second.p, whole[i].second.p) << "pose " << i;
    expectPosesOfTheMap(name, part);
    EXPECT_FALSE(fs::exists(out(name) + "/trajectory.partial.tum"));
    EXPECT_FALSE(fs::exists(out(name) + "/trajectory_refined.tum"));
  }
  EXPECT_EQ(nlohmann::json::parse(bytesOf(out("reference") + "/stats.json"))["partial"], false);
}

TEST_F(LintelVioTest, ThreadsDoNotChangeAByte) {
  ASSERT_EQ(run(recording(), "threads2", {"--threads", "2"}).exit_code, 0);
  expectSameAsReference("threads2");
}

TEST_F(LintelVioTest, ARawlogWithImageFilesGivesTheSameBytes) {
  ASSERT_EQ(runConverter({"-q", "-i", recording(), "-o", *work_ / "external.rawlog"}).exit_code, 0);
  const ProgramRun r = run(*work_ / "external.rawlog", "external");
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_TRUE(bytesOf(out("external") + "/trajectory.tum") == bytesOf(out("reference") + "/trajectory.tum"));
  expectSameAsReference("external");
}

TEST_F(LintelVioTest, ARawlogWithImagesInsideGivesTheSameBytes) {
  const ProgramRun r = run(embeddedRawlog(), "embedded");
  ASSERT_EQ(r.exit_code, 0) << r.err;
  expectSameAsReference("embedded");
}

TEST_F(LintelVioTest, ATruncatedRawlogKeepsWhatWasComputed) {
  const std::string rawlog = *work_ / "cut.rawlog";
  fs::copy_file(embeddedRawlog(), rawlog);
  fs::resize_file(rawlog, fs::file_size(rawlog) * 3 / 4);
  const ProgramRun r = run(rawlog, "cut");
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, "cut.rawlog");
  EXPECT_THAT(r.err, HasSubstr("what was computed until then is in " + out("cut")));
  expectKept("cut");
}

TEST_F(LintelVioTest, ADamagedImuFileKeepsWhatWasComputed) {
  const std::string damaged = copyOfRecording("damaged_imu");
  const std::string path = damaged + "/mav0/imu0/data.csv";
  std::string text = bytesOf(path);
  const std::size_t line = text.find('\n', text.size() * 3 / 4) + 1;
  text.replace(line, 10, "something ");
  std::ofstream(path) << text;
  const ProgramRun r = run(damaged, "damaged_imu");
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, "imu0/data.csv:");
  expectKept("damaged_imu");
}

TEST_F(LintelVioTest, ACutImageIsLeftOutWithAWarning) {
  const std::string damaged = copyOfRecording("cut_image");
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(damaged + "/mav0/cam0/data")) images.push_back(entry.path());
  std::sort(images.begin(), images.end());
  const fs::path& victim = images[images.size() - 5];
  fs::resize_file(victim, fs::file_size(victim) / 2);
  const ProgramRun r = run(damaged, "cut_image", {"--no-refine"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr(victim.filename().string()));
  const auto statistics = nlohmann::json::parse(bytesOf(out("cut_image") + "/stats.json"));
  EXPECT_EQ(statistics["frames"], kDuration_s * 20 - 1);
  EXPECT_EQ(statistics["warnings"].size(), 1u);
}

TEST_F(LintelVioTest, AMissingRecordingIsOneLineAndLeavesNothing) {
  const ProgramRun r = run(*work_ / "absent", "absent");
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, *work_ / "absent");
  EXPECT_FALSE(fs::exists(out("absent")));
}

TEST_F(LintelVioTest, ABadConfigurationIsOneLineAndLeavesNothing) {
  const std::string config = *work_ / "bad.yaml";
  std::ofstream(config) << "estimator:\n  keyframs: 8\n";
  const ProgramRun r = runVio({recording(), "-o", out("badconfig"), "-c", config});
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, config + ":2: unknown key estimator.keyframs");
  expectOneLine(runVio({recording(), "-o", out("badconfig"), "--set", "map.coverage=wide"}), "must be a number");
  expectOneLine(runVio({recording(), "-o", out("badconfig"), "-c", *work_ / "absent.yaml"}), "absent.yaml");
  EXPECT_FALSE(fs::exists(out("badconfig")));
}

TEST_F(LintelVioTest, EarlierResultsAreOverwrittenOnlyWhenTold) {
  fs::copy(out("reference"), out("again"));
  const ProgramRun refused = run(recording(), "again", {"--to", "0.5"});
  EXPECT_EQ(refused.exit_code, 1);
  expectOneLine(refused, "-w");
  expectSameAsReference("again");
  ASSERT_EQ(run(recording(), "again", {"-w", "--to", "2.5", "--no-refine"}).exit_code, 0);
  EXPECT_LT(readTrajectory(out("again") + "/trajectory.tum").size(),
            readTrajectory(out("reference") + "/trajectory.tum").size());
}

TEST_F(LintelVioTest, ARangeWithoutFramesIsOneLine) {
  const ProgramRun r = run(recording(), "late", {"--from", "1000"});
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, "choose another range");
}

TEST_F(LintelVioTest, ARangeTooShortForAPoseSaysWhatWasWaitedFor) {
  const ProgramRun r = run(recording(), "short", {"--to", "0.3"});
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, "no pose was found (collecting frames)");
}

TEST_F(LintelVioTest, WhereNoStartKnowsTheScaleARefinedSecondTryIsWrittenAndNotTrusted) {
  const std::string wanted = "estimator.initializer.max_scale_sigma=0.0002";
  const ProgramRun r = run(recording(), "second_try", {"--set", wanted});
  EXPECT_EQ(r.exit_code, 1);
  expectOneLine(r, "not to be trusted: the motion hardly shows the scale");
  const TrajectoryErrors errors =
      evaluateTrajectory(readTrajectory(out("second_try") + "/trajectory_refined.tum"),
                         readTrajectory(recording() + "/mav0/state_groundtruth_estimate0/data.csv"));
  EXPECT_LT(errors.position_m.rmse, 0.05);
  EXPECT_GT(errors.position_m.count, 60U) << "the frames of the start, too";
  Configuration configuration;
  readConfiguration(out("second_try") + "/config.yaml", configuration);
  EXPECT_EQ(configuration.estimator.initializer.max_scale_sigma, 0.0002) << "what leads to this result";
  const ProgramRun causal = run(recording(), "no_second_try", {"--set", wanted, "--no-refine"});
  EXPECT_EQ(causal.exit_code, 1);
  expectOneLine(causal, "no pose was found");
}

TEST_F(LintelVioTest, WrongCommandLinesAreUsage) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {recording()},
                                             {recording(), "-o", out("usage"), "--from", "2", "--to", "1"},
                                             {recording(), "-o", out("usage"), "--from", "-2"},
                                             {recording(), "-o", out("usage"), "--threads", "0"},
                                             {recording(), "-o", out("usage"), "--threads", "3"},
                                             {recording(), "-o", out("usage"), "--export", "glb,unheardof"},
                                             {recording(), "-o", out("usage"), "--unheard-of"}})
    EXPECT_EQ(runVio(arguments).exit_code, 2) << testing::PrintToString(arguments);
  expectOneLine(runVio({recording(), "-o", out("usage"), "--threads", "64"}), "--threads");
  EXPECT_FALSE(fs::exists(out("usage")));
}

TEST_F(LintelVioTest, AMapIsSearchedAgainAfterwards) {
  ASSERT_EQ(
      runVio({recording(), "-o", out("whole"), "-c", eurocConfig(), "--export", "none", "--threads", "2"}).exit_code,
      0);
  const std::string sparse = out("reference") + "/map.lintel", dense = *work_ / "dense.lintel";
  const LineMap before = readMap(sparse), whole = readMap(out("whole") + "/map.lintel");
  const auto mapped = [](const LineMap& map) {
    return std::count_if(map.lines.begin(), map.lines.end(), [](const MapLine& line) { return line.mapped; });
  };
  EXPECT_EQ(mapped(before), 0);
  EXPECT_GT(mapped(whole), 5);
  EXPECT_GT(whole.lines.size(), before.lines.size());
  EXPECT_TRUE(bytesOf(out("reference") + "/trajectory_refined.tum") ==
              bytesOf(out("whole") + "/trajectory_refined.tum"));

  const ProgramRun run = runMap({"densify", sparse, recording(), "-o", dense});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith(dense + ": "));
  const LineMap after = readMap(dense);
  EXPECT_GT(mapped(after), 5);
  EXPECT_GT(after.lines.size(), before.lines.size());
  EXPECT_EQ(after.keyframes.size(), before.keyframes.size());
  EXPECT_EQ(after.source, before.source);

  const std::string other = *work_ / "dense1.lintel";
  ASSERT_EQ(runMap({"densify", sparse, recording(), "-o", other, "--threads", "1", "-q"}).exit_code, 0);
  EXPECT_TRUE(bytesOf(dense) == bytesOf(other)) << "on one thread";
}

TEST_F(LintelVioTest, AMapIsSearchedWithOtherPoses) {
  const std::string map = out("reference") + "/map.lintel", dense = *work_ / "true.lintel",
                    truth = recording() + "/mav0/state_groundtruth_estimate0/data.csv";
  ASSERT_EQ(runMap({"densify", map, recording(), "-o", dense, "--poses", truth, "-q"}).exit_code, 0);
  const LineMap after = readMap(dense), before = readMap(map);
  EXPECT_GT(after.lines.size(), before.lines.size() / 2);
  const StampedPoses poses = readTrajectory(truth);
  for (const MapKeyframe& keyframe : after.keyframes) {
    const auto at = std::lower_bound(poses.begin(), poses.end(), keyframe.t_ns,
                                     [](const auto& pose, std::int64_t t) { return pose.first < t; });
    ASSERT_NE(at, poses.end());
    EXPECT_LT((at->second.p - keyframe.T_w_b.p).norm(), 0.02);
  }
}

TEST_F(LintelVioTest, ASearchThatCannotBeIsOneLineAndLeavesNothing) {
  const std::string map = out("reference") + "/map.lintel", dense = *work_ / "none.lintel", poses = *work_ / "few.tum";
  std::ofstream(poses) << "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n";
  const auto fails = [&](std::vector<std::string> arguments, const std::string& word, int exit_code = 1) {
    arguments.insert(arguments.begin(), "densify");
    const ProgramRun run = runMap(arguments);
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_THAT(run.err, HasSubstr(word));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(dense));
  };
  fails({map, recording(), "-o", dense, "-q", "--poses", poses}, "fewer than two keyframes of the map have a pose");
  fails({map, *work_ / "nothing", "-o", dense, "-q"}, "nothing");
  fails({recording() + "/mav0/cam0/sensor.yaml", recording(), "-o", dense, "-q"}, "sensor.yaml");
  fails({map, recording(), "-o", dense, "-q", "--set", "densification.partners=0"}, "densification.partners");
  fails({map, recording()}, "--output", 2);
  const ProgramRun again = runMap({"densify", map, recording(), "-o", map});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("exists already"));
}

TEST_F(LintelVioTest, MapsOfOnePlaceAreMerged) {
  ASSERT_EQ(run(recording(), "later", {"--from", "0.9"}).exit_code, 0);
  const std::string first = out("reference") + "/map.lintel", second = out("later") + "/map.lintel";
  const ProgramRun merged = runMap({"merge", first, second, "-o", *work_ / "both.lintel"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("2 recordings"));
  const LineMap a = readMap(first), b = readMap(second), both = readMap(*work_ / "both.lintel");
  EXPECT_EQ(both.keyframes.size(), a.keyframes.size() + b.keyframes.size());
  EXPECT_LT(both.lines.size(), 1.4 * static_cast<double>(std::max(a.lines.size(), b.lines.size()))) << "not all twice";
  ASSERT_EQ(both.pieces.size(), 2u);
  EXPECT_EQ(both.pieces[1].world, 0);
  EXPECT_EQ(both.recordings.size(), 2u);

  const StampedPoses one = readTrajectory(*work_ / "both.1.tum"), two = readTrajectory(*work_ / "both.2.tum");
  ASSERT_EQ(one.size(), a.trajectory.size());
  ASSERT_EQ(two.size(), b.trajectory.size());
  std::size_t together = 0;
  for (const auto& [t_ns, T_w_b] : two)
    for (const auto& [at_ns, other] : one) {
      if (at_ns != t_ns) continue;
      ++together;
      EXPECT_LT((T_w_b.p - other.p).norm(), 0.01) << "one flight, seen twice";
    }
  EXPECT_GT(together, 20u);

  ASSERT_EQ(runMap({"merge", first, second, "-o", *work_ / "again.lintel", "-q"}).exit_code, 0);
  EXPECT_TRUE(bytesOf(*work_ / "both.lintel") == bytesOf(*work_ / "again.lintel"));
}

TEST_F(LintelVioTest, WhatCannotBeMergedIsOneLineAndLeavesNothing) {
  SimulationParams elsewhere;
  elsewhere.scene = "corridor";
  elsewhere.duration_s = 3;
  elsewhere.rate_hz = 10;
  elsewhere.threads = 2;
  Simulation(elsewhere).write(*work_ / "elsewhere");
  ASSERT_EQ(run(*work_ / "elsewhere", "elsewhere").exit_code, 0);
  ASSERT_EQ(run(recording(), "forgetful", {"--to", "2.5", "--set", "loops.keep_interval_s=0"}).exit_code, 0);
  const std::string map = out("reference") + "/map.lintel", none = *work_ / "none.lintel";
  const auto fails = [&](std::vector<std::string> arguments, const std::string& word, int exit_code = 1) {
    arguments.insert(arguments.begin(), "merge");
    const ProgramRun run = runMap(arguments);
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_THAT(run.err, HasSubstr(word));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(none));
  };
  fails({map, out("elsewhere") + "/map.lintel", "-o", none, "-q"}, "place");
  fails({map, map, "-o", none, "-q"}, "both are the map of one run");
  fails({map, out("forgetful") + "/map.lintel", "-o", none, "-q"}, "keeps no views");
  fails({map, recording() + "/mav0/cam0/sensor.yaml", "-o", none, "-q"}, "sensor.yaml");
  fails({map, *work_ / "nothing.lintel", "-o", none, "-q"}, "nothing.lintel");
  fails({map, "-o", none}, "two maps", 2);
  fails({map, map}, "--output", 2);
  std::ofstream(*work_ / "none.2.tum") << "of another merge\n";
  fails({map, out("elsewhere") + "/map.lintel", "-o", none, "-q"}, "none.2.tum: exists already");
  const ProgramRun exists = runMap({"merge", map, map, "-o", map});
  EXPECT_EQ(exists.exit_code, 1);
  EXPECT_THAT(exists.err, HasSubstr("exists already"));
}

TEST_F(LintelVioTest, HelpVersionAndConfigurationNeedNoInput) {
  EXPECT_THAT(runVio({"--help"}).out, HasSubstr("--dump-config"));
  EXPECT_EQ(runVio({"--version"}).exit_code, 0);
  const ProgramRun dump = runVio({"--dump-config", "--set", "estimator.keyframes=8"});
  EXPECT_EQ(dump.exit_code, 0);
  EXPECT_THAT(dump.out, HasSubstr("  keyframes: 8\n"));
}

}  // namespace
}  // namespace lintel
