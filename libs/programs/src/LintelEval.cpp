// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelEval.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/evaluation/LineConsistency.h"
#include "lintel/evaluation/LineErrors.h"
#include "lintel/evaluation/Output.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pages/EvalReport.h"
#include "lintel/sensing/GroundTruth.h"
#include "lintel/simulation/SurfaceDistance.h"

namespace lintel {

namespace {

/// The map's own trajectory; without one, its keyframes.
StampedPoses trajectoryOf(const LineMap& map) {
  if (!map.trajectory.empty()) return map.trajectory;
  StampedPoses poses;
  for (const MapKeyframe& keyframe : map.keyframes) poses.emplace_back(keyframe.t_ns, keyframe.T_w_b);
  return poses;
}

namespace fs = std::filesystem;

constexpr double kMostTimeOffset_s = 1000;

/// True poses: a TUM or CSV file, or a recording that carries them.
StampedPoses readTruth(const std::string& path) {
  const bool recording = fs::is_directory(path) || fs::path(path).extension() == ".rawlog";
  if (!recording) return readTrajectory(path);
  StampedPoses poses = readGroundTruth(path);
  if (poses.empty()) throw EvaluationError(path + ": carries no ground truth; give a file with --groundtruth");
  return poses;
}

/// A time in seconds, exact to the nanosecond; empty if it is none.
std::optional<std::int64_t> nanosecondsOf(const std::string& text) {
  const std::size_t dot = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, dot), decimals = dot < text.size() ? text.substr(dot + 1) : "";
  decimals.resize(9, '0');
  digits += decimals;
  if (dot == 0 || dot > 10 || digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return std::stoll(digits);
}

class LintelEval {
 public:
  static constexpr const char* kName = "lintel-eval";

  LintelEval(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    checkUsage();
    params_.alignment = alignmentKindOf(alignment_);
    if (!trajectory_.empty()) evaluateTrajectoryFile();
    if (!map_.empty()) evaluateMap();
    if (!json_.empty())
      AtomicFile::writeWhole(json_, toJson(evaluation_.trajectory, evaluation_.map_trajectory, evaluation_.lines,
                                           evaluation_.consistency, line_sigmas_));
    if (!report_.empty()) AtomicFile::writeWhole(report_, evaluationPage(evaluation_));
    return 0;
  }

 private:
  void addOptions() {
    line_.option("--trajectory", trajectory_, "Estimated trajectory, TUM or EuRoC state CSV").type("EST");
    line_
        .option("--groundtruth", groundtruth_,
                "True trajectory: TUM, EuRoC state CSV, or a recording that carries it (EuRoC folder, rawlog); for a "
                "map the default is the one beside the lines "
                "(../state_groundtruth_estimate0/data.csv)")
        .type("GT");
    line_
        .option("--covariance", covariance_,
                "Covariances of the estimate, as lintel-vio writes them; the default is the file beside it "
                "(NAME_covariance.csv for NAME.tum)")
        .type("FILE.csv");
    line_.option("--map", map_, "Line map of lintel-vio").type("MAP.lintel");
    line_.option("--lines", lines_, "True lines, as in mav0/lines0/data.csv").type("GT.csv");
    line_.option("--align", alignment_, "How the estimate is laid onto the truth: se3, yaw, sim3 or none")
        .oneOf({"se3", "yaw", "sim3", "none"})
        .showDefault();
    line_.option("--max-difference", params_.max_difference_s, "A pose and its true partner: at most so far apart [s]")
        .notNegative()
        .showDefault();
    line_
        .option("--time-offset", time_offset_s_,
                "An estimated pose with stamp t is that of the truth's time t + this [s]: poses have the stamps of "
                "images, and calibration.time_offset_s of stats.json is how the IMU's clock differs from theirs")
        .range(-kMostTimeOffset_s, kMostTimeOffset_s)
        .showDefault();
    line_.option("--distances", params_.distances_m, "Stretches of the path for relative errors [m]")
        .positive()
        .separatedBy(',')
        .showDefault();
    line_
        .option("--between", between_,
                "Only this part of the ground truth counts, two times [s] with a comma: for runs of a part")
        .type("T0,T1");
    line_
        .option("--surfaces", surfaces_,
                "True surfaces, a PLY mesh; the default is the one beside the lines (../scene0/scene.ply)")
        .type("MESH.ply");
    line_.option("--report", report_, "Write the figures with plots as one page").type("FILE.html");
    line_.option("--json", json_, "Write the figures to this file").type("FILE");
    line_.flag("--quiet", quiet_, "Print no figures");
  }

  void checkUsage() {
    if (trajectory_.empty() && map_.empty())
      throw UsageError("nothing to do: give --trajectory EST --groundtruth GT, or --map MAP.lintel --lines GT.csv");
    if (!trajectory_.empty() && groundtruth_.empty()) throw UsageError("--trajectory needs --groundtruth GT");
    if (!covariance_.empty() && trajectory_.empty()) throw UsageError("--covariance needs --trajectory EST");
    if (map_.empty() != lines_.empty()) throw UsageError("--map and --lines need each other");
    if (!between_.empty()) readBetween();
  }

