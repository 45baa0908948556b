// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelVio.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <ostream>
#include <stdexcept>

#include "CommandLine.h"
#include "EarlierRun.h"
#include "ProgramMain.h"
#include "RecordingInfo.h"
#include "RecordingOptions.h"
#include "RunFolder.h"
#include "RunSummary.h"
#include "StopSignals.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/TextFile.h"
#include "lintel/exporting/MapExport.h"
#include "lintel/pages/RunReport.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/Results.h"
#include "lintel/pipeline/RunStatistics.h"
#include "lintel/pipeline/SecondTry.h"
#include "lintel/reporting/Progress.h"
#include "lintel/sensing/GroundTruth.h"
#include "lintel/tracking/TrackDrawing.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

class LintelVio {
 public:
  static constexpr const char* kName = "lintel-vio";

  LintelVio(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    Configuration configuration = readOptions();
    if (no_refine_) configuration.refinement.enabled = false;
    if (dump_config_) {
      out_ << writeConfiguration(configuration);
      return 0;
    }
    if (info_) return printInfo();
    checkCommandLine();
    command_ = essentialArguments(argc, argv);
    auto recording = openRecording(input_, recording_params_);
    const StopSignals stop;
    const RunFolder folder(output_, overwrite_ || resume_);
    if (resume_ && isDone(configuration)) return 0;
    makeTracksFolder();
    checkpoint_.emplace(output_, checkpoint_s_);
    costs_.once_ms.emplace_back("start of the program", processTimeMs());
    const auto start = std::chrono::steady_clock::now();
    OdometryResult result = process(*recording, configuration, stop);
    const std::string given = writeConfiguration(configuration);
    if (mayHaveWrongClock(result)) tryAsStamped(stop, configuration, result);
    if (configuration.refinement.enabled && lacksScale(result)) tryVagueStart(stop, configuration, result);
    result.map.configuration = given;
    const double wall_s = costs_.wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (result.statistics.frames == 0 && !result.error.empty()) throw RecordingError(result.error);
    std::vector<std::string> warnings = recording->warnings();
    warnings.insert(warnings.end(), result.remarks.begin(), result.remarks.end());
    for (const std::string& warning : warnings) err_ << kName << ": warning: " << oneLine(warning) << "\n";
    if (result.cancelled && result.trajectory.empty()) stop.check();
    if (result.cancelled) result.error = stoppedBy(stop, result);
    writeOutput(result, warnings);
    checkpoint_->remove();
    if (!quiet_) summarise(result, {output_, exported_, wall_s}, out_);
    if (result.cancelled)
      throw Stopped(result.error + "; trajectory and map until then are in " + output_, stop.exitCode());
    if (!result.error.empty())
      throw RecordingError(result.error + " (what was computed until then is in " + output_ + ")");
    if (!result.fault().empty()) throw std::runtime_error(input_ + ": not to be trusted: " + result.fault());
    if (result.trajectory.empty()) throw std::runtime_error(noPose(result));
    return 0;
  }

 private:
  static std::string examples() {
    return "Examples:\n"
           "  lintel-vio MH_01_easy -o out                       an EuRoC folder (the one that holds mav0)\n"
           "  lintel-vio flight.rawlog -o out --export glb,ply   a rawlog\n"
           "  lintel-vio flight.rawlog -o out --from 10 --to 40  thirty seconds of it\n"
           "  lintel-vio flight.bag -o out --calibration camchain-imucam.yaml --calibration imu.yaml   a ROS bag\n"
           "  lintel-vio flight.mcap --info                      its topics\n"
           "  lintel-vio walk.mp4 -o out --times walk.csv --imu-file imu.csv --calibration rig.yaml   a film\n"
           "  lintel-vio flight.rawlog -o out --set features=points   points alone\n"
           "  lintel-vio --dump-config > my.yaml                 every option with its default";
  }

