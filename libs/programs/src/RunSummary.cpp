// SPDX-License-Identifier: BSD-3-Clause
#include "RunSummary.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <ostream>

#include "lintel/exporting/MapExport.h"
#include "lintel/reporting/Progress.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

double lengthOf(const std::vector<OdometryPose>& trajectory) {
  double length_m = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length_m += (trajectory[i].T_w_b.p - trajectory[i - 1].T_w_b.p).norm();
  return length_m;
}

void summarisePieces(const std::vector<MapPiece>& pieces, std::ostream& out) {
  if (pieces.size() < 2) return;
  const auto apart =
      std::count_if(pieces.begin(), pieces.end(), [](const MapPiece& piece) { return piece.world != 0; });
  out << pieces.size() << " pieces between interruptions: ";
  if (apart == 0) {
    out << "places that they have in common bring the refined ones into one frame\n";
  } else {
    out << apart << " not in the frame of the first, as no place is common for certain\n";
  }
}

void summariseTrajectory(const OdometryResult& result, double wall_s, std::ostream& out) {
  const OdometryStatistics& s = result.statistics;
  out << s.frames << " frames in " << durationText(wall_s) << " ("
      << static_cast<double>(s.frames) / std::max(wall_s, 1e-3) << " frames/s), " << s.frames_with_pose
      << " with a pose, " << lengthOf(result.trajectory) << " m travelled";
  if (s.first_pose_s > 0) out << ", first pose after " << s.first_pose_s << " s";
  out << "\n";
  for (const std::string& failure : s.failures) out << "started anew " << failure << "\n";
  summarisePieces(result.map.pieces, out);
  for (const Stretch& blind : s.blind)
    out << "nothing to be seen from " << blind.from_s << " to " << blind.to_s
        << " s: the IMU alone carried the poses there\n";
}

void summariseMap(const OdometryResult& result, std::ostream& out) {
  const LineMap& map = result.map;
  out << "map: " << map.lines.size() << " lines, " << map.points.size() << " points, " << map.keyframes.size()
      << " keyframes\n";
  const auto mapped =
      std::count_if(map.lines.begin(), map.lines.end(), [](const MapLine& line) { return line.mapped; });
  if (mapped > 0)
    out << "     " << mapped << " of the lines tracking had missed: found in " << result.densification.images
        << " images afterwards\n";
  if (result.lines_beside > 0)
    out << "     " << result.lines_beside
        << " more lines run beside better seen ones and were left out (map.spacing.min_m, 0 keeps them)\n";
  if (!result.refinement.verdict.empty()) out << result.refinement.verdict << "\n";
  if (result.refined_trajectory.size() > result.statistics.frames_with_pose)
    out << "     its trajectory has " << result.refined_trajectory.size() << " poses: the frames that "
        << (map.pieces.size() > 1 ? "starts were" : "the start was") << " made of have one as well\n";
}

void summariseFiles(const OdometryResult& result, const WrittenRun& written, std::ostream& out) {
  out << "written: " << (fs::path(written.output) / "trajectory.tum").string() << ", trajectory_covariance.csv"
      << (result.refinement.accepted ? ", trajectory_refined.tum" : "")
      << ", map.lintel, stats.json, config.yaml, report.html" << (result.found_mask ? ", mask.pgm" : "") << "\n";
  for (const std::string& file : written.exported) {
    std::string hint = viewerHint(fs::path(file).extension().string().substr(1));
    if (const std::size_t place = hint.find("FILE"); place != std::string::npos) hint.replace(place, 4, file);
    out << "  " << file << ": open it with " << hint << "\n";
  }
}

}  // namespace

void summarise(const OdometryResult& result, const WrittenRun& written, std::ostream& out) {
  if (!result.fault().empty()) out << "NOT TO BE TRUSTED: " << result.fault() << "\n";
  out << std::fixed << std::setprecision(1);
  summariseTrajectory(result, written.wall_s, out);
  summariseMap(result, out);
  summariseFiles(result, written, out);
}

}  // namespace lintel
