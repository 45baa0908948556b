// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrajectoryOutput.h"

#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

#include "JsonFigures.h"

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

Json jsonOf(const Similarity& s) {
  const Pose& T = s.T_a_b;
  return {{"scale", s.scale},
          {"quaternion_xyzw", {T.q.x(), T.q.y(), T.q.z(), T.q.w()}},
          {"translation_m", {T.p.x(), T.p.y(), T.p.z()}}};
}

}  // namespace

void printText(const TrajectoryErrors& e, std::ostream& out) {
  out << "trajectory      " << e.poses << " poses, " << e.pairs << " with ground truth, from "
      << fixed(e.start_offset_s, 2) << " s after its start\n"
      << "coverage        " << fixed(100 * e.coverage_time, 1) << " % of " << fixed(e.duration_s, 1) << " s, "
      << fixed(100 * e.coverage_path, 1) << " % of " << fixed(e.path_m, 1) << " m\n"
      << "alignment       " << nameOf(e.alignment) << "\n";
  printStatistics("position (ATE)", e.position_m, 1, "m", out);
  printStatistics("rotation", e.rotation_rad, kDegrees, "deg", out);
  out << "scale           " << fixed(e.scale, 5) << " (truth / estimate by Sim(3), ATE RMSE then "
      << fixed(e.position_sim3_m.rmse, 4) << " m)\n";
  printRelative(e.relative, out);
}

std::string toJson(const TrajectoryErrors& e) {
  Json relative = Json::array();
  for (const RelativeErrors& r : e.relative)
    relative.push_back({{"distance_m", r.distance_m},
                        {"whole_path", r.whole_path},
                        {"translation_m", lintel::jsonOf(r.translation_m)},
                        {"rotation_rad", lintel::jsonOf(r.rotation_rad)}});
  const Json json = {{"poses", e.poses},
                     {"pairs", e.pairs},
                     {"start_offset_s", e.start_offset_s},
                     {"duration_s", e.duration_s},
                     {"path_m", e.path_m},
                     {"coverage_time", e.coverage_time},
                     {"coverage_path", e.coverage_path},
                     {"alignment", nameOf(e.alignment)},
                     {"transform", jsonOf(e.S_truth_estimate)},
                     {"position_m", lintel::jsonOf(e.position_m)},
                     {"rotation_rad", lintel::jsonOf(e.rotation_rad)},
                     {"scale", e.scale},
                     {"position_sim3_m", lintel::jsonOf(e.position_sim3_m)},
                     {"relative", relative}};
  return json.dump(2);
}

}  // namespace lintel
