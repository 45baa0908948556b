// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lintel/evaluation/Consistency.h"
#include "lintel/evaluation/LineErrors.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

class HtmlPage;

/// What lintel-eval has found, for its page.
struct Evaluation {
  std::string estimate_name, groundtruth_name, map_name;
  StampedPoses estimate, groundtruth;
  std::optional<TrajectoryErrors> trajectory, map_trajectory;
  std::optional<Consistency> consistency;
  std::optional<LineErrors> lines;
  LineMap map;
  Similarity S_truth_map;
  std::vector<TrueLine> true_lines;
};

/// The page of `lintel-eval --report`.
std::string evaluationPage(const Evaluation& evaluation);

/// Table and figures of a trajectory's errors and their sigmas; in the report of a run as well.
void consistencySection(const Consistency& consistency, HtmlPage& page);

/// Rows "what, value" of the figures; used by the report of a run as well.
std::vector<std::vector<std::string>> trajectoryRows(const TrajectoryErrors& errors);

}  // namespace lintel
