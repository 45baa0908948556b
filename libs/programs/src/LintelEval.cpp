// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelEval.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "ProgramMain.h"
#include "lintel/evaluation/LineErrors.h"
#include "lintel/evaluation/Output.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/mapping/AtomicFile.h"
#include "lintel/mapping/MapFile.h"

namespace lintel {

namespace {

constexpr const char* kName = "lintel-eval";

/// The map's own trajectory; without one, its keyframes.
StampedPoses trajectoryOf(const LineMap& map) {
  if (!map.trajectory.empty()) return map.trajectory;
  StampedPoses poses;
  for (const MapKeyframe& keyframe : map.keyframes) poses.emplace_back(keyframe.t_ns, keyframe.T_w_b);
  return poses;
}

class LintelEval {
 public:
  LintelEval(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = parseArguments(app_, argc, argv, out_, err_)) return *exit_code;
    checkUsage();
    params_.alignment = alignmentKindOf(alignment_);
    if (!trajectory_.empty()) evaluateTrajectoryFile();
    if (!map_.empty()) evaluateMap();
    if (!json_.empty()) writeJson();
    return 0;
  }

 private:
  void addOptions() {
    app_.add_option("--trajectory", trajectory_, "Estimated trajectory, TUM or EuRoC state CSV")->type_name("EST");
    app_.add_option("--groundtruth", groundtruth_,
                    "True trajectory, TUM or EuRoC state CSV; for a map the default is the one beside the lines "
                    "(../state_groundtruth_estimate0/data.csv)")
        ->type_name("GT");
    app_.add_option("--map", map_, "Line map of lintel-vio")->type_name("MAP.lintel");
    app_.add_option("--lines", lines_, "True lines, as in mav0/lines0/data.csv")->type_name("GT.csv");
    app_.add_option("--align", alignment_, "How the estimate is laid onto the truth: se3, yaw, sim3 or none")
        ->check(CLI::IsMember({"se3", "yaw", "sim3", "none"}))
        ->capture_default_str();
    app_.add_option("--max-difference", params_.max_difference_s,
                    "A pose and its true partner: at most so far apart [s]")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app_.add_option("--distances", params_.distances_m, "Stretches of the path for relative errors [m]")
        ->check(CLI::PositiveNumber)
        ->delimiter(',')
        ->capture_default_str();
    app_.add_option("--json", json_, "Write the figures to this file")->type_name("FILE");
    app_.add_flag("--quiet", quiet_, "Print no figures");
  }

  void checkUsage() const {
    if (trajectory_.empty() && map_.empty())
      throw UsageError("nothing to do: give --trajectory EST --groundtruth GT, or --map MAP.lintel --lines GT.csv");
    if (!trajectory_.empty() && groundtruth_.empty()) throw UsageError("--trajectory needs --groundtruth GT");
    if (map_.empty() != lines_.empty()) throw UsageError("--map and --lines need each other");
  }

  TrajectoryErrors errorsOf(const std::string& name, const StampedPoses& estimate, const std::string& truth) const {
    const StampedPoses groundtruth = readTrajectory(truth);
    try {
      return evaluateTrajectory(estimate, groundtruth, params_);
    } catch (const EvaluationError& error) {
      throw EvaluationError(name + ": " + error.what());
    }
  }

  void evaluateTrajectoryFile() {
    trajectory_errors_ = errorsOf(trajectory_, readTrajectory(trajectory_), groundtruth_);
    if (!quiet_) printText(*trajectory_errors_, out_);
  }

  /// The ground truth that a map is aligned by; empty if there is none.
  std::string groundtruthOfMap() const {
    if (!groundtruth_.empty()) return groundtruth_;
    const auto beside = std::filesystem::path(lines_).parent_path() / "../state_groundtruth_estimate0/data.csv";
    return std::filesystem::exists(beside) ? beside.string() : std::string();
  }

  void evaluateMap() {
    const LineMap map = readMap(map_);
    const std::vector<TrueLine> truth = readTrueLines(lines_);
    const std::string groundtruth = groundtruthOfMap();
    Similarity S_truth_map;
    if (params_.alignment != AlignmentKind::kNone && !groundtruth.empty()) {
      map_trajectory_errors_ = errorsOf(map_, trajectoryOf(map), groundtruth);
      S_truth_map = map_trajectory_errors_->S_truth_estimate;
    }
    line_errors_ = evaluateLines(map.lines, S_truth_map, truth);
    if (!quiet_) printMap();
  }

  void printMap() const {
    if (map_trajectory_errors_)
      out_ << "map alignment   " << alignment_ << " by " << map_trajectory_errors_->pairs
           << " poses of the map, ATE RMSE " << map_trajectory_errors_->position_m.rmse << " m\n";
    else
      out_ << "map alignment   none\n";
    printText(*line_errors_, out_);
  }

  void writeJson() const {
    AtomicFile file(json_);
    file.write(toJson(trajectory_errors_, map_trajectory_errors_, line_errors_));
    file.commit();
  }

  std::ostream& out_;
  std::ostream& err_;
  CLI::App app_{"Errors of a trajectory against its ground truth, and of a line map against the true lines.", kName};
  std::string trajectory_, groundtruth_, map_, lines_, alignment_ = "se3", json_;
  bool quiet_ = false;
  TrajectoryErrorParams params_;
  std::optional<TrajectoryErrors> trajectory_errors_, map_trajectory_errors_;
  std::optional<LineErrors> line_errors_;
};

}  // namespace

int runLintelEval(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(kName, err, [&] { return LintelEval(out, err).run(argc, argv); });
}

}  // namespace lintel
