// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchRunner.h"

#include <signal.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "BenchJson.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/core/ChildProcess.h"
#include "lintel/core/FolderLock.h"
#include "lintel/core/Formatted.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/sensing/GroundTruth.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kKeptTruePoses = 2000;  // for plots; lintel-eval reads all of them

/// A file of that name that one job at a time holds, on every machine that sees it.
class JobLock {
 public:
  explicit JobLock(const fs::path& path) : lock_(made(path), FolderLock::WhenHeld::kWait) {}

 private:
  static std::string made(const fs::path& path) {
    fs::create_directories(path.parent_path());
    const std::ofstream file(path, std::ios::app);
    return path.string();
  }
  FolderLock lock_;
};

std::string nineDigits(double value) { return formatted("%.9g", value); }

std::string seconds(std::int64_t t_ns) {
  return formatted("%lld.%09lld", static_cast<long long>(t_ns / 1000000000), static_cast<long long>(t_ns % 1000000000));
}

/// The last line that is not empty.
std::string lastLine(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\n ");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

/// Keeps part of the truth beside the run, so that tables and plots can be made where the recording is not.
bool keepTruth(const std::string& source, bool is_recording, const fs::path& file) {
  const StampedPoses truth = is_recording ? readGroundTruth(source) : readTrajectory(source);
  std::string text;
  const std::size_t step = std::max<std::size_t>(1, truth.size() / kKeptTruePoses);
  for (std::size_t i = 0; i < truth.size(); i += step) {
    const Eigen::Vector3d& p = truth[i].second.p;
    const Eigen::Quaterniond& q = truth[i].second.q;
    text += formatted("%s %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n", seconds(truth[i].first).c_str(), p.x(), p.y(), p.z(),
                      q.x(), q.y(), q.z(), q.w());
  }
  if (!text.empty()) AtomicFile::writeWhole(file.string(), text);
  return !text.empty();
}

}  // namespace

bool isDone(const BenchJob& job, bool retry_failed) {
  const Json json = readJson(job.folder / "job.json");
  if (!json.is_object() || json.value("key", "") != job.key) return false;
  return !retry_failed || json.value("fault", "").empty();
}

BenchRunner::BenchRunner(const BenchSuite& suite, fs::path out, fs::path programs, int vio_threads,
                         std::function<bool()> stop)
    : suite_(suite),
      out_(std::move(out)),
      programs_(std::move(programs)),
      vio_threads_(vio_threads),
      stop_(std::move(stop)) {}

/// Empty if it went well, else one line.
std::string BenchRunner::runProgram(const std::vector<std::string>& words, const fs::path& log) const {
  std::vector<std::string> command = words;
  command[0] = (programs_ / words[0]).string();
  const ChildResult result = runChild({command, "", "", {}, stop_});
  std::ofstream(log, std::ios::app) << "$ " << shellLine(command) << "\n" << result.output << result.errors;
  if (result.exit_code == 0) return "";
  const int signal = result.exit_code - 128;
  if (result.exit_code == 127)
    throw std::runtime_error(command[0] + ": cannot be started; it belongs beside lintel-bench");
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP)  // stopped from outside: no result
    throw std::runtime_error(words[0] + " was stopped; start lintel-bench again to go on");
  const std::string reason = lastLine(result.errors);
  if (signal > 0)
    return words[0] + ": ended by signal " + std::to_string(signal) + (signal == SIGKILL ? " (out of memory?)" : "");
  return reason.empty() ? words[0] + ": exit code " + std::to_string(result.exit_code) : reason;
}

std::string BenchRunner::makeRecording(const BenchJob& job) const {
  if (job.simulation.empty() || fs::exists(job.recording_path)) return "";
  const JobLock lock(job.recording_path + ".lock");
  if (fs::exists(job.recording_path)) return "";
  std::vector<std::string> words{"lintel-sim", "-o",        job.recording_path,
                                 "-q",         "--threads", std::to_string(vio_threads_)};
  words.insert(words.end(), job.simulation.begin(), job.simulation.end());
  return runProgram(words, job.recording_path + ".log");
}

