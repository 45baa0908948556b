// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchTables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "BenchDetails.h"

#include "lintel/core/Version.h"

namespace lintel {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using CellText = std::function<std::string(const BenchCell&)>;
using CellValue = std::function<double(const BenchCell&)>;

std::vector<std::string> columnsOf(const BenchSuite& suite, const std::string& first) {
  std::vector<std::string> columns{first};
  for (const BenchConfiguration& configuration : suite.configurations) columns.push_back(configuration.name);
  return columns;
}

/// A cell's text, or why there is none; runs that failed or left out too much say so.
Cell cellOf(const BenchCell& cell, const CellText& text) {
  if (cell.runs() == 0) return {"not found", CellMark::kFault};
  if (cell.missing() == cell.runs()) return {"not run yet", CellMark::kFault};
  if (!cell.anyOk()) return {"failed", CellMark::kFault};
  std::string shown = text(cell);
  if (cell.failed() + cell.missing() > 0)
    return {shown + " (" + std::to_string(cell.runs() - cell.failed() - cell.missing()) + " of " +
                std::to_string(cell.runs()) + ")",
            CellMark::kFault};
  if (!cell.complete())
    return {shown + " (" + fixedText(100 * cell.evaluation("/trajectory/coverage_time"), 0) + " %)", CellMark::kFault};
  return shown;
}

/// Marks the lowest value of a row; a run that failed or left out too much is never the best.
void markBest(std::vector<Cell>& row, const BenchSuite& suite, const BenchResults& results, std::size_t r,
              const CellValue& value) {
  double best = kInfinity;
  const auto valueOf = [&](std::size_t c) {
    const BenchCell& cell = results.cell(r, c);
    if (cell.runs() == 0 || !cell.complete() || !std::isfinite(value(cell))) return kInfinity;
    return value(cell);
  };
  for (std::size_t c = 0; c < suite.configurations.size(); ++c) best = std::min(best, valueOf(c));
  if (suite.configurations.size() < 2 || best == kInfinity) return;
  for (std::size_t c = 0; c < suite.configurations.size(); ++c)
    if (valueOf(c) == best && row[1 + c].mark == CellMark::kNone) row[1 + c].mark = CellMark::kBest;
}

std::string rmseAndMax(double rmse_m, double max_m) { return fixedText(rmse_m, 4) + "/" + fixedText(max_m, 4); }

Cell publishedCell(const PublishedSystem& system, const std::string& recording) {
  const auto found = system.errors.find(recording);
  if (found == system.errors.end()) return Cell("-");
  const auto& [rmse_m, max_m] = found->second;
  return Cell(fixedText(rmse_m, 3) + (max_m ? "/" + fixedText(*max_m, 3) : ""));
}

Cell publishedMean(const PublishedSystem& system) {
  double sum = 0;
  for (const auto& [recording, errors] : system.errors) sum += errors.rmse_m;
  if (system.errors.empty()) return Cell("-");
  return Cell(fixedText(sum / static_cast<double>(system.errors.size()), 3) + " of " +
              std::to_string(system.errors.size()));
}

/// The paper's table: RMSE/maximum, a row a recording, beside it what others have published.
Table accuracyTable(const BenchSuite& suite, const BenchResults& results, bool refined) {
  const auto figure = [refined](const BenchCell& c, const std::string& path) {
    return refined ? c.refined(path) : c.evaluation(path);
  };
  const CellValue rmse = [&](const BenchCell& c) { return figure(c, "/trajectory/position_m/rmse"); };
  const CellText text = [&](const BenchCell& c) {
    return rmseAndMax(rmse(c), figure(c, "/trajectory/position_m/max"));
  };
  Table table{refined ? "accuracy_refined" : "accuracy",
              std::string("Translation error RMSE/maximum [m] after SE(3) alignment, ") +
                  (refined ? "refined trajectory" : "causal trajectory"),
              columnsOf(suite, "recording"),
              {},
              {"* best of the row. (N %): covers only so much of the recording, not comparable. (N of M): so many runs "
               "succeeded, medians of those."}};
  for (const PublishedSystem& system : suite.published) {
    table.columns.push_back(system.name + " (published)");
    if (!system.source.empty()) table.notes.push_back(system.name + ": " + system.source + ".");
  }
  for (std::size_t r = 0; r < suite.recordings.size(); ++r) {
    std::vector<Cell> row{suite.recordings[r].name};
    for (std::size_t c = 0; c < suite.configurations.size(); ++c) row.push_back(cellOf(results.cell(r, c), text));
    markBest(row, suite, results, r, rmse);
    for (const PublishedSystem& system : suite.published)
      row.push_back(publishedCell(system, suite.recordings[r].name));
    table.rows.push_back(row);
  }
  std::vector<Cell> mean{"mean of RMSE"};
  for (std::size_t c = 0; c < suite.configurations.size(); ++c) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t r = 0; r < suite.recordings.size(); ++r) {
      const BenchCell& cell = results.cell(r, c);
      if (cell.runs() == 0 || !cell.complete() || !std::isfinite(rmse(cell))) continue;
      sum += rmse(cell);
      ++n;
    }
    mean.push_back(n == 0 ? Cell("-") : Cell(fixedText(sum / static_cast<double>(n), 4) + " of " + std::to_string(n)));
  }
  for (const PublishedSystem& system : suite.published) mean.push_back(publishedMean(system));
  table.rows.push_back(mean);
  return table;
}

