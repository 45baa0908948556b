// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pages/EvalReport.h"

#include <sstream>

#include "Degrees.h"
#include "lintel/evaluation/Output.h"
#include "lintel/pages/Plots.h"
#include "lintel/reporting/HtmlPage.h"

namespace lintel {

namespace {

std::string metres(double value) { return fixedText(value, 4) + " m"; }

void trajectorySection(const Evaluation& e, HtmlPage& page) {
  const TrajectoryErrors& errors = *e.trajectory;
  page.heading("Trajectory");
  if (!errors.complete)
    page.warnings({"The estimate covers only " + fixedText(100 * errors.coverage_time, 1) +
                   " % of the ground truth. Its errors are those of a part: do not compare them with a whole run's."});
  Table table{"trajectory", e.estimate_name + " against " + e.groundtruth_name, {"figure", "value"}, {}, {}};
  for (const auto& row : trajectoryRows(errors)) table.rows.push_back({row[0], row[1]});
  page.table(table);
  page.figure(topView({{"truth", e.groundtruth, ""}, {"estimate", moved(e.estimate, errors.S_truth_estimate), ""}}),
              "From above, after alignment");
  page.figure(errorOverTime({{"error", errors}}), "Position error over time");
  page.heading("Relative errors");
  Table relative{"relative",
                 "Motion over stretches of the true path",
                 {"length", "stretches", "RMSE [m]", "RMSE [%]", "median [m]", "rotation RMSE [deg]"},
                 {},
                 {}};
  for (const RelativeErrors& r : errors.relative)
    relative.rows.push_back({fixedText(r.distance_m, 1) + (r.whole_path ? " m (all)" : " m"),
                             std::to_string(r.translation_m.count), fixedText(r.translation_m.rmse, 4),
                             fixedText(100 * r.translation_m.rmse / r.distance_m, 2),
                             fixedText(r.translation_m.median, 4), fixedText(kDegrees * r.rotation_rad.rmse, 3)});
  page.table(relative);
  page.figure(relativeErrorBoxes({{"estimate", errors}}),
              "Relative translation errors: median, middle half, and from 5 % to 95 %");
}

void mapSection(const Evaluation& e, HtmlPage& page) {
  page.heading("Line map");
  std::ostringstream figures;
  printText(*e.lines, figures);
  page.preformatted(figures.str());
  page.figure(mapFromAbove(e.map, e.S_truth_map, e.true_lines, moved(e.map.trajectory, e.S_truth_map)),
              "The map from above, laid onto the true edges");
}

}  // namespace

void consistencySection(const Consistency& c, HtmlPage& page) {
  page.heading("Errors and their standard deviations");
  Table table{"nees",
              "Squared errors in units of the estimated covariance, relative to the first pose",
              {"", "mean", "right", "poses within the 95 % bounds", "bounds"},
              {},
              {}};
  for (const auto& [name, s] : {std::pair<std::string, SquaredErrorSummary>{"position", c.position},
                                {"yaw", c.yaw},
                                {"roll, pitch", c.roll_pitch}})
    table.rows.push_back({name, fixedText(s.mean, 2), std::to_string(s.freedom), fixedText(100 * s.inside, 1) + " %",
                          fixedText(s.low, 3) + " to " + fixedText(s.high, 2)});
  page.table(table);
  page.beginGallery();
  for (int axis = 0; axis < 3; ++axis)
    page.figure(errorWithSigma(c, axis), std::string("Position error along ") + "xyz"[axis] +
                                             "; the band is three standard deviations to both sides");
  page.endGallery();
}

std::vector<std::vector<std::string>> trajectoryRows(const TrajectoryErrors& e) {
  return {{"alignment", nameOf(e.alignment)},
          {"poses with ground truth", std::to_string(e.pairs) + " of " + std::to_string(e.poses)},
          {"first pose", fixedText(e.start_offset_s, 2) + " s after the start of the ground truth"},
          {"coverage", fixedText(100 * e.coverage_time, 1) + " % of " + fixedText(e.duration_s, 1) + " s, " +
                           fixedText(100 * e.coverage_path, 1) + " % of " + fixedText(e.path_m, 1) + " m"},
          {"position RMSE (ATE)", metres(e.position_m.rmse)},
          {"position median", metres(e.position_m.median)},
          {"position maximum", metres(e.position_m.max)},
          {"position RMSE over the whole recording", metres(e.whole_rmse_m)},
          {"rotation RMSE", fixedText(kDegrees * e.rotation_rad.rmse, 3) + " deg"},
          {"scale (truth / estimate)", fixedText(e.scale, 5)}};
}

std::string evaluationPage(const Evaluation& evaluation) {
  HtmlPage page("Evaluation of " + (evaluation.trajectory ? evaluation.estimate_name : evaluation.map_name));
  if (evaluation.trajectory) trajectorySection(evaluation, page);
  if (evaluation.consistency) consistencySection(*evaluation.consistency, page);
  if (evaluation.lines) mapSection(evaluation, page);
  return page.text();
}

}  // namespace lintel
