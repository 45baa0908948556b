// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/pages/RunSeries.h"
#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/RunCosts.h"

namespace lintel {

/// What the report of a run is made of.
struct RunRecord {
  std::string input;          ///< as given on the command line
  std::string configuration;  ///< effective, YAML
  std::string defaults;       ///< the built-in configuration, YAML: only what differs is shown at once
  Rig calibration;            ///< as the recording came with
  RunCosts costs;             ///< of all but the report itself
  std::vector<std::string> recording_warnings;
  StampedPoses groundtruth;  ///< empty if the recording carries none
  std::string truth_fault;   ///< why it could not be read
  std::string map_picture;   ///< bytes of a PNG; empty if none was made
};

/// The page report.html of lintel-vio.
std::string runReport(const RunRecord& record, const OdometryResult& result, const RunSeries& series);

}  // namespace lintel
