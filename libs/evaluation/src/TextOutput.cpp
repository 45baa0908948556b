// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/Output.h"

#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace lintel {

namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

void printStatistics(const char* name, const ErrorStatistics& s, double factor, const char* unit, std::ostream& out) {
  out << std::left << std::setw(16) << name << "RMSE " << fixed(s.rmse * factor, 4) << "  mean "
      << fixed(s.mean * factor, 4) << "  median " << fixed(s.median * factor, 4) << "  max " << fixed(s.max * factor, 4)
      << " " << unit << "\n";
}

void printRelative(const std::vector<RelativeErrors>& relative, std::ostream& out) {
  out << "relative errors  stretches   translation RMSE      median    rotation RMSE   median\n";
  for (const RelativeErrors& r : relative) {
    const std::string name = fixed(r.distance_m, 1) + (r.whole_path ? " m (all)" : " m");
    const double percent = 100.0 * r.translation_m.rmse / r.distance_m;
    out << "  " << std::left << std::setw(15) << name << std::right << std::setw(9) << r.translation_m.count
        << std::setw(11) << fixed(r.translation_m.rmse, 4) << " m" << std::setw(7) << fixed(percent, 2) << " %"
        << std::setw(9) << fixed(r.translation_m.median, 4) << " m" << std::setw(11)
        << fixed(r.rotation_rad.rmse * kDegrees, 3) << " deg" << std::setw(8)
        << fixed(r.rotation_rad.median * kDegrees, 3) << " deg\n";
  }
}

void printShares(const char* name, const std::vector<double>& tolerances_m, const std::vector<double>& shares,
                 std::ostream& out) {
  out << std::left << std::setw(16) << name;
  for (std::size_t i = 0; i < shares.size(); ++i)
    out << (i > 0 ? "  " : "") << fixed(shares[i], 3) << " @" << fixed(100 * tolerances_m[i], 0) << " cm";
}

void printSegmentErrors(const char* name, const SegmentErrors& e, std::ostream& out) {
  out << "  " << std::left << std::setw(18) << name << std::right << std::setw(6) << e.count << "  direction median "
      << fixed(e.direction_median_rad * kDegrees, 2) << "  p90 " << fixed(e.direction_p90_rad * kDegrees, 2)
      << " deg  distance median " << fixed(e.distance_median_m, 3) << " m\n";
}

void printSquared(const char* name, const SquaredErrorSummary& s, std::ostream& out) {
  out << "  " << std::left << std::setw(14) << name << "mean " << std::right << std::setw(8) << fixed(s.mean, 2)
      << " (right: " << s.freedom << ")  " << std::setw(5) << fixed(100 * s.inside, 1) << " % of the poses within "
      << fixed(s.low, 3) << " to " << fixed(s.high, 2) << " (right: 95 %)\n";
}

void printSigmas(const char* name, const ConsistencyBySource& c, std::ostream& out) {
  const std::pair<const char*, const SigmaShares*> all[] = {
      {"tracked", &c.tracked}, {"mapped", &c.mapped}, {"constrained", &c.constrained}};
  out << "  " << std::left << std::setw(14) << name;
  for (const auto& [source, s] : all)
    out << source << " " << fixed(s->within_1, 3) << ", " << fixed(s->within_2, 3) << " of " << s->ends
        << (s == &c.constrained ? "\n" : "  ");
}

}  // namespace

void printText(const Consistency& c, std::ostream& out) {
  out << "consistency     squared errors by the covariances (NEES) of " << c.poses
      << " poses, relative to the first pose" << (c.pieces > 1 ? " of " + std::to_string(c.pieces) + " pieces" : "")
      << "\n";
  printSquared("position", c.position, out);
  printSquared("yaw", c.yaw, out);
  printSquared("roll, pitch", c.roll_pitch, out);
}

void printText(const TrajectoryErrors& e, std::ostream& out) {
  out << "trajectory      " << e.poses << " poses, " << e.pairs << " with ground truth, from "
      << fixed(e.start_offset_s, 2) << " s after its start\n"
      << "coverage        " << fixed(100 * e.coverage_time, 1) << " % of " << fixed(e.duration_s, 1) << " s, "
      << fixed(100 * e.coverage_path, 1) << " % of " << fixed(e.path_m, 1) << " m\n"
      << "alignment       " << nameOf(e.alignment) << "\n";
  if (!e.complete)
    out << "INCOMPLETE      the errors below are of a part of the recording: do not compare them with those of a whole "
           "run\n";
  printStatistics("position (ATE)", e.position_m, 1, "m", out);
  out << "whole recording RMSE " << fixed(e.whole_rmse_m, 4)
      << " m  (where there is no estimate, the one nearest in time stands in)\n";
  printStatistics("rotation", e.rotation_rad, kDegrees, "deg", out);
  out << "scale           " << fixed(e.scale, 5) << " (truth / estimate by Sim(3), ATE RMSE then "
      << fixed(e.position_sim3_m.rmse, 4) << " m)\n";
  printRelative(e.relative, out);
}

void printText(const LineErrors& e, std::ostream& out) {
  out << "lines           " << e.lines << " of " << fixed(e.length_m, 1) << " m, " << e.degenerate << " degenerate, "
      << e.constrained << " constrained\n";
  if (!e.surface_precision.empty()) {
    printShares("on surfaces", e.tolerances_m, e.surface_precision, out);
    out << "  of the map on true surfaces\n" << std::left << std::setw(16) << "as limap's";
    for (std::size_t i = 0; i < e.surface_length_m.size(); ++i)
      out << (i > 0 ? "  " : "") << "R " << fixed(e.surface_length_m[i], 1) << " m, P "
          << fixed(100 * e.surface_lines[i], 1) << " % @" << fixed(100 * e.tolerances_m[i], 0) << " cm";
    out << "\n";
  }
  printShares("precision", e.tolerances_m, e.precision, out);
  out << "  of the map on true edges\n";
  printShares("recall", e.tolerances_m, e.recall, out);
  out << "  of " << fixed(e.observable_m, 1) << " m observable edges\n";
  out << "duplicates      " << fixed(e.duplicates, 2) << "; " << fixed(e.true_duplicates, 2)
      << " without lines that images show as two\nmatched segments\n";
  printSegmentErrors("all", e.all_matched, out);
  printSegmentErrors("well determined", e.well_determined_matched, out);
  printSegmentErrors("degenerate", e.degenerate_matched, out);
  printSegmentErrors("constrained", e.constrained_matched, out);
}

void printText(const LineConsistency& c, std::ostream& out) {
  out << "ends within 1 and 2 sigmas of their edge\n";
  printSigmas("near an edge", c.near, out);
  printSigmas("edge seen", c.seen, out);
}

}  // namespace lintel
