// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelBench.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <ostream>
#include <thread>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "StopSignals.h"
#include "lintel/bench/BenchPage.h"
#include "lintel/bench/BenchRunner.h"
#include "lintel/bench/BenchTables.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/core/ChildProcess.h"
#include "lintel/core/ParallelFor.h"
#include "lintel/reporting/Progress.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

class LintelBench {
 public:
  static constexpr const char* kName = "lintel-bench";

  LintelBench(std::ostream& out, std::ostream& err) : out_(out), err_(err) {
    workers_ = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    addOptions();
  }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    checkUsage();
    out_folder_ = fs::absolute(output_ + "/.").lexically_normal().parent_path();
    suite_ = readSuite(suite_file_, recordings_);
    warnOfAbsent();
    jobs_ = jobsOf(suite_, out_folder_);
    if (jobs_.empty())
      throw SuiteError(suite_file_ + ": none of its recordings was found; name their folder with --recordings");
    if (print_jobs_) return printJobs();
    if (!collect_) {
      const StopSignals stop;
      try {
        if (!job_.empty()) return runOne(stop);
        runMissing(stop);
      } catch (...) {
        if (!stop.asked()) throw;
        throw Stopped("stopped by " + stop.name() + "; what is done is kept, the same command goes on from there",
                      stop.exitCode());
      }
    }
    return collect();
  }

 private:
  static std::string examples() {
    return "Examples:\n"
           "  lintel-bench euroc.yaml -o out --recordings EuRoC     runs what is missing, then writes the tables\n"
           "  lintel-bench euroc.yaml -o out --recordings EuRoC --print-jobs | parallel\n"
           "  lintel-bench euroc.yaml -o out --recordings EuRoC --collect      the tables of what is there\n"
           "Tables: OUT/tables/*.txt and *.csv, OUT/results.json, OUT/report.html";
  }

  void addOptions() {
    line_.footer(examples());
    line_.option("suite", suite_file_, "What to run: recordings and configurations").type("SUITE.yaml").required();
    line_.option("-o,--output", output_, "Folder of results; what is there is not run again").type("OUT").required();
    line_.option("--recordings", recordings_, "Folder in which recordings are looked for by name")
        .type("DIR")
        .showDefault();
    line_.option("-j,--jobs", workers_, "Runs at the same time").positive().showDefault();
    line_.option("--threads", vio_threads_, "Threads of each run; results do not depend on it")
        .oneOf({"1", "2"})
        .showDefault();
    line_.flag("--print-jobs", print_jobs_, "Print what is missing, a shell command a run, and stop");
    line_.flag("--collect", collect_, "Run nothing; make the tables of what is there");
    line_.option("--job", job_, "Run only this one (as --print-jobs prints them)").type("ID");
    line_.flag("--retry-failed", retry_failed_, "Run again what failed");
    line_.option("--programs", programs_, "Folder of lintel-vio and the others; without it that of this program")
        .type("DIR");
    line_.flag("-q,--quiet", quiet_, "No progress, no tables on the terminal");
  }

  void checkUsage() {
    if (print_jobs_ + collect_ + !job_.empty() > 1)
      throw UsageError("--print-jobs, --collect and --job exclude each other");
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    if (programs_.empty()) programs_ = self.parent_path().string();
    if (!fs::is_directory(recordings_)) throw UsageError("--recordings " + recordings_ + ": no such folder");
  }

  void warnOfAbsent() const {
    if (quiet_ || print_jobs_ || !job_.empty()) return;
    for (const BenchRecording& recording : suite_.recordings)
      if (recording.absent())
        err_ << kName << ": warning: recording " << recording.name
             << " was not found; name the folder that holds it with --recordings\n";
  }

  int printJobs() const {
    std::vector<std::string> words{(fs::path(programs_) / kName).string(),
                                   fs::absolute(suite_file_).lexically_normal().string(),
                                   "-o",
                                   out_folder_.string(),
                                   "--recordings",
                                   fs::absolute(recordings_).lexically_normal().string(),
                                   "--quiet"};
    if (vio_threads_ != 1) words.insert(words.end(), {"--threads", std::to_string(vio_threads_)});
    if (retry_failed_) words.emplace_back("--retry-failed");
    for (const BenchJob& job : jobs_) {
      if (isDone(job, retry_failed_)) continue;
      out_ << shellLine(words) << " --job " << shellLine({job.id}) << "\n";
    }
    return 0;
  }

  int runOne(const StopSignals& stop) const {
    const auto job = std::find_if(jobs_.begin(), jobs_.end(), [&](const BenchJob& j) { return j.id == job_; });
    if (job == jobs_.end()) throw UsageError("--job " + job_ + ": the suite has no such run; --print-jobs prints them");
    const JobOutcome outcome = runner(stop).run(*job, retry_failed_);
    if (!quiet_) out_ << job->id << ": " << outcome.text << "\n";
    // a failed run is a result: it stands in the tables, and must not end a chain of jobs
    if (outcome.failed) err_ << kName << ": warning: " << job->id << " failed: " << outcome.text << "\n";
    return 0;
  }

  BenchRunner runner(const StopSignals& stop) const {
    return {suite_, out_folder_, programs_, vio_threads_, [&stop] { return stop.asked(); }};
  }

  void runMissing(const StopSignals& stop) {
    std::vector<BenchJob> missing;
    for (const BenchJob& job : jobs_)
      if (!isDone(job, retry_failed_)) missing.push_back(job);
    fs::create_directories(out_folder_);
    const BenchRunner runs = runner(stop);
    Progress progress(err_, progressStyleFor(err_, quiet_), "running", "runs", jobs_.size());
    std::mutex mutex;
    std::size_t done = jobs_.size() - missing.size();
    parallelFor(missing.size(), workers_, [&](std::size_t i) {
      const BenchJob& job = missing[i];
      const auto start = std::chrono::steady_clock::now();
      stop.check();
      const JobOutcome outcome = runs.run(job, retry_failed_);
      const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
      if (!quiet_) {
        progress.clear();
        err_ << done << "/" << jobs_.size() << " " << job.id << ": " << (outcome.failed ? "FAILED: " : "")
             << outcome.text << " (" << durationText(wall_s) << ")\n";
      }
      progress.update(done);
    });
  }

  int collect() {
    const BenchResults results(suite_, jobs_);
    if (results.missing() == results.runs().size())
      throw std::runtime_error(out_folder_.string() + ": holds no results of this suite; run it first");
    fs::create_directories(out_folder_ / "tables");
    for (const Table& table : benchTables(suite_, results)) {
      AtomicFile::writeWhole((out_folder_ / "tables" / (table.name + ".txt")).string(), textOf(table));
      AtomicFile::writeWhole((out_folder_ / "tables" / (table.name + ".csv")).string(), csvOf(table));
      const bool shown = table.name.rfind("accuracy", 0) == 0 || table.name == "method" || table.name == "faults";
      if (!quiet_ && shown && !table.rows.empty()) out_ << textOf(table) << "\n";
    }
    AtomicFile::writeWhole((out_folder_ / "results.json").string(), benchJson(suite_, results).dump(2) + "\n");
    AtomicFile::writeWhole((out_folder_ / "report.html").string(), benchPage(suite_, results));
    if (!quiet_)
      out_ << "written: " << (out_folder_ / "report.html").string() << ", results.json, tables/*.txt, tables/*.csv\n";
    std::size_t failed = 0;
    for (const auto& [job, run] : results.runs()) failed += run.found && !run.fault.empty();
    if (failed > 0)
      throw std::runtime_error(std::to_string(failed) + " of " + std::to_string(jobs_.size()) +
                               " runs failed; why is in " + (out_folder_ / "tables/faults.txt").string() +
                               " (run again with --retry-failed)");
    return 0;
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName, "Recordings × configurations: tables of accuracy, tracking, maps and timing."};
  std::string suite_file_, output_, recordings_ = ".", job_, programs_;
  int workers_ = 1, vio_threads_ = 1;
  bool print_jobs_ = false, collect_ = false, retry_failed_ = false, quiet_ = false;
  fs::path out_folder_;
  BenchSuite suite_;
  std::vector<BenchJob> jobs_;
};

}  // namespace

int runLintelBench(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(LintelBench::kName, err, [&] { return LintelBench(out, err).run(argc, argv); });
}

}  // namespace lintel
