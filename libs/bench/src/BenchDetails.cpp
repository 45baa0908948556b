// SPDX-License-Identifier: BSD-3-Clause
#include "BenchDetails.h"

#include <functional>

namespace lintel {

namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

using CellText = std::function<std::string(const BenchCell&)>;

/// A row a recording and configuration, a column a figure.
Table detailTable(const BenchSuite& suite, const BenchResults& results, Table table,
                  const std::vector<std::pair<std::string, CellText>>& figures) {
  table.columns = {"recording", "configuration"};
  for (const auto& figure : figures) table.columns.push_back(figure.first);
  for (std::size_t r = 0; r < suite.recordings.size(); ++r)
    for (std::size_t c = 0; c < suite.configurations.size(); ++c) {
      const BenchCell& cell = results.cell(r, c);
      if (!cell.anyOk()) continue;
      std::vector<Cell> row{suite.recordings[r].name, suite.configurations[c].name};
      for (const auto& figure : figures) row.emplace_back(figure.second(cell));
      if (row.back().text == "-" && row[3].text == "-") continue;  // nothing to compare with
      table.rows.push_back(row);
    }
  return table;
}

CellText evaluationFigure(const std::string& path, int decimals, double factor = 1) {
  return [=](const BenchCell& c) { return fixedText(factor * c.evaluation(path), decimals); };
}

CellText statsFigure(const std::string& path, int decimals, double factor = 1) {
  return [=](const BenchCell& c) { return fixedText(factor * c.stats(path), decimals); };
}

}  // namespace

Table methodTable(const BenchSuite& suite, const BenchResults& results) {
  const auto degrees = [](const std::string& path) { return evaluationFigure(path, 2, kDegrees); };
  const CellText ate = [](const BenchCell& c) {
    return fixedText(c.evaluation("/trajectory/position_m/rmse"), 4) + (c.complete() ? "" : " (incomplete)");
  };
  return detailTable(
      suite, results,
      {"method",
       "Everything side by side",
       {},
       {},
       {"Medians over the starts. ATE: RMSE of the causal trajectory after SE(3) alignment; incomplete: a run "
        "left out more than it may, do not compare. Directions, surfaces: the map against the truth (simulated "
        "recordings). CPU: of the "
        "whole process, decoding, map and report included; it differs from run to run."}},
      {{"ATE [m]", ate},
       {"covered [%]", evaluationFigure("/trajectory/coverage_time", 1, 100)},
       {"lines in 5 windows [%]", statsFigure("/tracking/lines/share_seen_in_10_frames", 1, 100)},
       {"lines used", statsFigure("/mean_lines_used", 1)},
       {"degenerate [%]", statsFigure("/degenerate_share", 1, 100)},
       {"map lines", statsFigure("/map_lines", 0)},
       {"direction [deg]", degrees("/lines/all_matched/direction_median_rad")},
       {"of degenerate ones", degrees("/lines/degenerate_matched/direction_median_rad")},
       {"of constrained ones", degrees("/lines/constrained_matched/direction_median_rad")},
       {"on surfaces, 5 cm", evaluationFigure("/lines/surface_precision/1", 3)},
       {"CPU a frame [ms]", statsFigure("/cpu_ms_per_frame", 1)}});
}

Table coverageTable(const BenchSuite& suite, const BenchResults& results) {
  return detailTable(
      suite, results,
      {"coverage",
       "How much of each recording has a pose, and the error over all of it",
       {},
       {},
       {"RMSE over all: where there is no estimate, the one nearest in time stands in, so that a run that "
        "stops early cannot look better for it."}},
      {{"first pose [s]", evaluationFigure("/trajectory/start_offset_s", 2)},
       {"time covered [%]", evaluationFigure("/trajectory/coverage_time", 1, 100)},
       {"path covered [%]", evaluationFigure("/trajectory/coverage_path", 1, 100)},
       {"resets", statsFigure("/resets", 0)},
       {"RMSE [m]", evaluationFigure("/trajectory/position_m/rmse", 4)},
       {"RMSE over all [m]", evaluationFigure("/trajectory/whole_rmse_m", 4)},
       {"scale", evaluationFigure("/trajectory/scale", 4)},
       {"rotation RMSE [deg]", evaluationFigure("/trajectory/rotation_rad/rmse", 3, kDegrees)}});
}

