// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelEval.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "ProgramMain.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/evaluation/TrajectoryOutput.h"

namespace lintel {

namespace {

constexpr const char* kName = "lintel-eval";

class LintelEval {
 public:
  LintelEval(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = parseArguments(app_, argc, argv, out_, err_)) return *exit_code;
    if (trajectory_.empty() || groundtruth_.empty()) throw UsageError("give --trajectory EST --groundtruth GT");
    params_.alignment = alignmentKindOf(alignment_);
    const TrajectoryErrors errors = evaluate();
    if (!quiet_) printText(errors, out_);
    if (!json_.empty()) writeFileAtomically(json_, "{\n\"trajectory\": " + toJson(errors) + "\n}\n");
    return 0;
  }

 private:
  void addOptions() {
    app_.add_option("--trajectory", trajectory_, "Estimated trajectory, TUM or EuRoC state CSV")->type_name("EST");
    app_.add_option("--groundtruth", groundtruth_, "True trajectory, TUM or EuRoC state CSV")->type_name("GT");
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
    app_.add_flag("--quiet", quiet_, "Print nothing");
  }

  TrajectoryErrors evaluate() const {
    const StampedPoses estimate = readTrajectory(trajectory_);
    const StampedPoses groundtruth = readTrajectory(groundtruth_);
    try {
      return evaluateTrajectory(estimate, groundtruth, params_);
    } catch (const EvaluationError& error) {
      throw EvaluationError(trajectory_ + ": " + error.what());
    }
  }

  std::ostream& out_;
  std::ostream& err_;
  CLI::App app_{"Errors of an estimated trajectory against its ground truth.", kName};
  std::string trajectory_, groundtruth_, alignment_ = "se3", json_;
  TrajectoryErrorParams params_;
  bool quiet_ = false;
};

}  // namespace

int runLintelEval(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(kName, err, [&] { return LintelEval(out, err).run(argc, argv); });
}

}  // namespace lintel