  void addOptions() {
    line_.footer(examples());
    line_
        .option("input", input_,
                "A rawlog, an EuRoC folder (mav0 or its parent), a ROS bag (.bag, .db3, .mcap), a film, or a folder of "
                "images")
        .type("INPUT");
    line_.option("-o,--output", output_, "Folder to write to; made if it does not exist").type("OUT");
    line_.option("-c,--config", config_, "Configuration; what it leaves out keeps its default").type("CONFIG.yaml");
    line_.option("--set", settings_, "Set one option, e.g. --set estimator.keyframes=8").type("KEY=VALUE").repeatable();
    addRecordingOptions(line_, recording_params_);
    line_
        .option("--mask", recording_params_.mask,
                "Image of the camera's size: nothing is detected or tracked where it is black")
        .type("FILE");
    line_.option("--gravity", recording_params_.gravity_m_s2, "Gravity where the recording was made [m/s^2]")
        .range(1.0, 30.0)
        .showDefault();
    line_.flag("--info", info_,
               "List the recording's sensors, describe its rig, say what looks wrong with it, and stop");
    line_.option("--save-calibration", info_request_.save_calibration, "With --info: write the rig to this file")
        .type("FILE.yaml");
    line_.option("--form", info_request_.form, "Form of that file").oneOf({"kalibr", "vins"}).showDefault();
    line_.option("--from", recording_params_.from_s, "Start this long after the first frame [s]").notNegative();
    line_.option("--to", recording_params_.to_s, "Stop this long after the first frame [s]; 0 = at the end")
        .notNegative();
    line_.option("--threads", threads_, "1: one stage after the other; 2: tracking beside estimation. Same result")
        .oneOf({"1", "2"})
        .showDefault();
    line_.option("--export", exports_, "Forms of the map to write, with commas between; none for no export")
        .separatedBy(',')
        .oneWord()
        .type("EXT,...");
    line_.option("--draw-tracks", draw_tracks_, "Write every frame with its points and lines as a PNG to this folder")
        .type("DIR");
    line_
        .option(
            "--checkpoint", checkpoint_s_,
            "Save the poses so far this often to OUT/trajectory.partial.tum, until the results are written [s]; 0 = "
            "never")
        .notNegative()
        .showDefault();
    line_.flag("--no-refine", no_refine_, "Leave out the batch adjustment after the last frame");
    line_.flag("-w,--overwrite", overwrite_, "Write into OUT although it holds the results of an earlier run");
    line_.flag("--resume", resume_,
               "Do nothing if OUT holds the whole results of the same command; process the recording again if that run "
               "broke off");
    line_.flag("-q,--quiet", quiet_, "No progress, no summary");
    line_.flag("--dump-config", dump_config_, "Print the effective configuration and stop");
  }

  int printInfo() {
    if (input_.empty() && recording_params_.calibration.empty())
      throw UsageError("INPUT is missing: a recording, or --calibration FILE.yaml; see --help");
    info_request_.recording = input_;
    info_request_.params = recording_params_;
    info_request_.overwrite = overwrite_;
    printRecordingInfo(info_request_, out_, err_);
    return 0;
  }

  Configuration readOptions() const {
    Configuration configuration;
    if (!config_.empty()) readConfiguration(config_, configuration);
    for (const std::string& setting : settings_) setOption(setting, configuration);
    return configuration;
  }

  void checkCommandLine() {
    if (input_.empty()) throw UsageError("INPUT is missing: a rawlog, an EuRoC folder or a ROS bag; see --help");
    if (output_.empty()) throw UsageError("-o OUT is missing: the folder to write to");
    if (recording_params_.to_s > 0 && recording_params_.to_s <= recording_params_.from_s)
      throw UsageError("--to must be later than --from");
    if (exports_.size() == 1 && exports_[0] == "none") exports_.clear();
    for (const std::string& extension : exports_)
      if (viewerHint(extension).empty()) throw UsageError("--export " + extension + ": there is no such form");
    if (threads_ == 1) recording_params_.frames_ahead = 0;
  }