Table trackingTable(const BenchSuite& suite, const BenchResults& results) {
  return detailTable(
      suite, results,
      {"tracking",
       "Tracking",
       {},
       {},
       {"Lines in 5 windows: share of line tracks seen in at least 10 frames, of which every second enters "
        "the window (the paper's table II). In the window: lines with a place in space, mean over the "
        "window's frames; used: those in its problem; degenerate ones by what leaves them open."}},
      {{"lines in 5 windows [%]", statsFigure("/tracking/lines/share_seen_in_10_frames", 1, 100)},
       {"median life of a line [frames]", statsFigure("/tracking/lines/median_length", 0)},
       {"median life of a point [frames]", statsFigure("/tracking/points/median_length", 0)},
       {"points used", statsFigure("/mean_points_used", 1)},
       {"lines tracked", statsFigure("/mean_lines_tracked", 1)},
       {"in the window", statsFigure("/mean_lines_placed", 1)},
       {"used", statsFigure("/mean_lines_used", 1)},
       {"degenerate", statsFigure("/mean_lines_degenerate", 1)},
       {"direction unknown", statsFigure("/mean_lines_degenerate_by_reason/direction_unknown", 1)},
       {"distance unknown", statsFigure("/mean_lines_degenerate_by_reason/distance_unknown", 1)},
       {"through the epipole", statsFigure("/mean_lines_degenerate_by_reason/through_epipole", 1)},
       {"of them constrained", statsFigure("/mean_lines_constrained", 1)}});
}

Table mapTable(const BenchSuite& suite, const BenchResults& results) {
  const auto degrees = [](const std::string& path) { return evaluationFigure(path, 2, kDegrees); };
  Table table =
      detailTable(suite, results,
                  {"map",
                   "Line map against the truth (simulated recordings)",
                   {},
                   {},
                   {"Shares of length. Directions of segments matched to a true edge, median; degenerate ones apart."}},
                  {{"lines", statsFigure("/map_lines", 0)},
                   {"length [m]", evaluationFigure("/lines/length_m", 1)},
                   {"on surfaces, 2 cm", evaluationFigure("/lines/surface_precision/0", 3)},
                   {"on surfaces, 5 cm", evaluationFigure("/lines/surface_precision/1", 3)},
                   {"on edges, 5 cm", evaluationFigure("/lines/precision/1", 3)},
                   {"edges found, 5 cm", evaluationFigure("/lines/recall/1", 3)},
                   {"direction [deg]", degrees("/lines/all_matched/direction_median_rad")},
                   {"degenerate", evaluationFigure("/lines/degenerate", 0)},
                   {"their direction [deg]", degrees("/lines/degenerate_matched/direction_median_rad")},
                   {"constrained", evaluationFigure("/lines/constrained", 0)},
                   {"their direction [deg]", degrees("/lines/constrained_matched/direction_median_rad")},
                   {"duplicates", evaluationFigure("/lines/duplicates", 2)}});
  return table;
}

Table timingTable(const BenchSuite& suite, const BenchResults& results) {
  std::vector<std::pair<std::string, CellText>> figures;
  for (const char* stage : {"decoding", "tracking", "estimation", "mapping"}) {
    const std::string path = std::string("/stages/") + stage;
    figures.emplace_back(std::string(stage) + " mean [ms]", statsFigure(path + "/mean_ms", 1));
    figures.emplace_back("p95", statsFigure(path + "/p95_ms", 1));
  }
  for (const char* stage : {"start of the program", "map fitting", "refinement", "report"})
    figures.emplace_back(std::string(stage) + " [s]", statsFigure(std::string("/cpu_ms/") + stage, 2, 1e-3));
  figures.emplace_back("CPU a frame [ms]", statsFigure("/cpu_ms_per_frame", 1));
  figures.emplace_back("frames/s", statsFigure("/frames_per_s", 0));
  figures.emplace_back("memory [MB]", statsFigure("/peak_memory_mb", 0));
  return detailTable(
      suite, results,
      {"timing",
       "CPU time of each stage",
       {},
       {},
       {"Differs from run to run and from machine to machine, unlike all other tables. Seconds: once a "
        "run. CPU a frame: of the whole process. frames/s: wall time, with as many jobs beside it as were asked for."}},
      figures);
}

}  // namespace lintel