  void readBetween() {
    const std::size_t comma = between_.find(',');
    const auto from_ns = nanosecondsOf(between_.substr(0, comma));
    const auto to_ns = comma == std::string::npos ? std::nullopt : nanosecondsOf(between_.substr(comma + 1));
    if (!from_ns || !to_ns || *from_ns >= *to_ns)
      throw UsageError("--between " + between_ + ": must be two times in seconds, as 1403636584.763555584,1403636600");
    const std::int64_t offset_ns = std::llround(1e9 * time_offset_s_);
    params_.from_ns = *from_ns - offset_ns;
    params_.to_ns = *to_ns - offset_ns;
  }

  TrajectoryErrors errorsOf(const std::string& name, const StampedPoses& estimate, const std::string& truth) {
    evaluation_.groundtruth_name = truth;
    evaluation_.groundtruth = atImageStamps(readTruth(truth), time_offset_s_);
    try {
      return evaluateTrajectory(estimate, evaluation_.groundtruth, params_);
    } catch (const EvaluationError& error) {
      throw EvaluationError(name + ": " + error.what());
    }
  }

  void evaluateTrajectoryFile() {
    evaluation_.estimate_name = trajectory_;
    evaluation_.estimate = readTrajectory(trajectory_);
    evaluation_.trajectory = errorsOf(trajectory_, evaluation_.estimate, groundtruth_);
    if (!quiet_) printText(*evaluation_.trajectory, out_);
    evaluateCovariances();
  }

  void evaluateCovariances() {
    std::string file = covariance_;
    if (file.empty()) {
      file =
          (fs::path(trajectory_).parent_path() / (fs::path(trajectory_).stem().string() + "_covariance.csv")).string();
      if (!fs::exists(file)) return;
    }
    const auto covariances = readCovariances(file, evaluation_.estimate);
    evaluation_.consistency = evaluateConsistency(evaluation_.estimate, covariances, evaluation_.groundtruth, params_);
    if (!quiet_) printText(*evaluation_.consistency, out_);
  }

  /// A file of the recording that the true lines belong to; empty if there is none.
  std::string besideLines(const std::string& name) const {
    const fs::path beside = fs::path(lines_).parent_path() / ".." / name;
    return fs::exists(beside) ? beside.string() : std::string();
  }

  void evaluateMap() {
    evaluation_.map_name = map_;
    evaluation_.map = readMap(map_);
    evaluation_.true_lines = readTrueLines(lines_);
    const std::string truth = groundtruth_.empty() ? besideLines("state_groundtruth_estimate0/data.csv") : groundtruth_;
    if (params_.alignment != AlignmentKind::kNone && !truth.empty()) {
      evaluation_.map_trajectory = errorsOf(map_, trajectoryOf(evaluation_.map), truth);
      evaluation_.S_truth_map = evaluation_.map_trajectory->S_truth_estimate;
    }
    SurfaceDistanceFunction surface_distance;
    const std::string mesh = surfaces_.empty() ? besideLines("scene0/scene.ply") : surfaces_;
    if (!mesh.empty())
      surface_distance = [surface = std::make_shared<SurfaceDistance>(mesh)](const Eigen::Vector3d& p) {
        return (*surface)(p);
      };
    evaluation_.lines =
        evaluateLines(evaluation_.map.lines, evaluation_.S_truth_map, evaluation_.true_lines, {}, surface_distance);
    line_sigmas_ =
        evaluateConsistency(evaluation_.map, evaluation_.S_truth_map, evaluation_.true_lines, evaluation_.groundtruth);
    if (!quiet_) printMap();
  }

  void printMap() const {
    const auto& trajectory = evaluation_.map_trajectory;
    if (trajectory)
      out_ << "map alignment   " << alignment_ << " by " << trajectory->pairs << " poses of the map, ATE RMSE "
           << trajectory->position_m.rmse << " m\n";
    else
      out_ << "map alignment   none\n";
    printText(*evaluation_.lines, out_);
    printText(*line_sigmas_, out_);
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName,
                    "Errors of a trajectory against its ground truth, and of a line map against the true lines."};
  std::string trajectory_, covariance_, groundtruth_, map_, lines_, alignment_ = "se3", json_, report_, surfaces_,
                                                                    between_;
  double time_offset_s_ = 0;
  bool quiet_ = false;
  TrajectoryErrorParams params_;
  Evaluation evaluation_;
  std::optional<LineConsistency> line_sigmas_;
};

}  // namespace

int runLintelEval(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(LintelEval::kName, err, [&] { return LintelEval(out, err).run(argc, argv); });
}

}  // namespace lintel