  /// Of --resume: whether OUT holds what this command would compute. Throws std::runtime_error if it holds what another
  /// command has computed, or a result that is not to be trusted.
  bool isDone(const Configuration& configuration) {
    const EarlierRun earlier = EarlierRun::in(output_);
    if (earlier.state == EarlierRun::State::kNone) return false;
    if (earlier.state == EarlierRun::State::kBroken) {
      err_ << kName << ": " << output_ << ": the earlier run broke off (" << oneLine(earlier.reason)
           << "); tracks and window are not saved, so the recording is processed from the start\n";
      return false;
    }
    if (earlier.command != command_ || earlier.configuration != writeConfiguration(configuration))
      throw std::runtime_error(output_ +
                               ": holds the results of another command or configuration; choose another folder, or -w "
                               "without --resume");
    if (!earlier.verdict.empty())
      throw std::runtime_error(input_ + ": processed already, not to be trusted: " + earlier.verdict);
    if (!quiet_) out_ << output_ << ": holds the whole results of this command already; -w computes them again\n";
    return true;
  }

  void makeTracksFolder() const {
    std::error_code error;
    if (!draw_tracks_.empty()) fs::create_directories(draw_tracks_, error);
    if (error) throw std::runtime_error(draw_tracks_ + ": cannot be made: " + error.message());
  }

  OdometryResult process(Recording& recording, const Configuration& configuration, const StopSignals& stop) {
    Progress progress(err_, progressStyleFor(err_, quiet_), "processing", "frames", recording.expectedFrames());
    std::optional<Progress> afterwards;
    RunStage shown = RunStage::kFrames;
    calibration_ = recording.rig();
    RunOptions options;
    options.threads = threads_;
    options.cancelled = [&] {
      if (stop.asked()) checkpoint_->flush();  // before the map is made, which takes longest
      return stop.asked();
    };
    options.progress = [&](const RunProgress& run) {
      if (run.stage == RunStage::kFrames) return progress.update(run.done);
      if (shown == RunStage::kFrames) {
        progress.clear();
        checkpoint_->flush();
      }
      if (shown != run.stage) {
        if (afterwards) afterwards->clear();
        const char* what = run.stage == RunStage::kLoops        ? "looking for places seen before"
                           : run.stage == RunStage::kRefinement ? "refining"
                                                                : "searching lines";
        afterwards.emplace(err_, progressStyleFor(err_, quiet_), what, "%", run.total);
        shown = run.stage;
      }
      afterwards->update(run.done);
    };
    options.observer = [&](const Frame& frame, const FrameTracks& tracks, const WindowUpdate& update,
                           std::size_t done) {
      series_.add(tracks, update);
      saveForNow(update);
      if (draw_tracks_.empty()) return;
      drawTracks((fs::path(draw_tracks_) / formatted("%06zu.png", done - 1)).string(), frame, calibration_, tracks);
    };
    OdometryResult result = runOdometry(recording, configuration, options);
    checkpoint_->flush();
    if (!checkpoint_->fault().empty()) result.remarks.push_back(checkpoint_->fault());
    return result;
  }

  /// The stamps as they are, where no pose was found with corrected ones.
  void tryAsStamped(const StopSignals& stop, Configuration& configuration, OdometryResult& result) {
    const double offset_ms = 1000 * result.clock_offset_s;
    const Configuration second = asStamped(configuration);
    if (!tryAgain("no pose with the clocks corrected: once more with the stamps as they are", second, hasPoses, stop,
                  result))
      return;
    configuration = second;
    result.remarks.push_back(
        formatted("clocks of images and IMU: %+.1f ms were found before the start, but no pose with them; the stamps "
                  "are used as they are",
                  offset_ms));
  }

  /// A start that is less sure of the scale.
  void tryVagueStart(const StopSignals& stop, const Configuration& configuration, OdometryResult& result) {
    if (!tryAgain("no start knows the scale well: once more, from one that knows it less well",
                  secondTryOf(configuration), isBetter, stop, result))
      return;
    result.verdict = verdictOfSecondTry(result);
  }