std::string BenchRunner::odometry(const BenchJob& job, const fs::path& part) const {
  const BenchConfiguration& configuration = suite_.configurations[job.configuration];
  std::vector<std::string> words{"lintel-vio", job.recording_path, "-o",   part.string(), "-w",
                                 "-q",         "--export",         "none", "--threads",   std::to_string(vio_threads_)};
  if (!configuration.config.empty()) words.insert(words.end(), {"-c", configuration.config});
  for (const std::string& setting : configuration.settings) words.insert(words.end(), {"--set", setting});
  if (job.from_s > 0) words.insert(words.end(), {"--from", nineDigits(job.from_s)});
  if (job.to_s > 0) words.insert(words.end(), {"--to", nineDigits(job.to_s)});
  return runProgram(words, part / "log.txt");
}

std::string BenchRunner::evaluateTrajectory(const BenchJob& job, const fs::path& part, const std::string& trajectory,
                                            const std::string& json, bool with_map) const {
  const std::string& own_truth = suite_.recordings[job.recording].groundtruth;
  std::vector<std::string> words{"lintel-eval",   "--quiet",
                                 "--trajectory",  (part / trajectory).string(),
                                 "--json",        (part / json).string(),
                                 "--groundtruth", own_truth.empty() ? job.recording_path : own_truth};
  const Json stats = readJson(part / "stats.json");
  if (stats.is_object() && stats.contains("first_frame_ns"))
    words.insert(words.end(), {"--between", seconds(stats["first_frame_ns"].get<std::int64_t>()) + "," +
                                                seconds(stats["last_frame_ns"].get<std::int64_t>())});
  fs::path lines = fs::path(job.recording_path) / "mav0/lines0/data.csv";
  if (!fs::exists(lines)) lines = fs::path(job.recording_path) / "lines0/data.csv";
  if (with_map && fs::exists(lines) && fs::exists(part / "map.lintel"))
    words.insert(words.end(), {"--map", (part / "map.lintel").string(), "--lines", lines.string()});
  return runProgram(words, part / "log.txt");
}

std::string BenchRunner::evaluate(const BenchJob& job, const fs::path& part) const {
  const std::string& own_truth = suite_.recordings[job.recording].groundtruth;
  try {
    if (!keepTruth(own_truth.empty() ? job.recording_path : own_truth, own_truth.empty(), part / "truth.tum"))
      return "";
  } catch (const std::exception& error) {
    return error.what();
  }
  std::string fault = evaluateTrajectory(job, part, "trajectory.tum", "evaluation.json", true);
  if (fault.empty() && fs::exists(part / "trajectory_refined.tum"))
    fault = evaluateTrajectory(job, part, "trajectory_refined.tum", "evaluation_refined.json", false);
  return fault;
}

JobOutcome BenchRunner::run(const BenchJob& job, bool retry_failed) const {
  const JobLock lock(out_ / "locks" / (job.folder.lexically_relative(out_ / "runs").string() + ".lock"));
  if (isDone(job, retry_failed)) return {true, false, "done already"};
  const fs::path part = job.folder.string() + ".part";
  fs::remove_all(part);
  fs::create_directories(part);
  std::string fault = makeRecording(job);
  if (fault.empty()) fault = odometry(job, part);
  if (fault.empty()) fault = evaluate(job, part);
  const Json json{{"id", job.id}, {"key", job.key}, {"fault", fault}};
  AtomicFile::writeWhole((part / "job.json").string(), json.dump(2) + "\n");
  fs::remove_all(job.folder);
  fs::rename(part, job.folder);
  if (!fault.empty()) return {false, true, fault};
  const Json errors = readJson(job.folder / "evaluation.json");
  if (!errors.is_object() || !errors.contains("trajectory")) return {false, false, "no ground truth"};
  const Json& trajectory = errors["trajectory"];
  return {false, false,
          formatted("RMSE %.4f m, %.0f %% covered", trajectory["position_m"].value("rmse", 0.0),
                    100 * trajectory.value("coverage_time", 0.0))};
}

}  // namespace lintel
