// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchPage.h"

#include <filesystem>
#include <set>

#include "lintel/bench/BenchTables.h"
#include "lintel/core/Version.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pages/Plots.h"
#include "lintel/reporting/HtmlPage.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPicturedRecordings = 30;  // a page of a thousand would not open

/// A job's run and where it lies.
using JobRun = std::pair<BenchJob, BenchRun>;

Similarity transformOf(const nlohmann::ordered_json& evaluation, const std::string& part) {
  const auto number = [&](const std::string& path) {
    return BenchRun::number(evaluation, "/" + part + "/transform/" + path);
  };
  Similarity S;
  S.scale = number("scale");
  S.T_a_b.q = Eigen::Quaterniond(number("quaternion_xyzw/3"), number("quaternion_xyzw/0"), number("quaternion_xyzw/1"),
                                 number("quaternion_xyzw/2"));
  S.T_a_b.p = {number("translation_m/0"), number("translation_m/1"), number("translation_m/2")};
  return S;
}

/// Only what box plots show.
TrajectoryErrors relativeErrorsOf(const nlohmann::ordered_json& evaluation) {
  TrajectoryErrors errors;
  for (std::size_t k = 0; k < 64; ++k) {
    const std::string at = "/trajectory/relative/" + std::to_string(k);
    const auto number = [&](const std::string& name) {
      return BenchRun::number(evaluation, std::string(at).append("/translation_m/").append(name));
    };
    RelativeErrors r;
    r.distance_m = BenchRun::number(evaluation, at + "/distance_m");
    if (!(r.distance_m > 0)) break;
    r.whole_path = evaluation.at(nlohmann::ordered_json::json_pointer(at + "/whole_path")).get<bool>();
    ErrorStatistics& s = r.translation_m;
    s.count = static_cast<std::size_t>(number("count"));
    s.median = number("median");
    s.p05 = number("p05");
    s.p25 = number("p25");
    s.p75 = number("p75");
    s.p95 = number("p95");
    errors.relative.push_back(r);
  }
  return errors;
}

/// The first repetition of every configuration that has a trajectory.
std::vector<const JobRun*> firstRuns(const BenchResults& results, std::size_t recording) {
  std::vector<const JobRun*> runs;
  std::set<std::size_t> seen;
  for (const JobRun& run : results.runs())
    if (run.first.recording == recording && run.second.ok() && seen.insert(run.first.configuration).second)
      runs.push_back(&run);
  return runs;
}

class RecordingPictures {
 public:
  RecordingPictures(const BenchSuite& suite, const BenchResults& results, HtmlPage& page)
      : suite_(suite), results_(results), page_(page) {}

  void add(std::size_t recording) {
    runs_ = firstRuns(results_, recording);
    if (runs_.empty()) return;
    page_.subheading(suite_.recordings[recording].name);
    page_.beginGallery();
    trajectories();
    relativeErrors();
    maps();
    page_.endGallery();
  }

 private:
  std::string nameOf(const JobRun& run) const { return suite_.configurations[run.first.configuration].name; }

  void trajectories() {
    std::vector<NamedTrajectory> drawn;
    for (const JobRun* run : runs_) {
      const bool aligned = !run->second.evaluation.is_null();
      const fs::path truth = run->first.folder / "truth.tum";
      if (drawn.empty() && aligned && fs::exists(truth)) drawn.push_back({"truth", readTrajectory(truth.string()), ""});
      StampedPoses poses = readTrajectory((run->first.folder / "trajectory.tum").string());
      if (aligned) poses = moved(poses, transformOf(run->second.evaluation, "trajectory"));
      drawn.push_back({nameOf(*run), poses, ""});
    }
    page_.figure(topView(drawn), "Trajectories from above (" + runs_.front()->first.repetition + ")");
  }

  void relativeErrors() {
    NamedErrors errors;
    for (const JobRun* run : runs_)
      if (!run->second.evaluation.is_null())
        errors.emplace_back(nameOf(*run), relativeErrorsOf(run->second.evaluation));
    if (!errors.empty())
      page_.figure(relativeErrorBoxes(errors), "Relative translation errors: median, middle half, from 5 % to 95 %");
  }

  void maps() {
    for (const JobRun* run : runs_) {
      const fs::path map = run->first.folder / "map.lintel", recording = run->first.recording_path;
      if (!fs::exists(map)) continue;
      const LineMap lines = readMap(map.string());
      if (lines.lines.empty()) continue;
      const bool aligned = run->second.evaluation.contains("map_trajectory");
      const Similarity S = aligned ? transformOf(run->second.evaluation, "map_trajectory") : Similarity();
      const fs::path truth = recording / "mav0/lines0/data.csv";
      const std::vector<TrueLine> true_lines =
          aligned && fs::exists(truth) ? readTrueLines(truth.string()) : std::vector<TrueLine>();
      page_.figure(mapFromAbove(lines, S, true_lines, moved(lines.trajectory, S)), "Map from above: " + nameOf(*run));
    }
  }

  const BenchSuite& suite_;
  const BenchResults& results_;
  HtmlPage& page_;
  std::vector<const JobRun*> runs_;
};

void overview(const BenchSuite& suite, const BenchResults& results, HtmlPage& page) {
  page.paragraph(std::to_string(suite.recordings.size()) + " recordings, " +
                 std::to_string(suite.configurations.size()) + " configurations, " +
                 std::to_string(results.runs().size()) + " runs. Made by lintel-bench " + version() + ".");
  std::vector<std::string> items;
  for (const BenchConfiguration& configuration : suite.configurations) {
    std::string text = configuration.name + ":";
    if (!configuration.config.empty()) text += " " + fs::path(configuration.config).filename().string();
    for (const std::string& setting : configuration.settings) text += " --set " + setting;
    items.push_back(text);
  }
  page.list(items);
  std::vector<std::string> warnings;
  if (results.missing() > 0)
    warnings.push_back(std::to_string(results.missing()) +
                       " runs are still missing: start lintel-bench again to go on.");
  for (const BenchRecording& recording : suite.recordings)
    if (recording.absent())
      warnings.push_back(recording.name + " was not found: name the folder that holds it with --recordings.");
  page.warnings(warnings);
}

}  // namespace

std::string benchPage(const BenchSuite& suite, const BenchResults& results) {
  HtmlPage page(suite.title);
  overview(suite, results, page);
  for (const Table& table : benchTables(suite, results)) {
    if (table.rows.empty()) continue;
    std::string heading = table.name;
    heading[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(heading[0])));
    std::replace(heading.begin(), heading.end(), '_', ' ');
    page.heading(heading);
    page.table(table);
  }
  for (const std::string& note : suite.notes) page.paragraph(note);
  page.heading("Pictures");
  RecordingPictures pictures(suite, results, page);
  for (std::size_t r = 0; r < std::min(kPicturedRecordings, suite.recordings.size()); ++r) pictures.add(r);
  if (suite.recordings.size() > kPicturedRecordings)
    page.paragraph("Only the first " + std::to_string(kPicturedRecordings) +
                   " recordings are pictured; every run has a page of its own in runs/RECORDING/CONFIGURATION/.");
  return page.text();
}

}  // namespace lintel