  /// The recording once more; whether that is the better result, which then takes the place of the first.
  bool tryAgain(const std::string& why, const Configuration& configuration,
                const std::function<bool(const OdometryResult&, const OdometryResult&)>& is_better,
                const StopSignals& stop, OdometryResult& result) {
    if (!quiet_) err_ << kName << ": " << why << "\n";
    RunSeries series;
    std::swap(series, series_);
    checkpoint_.emplace(output_, checkpoint_s_);
    const auto recording = openRecording(input_, recording_params_);
    OdometryResult second = process(*recording, configuration, stop);
    const bool better = is_better(second, result);
    if (better) {
      result = std::move(second);
    } else {
      std::swap(series, series_);
      result.cancelled = second.cancelled;
    }
    return better;
  }

  /// Where it outlasts the program being killed.
  void saveForNow(const WindowUpdate& update) {
    for (const FramePose& frame : update.replaced) checkpoint_->add({frame.t_ns, frame.T_w_b_image});
    if (update.hasPose()) checkpoint_->add({update.t_ns, update.T_w_b_image});
    if (update.startWasWrong())
      checkpoint_->withdrawStart();
    else if (update.status == EstimatorStatus::kLost)
      checkpoint_->endStart();
  }

  /// What is said of a run that a signal has ended.
  static std::string stoppedBy(const StopSignals& stop, const OdometryResult& result) {
    const OdometryStatistics& s = result.statistics;
    return formatted("stopped by %s after %.1f s of the recording", stop.name().c_str(),
                     1e-9 * static_cast<double>(s.last_frame_ns - s.first_frame_ns));
  }

  void writeOutput(const OdometryResult& result, const std::vector<std::string>& warnings) {
    const fs::path out(output_);
    {
      const RunCosts::Once booking(costs_, "writing");
      writeResults(result, output_);
    }
    {
      const RunCosts::Once booking(costs_, "exports");
      exported_ = writeExports(result.map, output_, exports_);
    }
    {
      const RunCosts::Once booking(costs_, "report");
      AtomicFile::writeWhole((out / "report.html").string(), report(result, warnings));
    }
    AtomicFile::writeWhole((out / "stats.json").string(),
                           statisticsJson(result, calibration_, costs_, warnings, command_));
  }

  std::string report(const OdometryResult& result, const std::vector<std::string>& warnings) const {
    RunRecord record{input_, result.map.configuration, writeConfiguration({}), calibration_, costs_, warnings, {}, "",
                     ""};
    try {
      record.groundtruth = readGroundTruth(input_);
    } catch (const std::exception& error) {  // the run is good without it
      record.truth_fault = error.what();
    }
    const auto picture = std::find(exports_.begin(), exports_.end(), "png");
    if (picture != exports_.end()) record.map_picture = bytesOfFile(fs::path(output_) / "map.png");
    return runReport(record, result, series_);
  }

  std::string noPose(const OdometryResult& result) const {
    if (result.statistics.frames == 0) return input_ + ": no frame between --from and --to; choose another range";
    const std::string& wait = result.statistics.main_wait;
    return input_ + ": no pose was found (" + (wait.empty() ? "too short" : wait) +
           "); start where the camera moves and sees texture (--from), and check the calibration";
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName, "Trajectory and 3D line map from a recording with a camera and an IMU."};
  std::string input_, output_, config_, draw_tracks_;
  std::vector<std::string> settings_, command_, exports_{"glb", "obj", "ply", "3Dscene", "png"}, exported_;
  RecordingParams recording_params_;
  InfoRequest info_request_;
  RunSeries series_;
  RunCosts costs_;
  Rig calibration_;
  std::optional<TrajectoryCheckpoint> checkpoint_;
  double checkpoint_s_ = 5;
  int threads_ = 2;
  bool no_refine_ = false, overwrite_ = false, resume_ = false, quiet_ = false, dump_config_ = false, info_ = false;
};

}  // namespace

int runLintelVio(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(LintelVio::kName, err, [&] { return LintelVio(out, err).run(argc, argv); });
}

}  // namespace lintel