Table relativeTable(const BenchSuite& suite, const BenchResults& results) {
  Table table{"relative",
              "Relative translation error, median [% of the stretch]",
              columnsOf(suite, "recording, length of the stretch"),
              {},
              {}};
  for (std::size_t r = 0; r < suite.recordings.size(); ++r)
    for (std::size_t k = 0; k < 5; ++k) {
      const std::string at = "/trajectory/relative/" + std::to_string(k);
      std::vector<Cell> row;
      bool any = false;
      double length_m = 0;
      for (std::size_t c = 0; c < suite.configurations.size(); ++c) {
        const BenchCell& cell = results.cell(r, c);
        const double median_m = cell.evaluation(at + "/translation_m/median");
        if (std::isfinite(median_m)) length_m = cell.evaluation(at + "/distance_m");
        any = any || std::isfinite(median_m);
        row.push_back(fixedText(100 * median_m / cell.evaluation(at + "/distance_m"), 3));
      }
      if (!any) continue;
      row.insert(row.begin(), suite.recordings[r].name + ", " + fixedText(length_m, 0) + " m");
      table.rows.push_back(row);
    }
  return table;
}

Table faultTable(const BenchResults& results) {
  Table table{"faults", "Runs without a result", {"run", "why"}, {}, {}};
  for (const auto& [job, run] : results.runs())
    if (!run.ok()) table.rows.push_back({job.id, {run.found ? run.fault : "not run yet", CellMark::kFault}});
  return table;
}

bool anyFigure(const BenchSuite& suite, const BenchResults& results, const CellValue& value) {
  for (std::size_t r = 0; r < suite.recordings.size(); ++r)
    for (std::size_t c = 0; c < suite.configurations.size(); ++c)
      if (std::isfinite(value(results.cell(r, c)))) return true;
  return false;
}

nlohmann::ordered_json figuresOf(const BenchRun& run) {
  nlohmann::ordered_json json{{"fault", run.found ? run.fault : "not run yet"}};
  if (!run.ok()) return json;
  json["evaluation"] = run.evaluation;
  if (!run.evaluation_refined.is_null()) json["evaluation_refined"] = run.evaluation_refined;
  for (const char* key : {"frames", "frames_with_pose", "keyframes", "first_pose_s", "resets", "reset_reasons",
                          "mean_points_used", "mean_lines_tracked", "mean_lines_placed", "mean_lines_used",
                          "mean_lines_degenerate", "mean_lines_degenerate_by_reason", "degenerate_share",
                          "mean_lines_constrained", "map_points", "map_lines", "tracking", "warnings"})
    if (run.stats.contains(key)) json["stats"][key] = run.stats[key];
  return json;
}

}  // namespace

bool differsFromRunToRun(const Table& table) { return table.name == "timing" || table.name == "method"; }

std::vector<Table> benchTables(const BenchSuite& suite, const BenchResults& results) {
  std::vector<Table> tables{accuracyTable(suite, results, false)};
  if (anyFigure(suite, results, [](const auto& c) { return c.refined("/trajectory/position_m/rmse"); }))
    tables.push_back(accuracyTable(suite, results, true));
  tables.push_back(methodTable(suite, results));
  tables.push_back(coverageTable(suite, results));
  tables.push_back(trackingTable(suite, results));
  tables.push_back(relativeTable(suite, results));
  if (anyFigure(suite, results, [](const auto& c) { return c.evaluation("/lines/length_m"); }))
    tables.push_back(mapTable(suite, results));
  tables.push_back(faultTable(results));
  tables.push_back(timingTable(suite, results));
  return tables;
}

nlohmann::ordered_json benchJson(const BenchSuite& suite, const BenchResults& results) {
  nlohmann::ordered_json json{{"suite", suite.name}, {"title", suite.title}, {"lintel", version()}};
  for (const Table& table : benchTables(suite, results)) {
    if (differsFromRunToRun(table)) continue;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
      nlohmann::ordered_json texts = nlohmann::ordered_json::array();
      for (const Cell& cell : row) texts.push_back(cell.text);
      rows.push_back(texts);
    }
    json["tables"][table.name] = {{"caption", table.caption}, {"columns", table.columns}, {"rows", rows}};
  }
  for (const auto& [job, run] : results.runs()) json["runs"][job.id] = figuresOf(run);
  return json;
}

}  // namespace lintel
