// SPDX-License-Identifier: BSD-3-Clause
#include "RunTables.h"

#include <algorithm>

#include "Degrees.h"
#include "lintel/geometry/LensNames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// Rows of one table: a quantity as given, as the window had it, its sigma, and after the batch refinement.
class CalibrationRows {
 public:
  CalibrationRows(bool with_sigma, bool with_batch) : with_sigma_(with_sigma), with_batch_(with_batch) {
    if (with_batch_) table_.columns.emplace_back("after the batch");
  }

  void add(const std::string& name, double given, double window, double sigma, double batch, int decimals) {
    const std::string certainty = !with_sigma_ ? "-" : sigma > 0 ? fixedText(sigma, decimals) : "held";
    table_.rows.push_back({name, fixedText(given, decimals), fixedText(window, decimals), certainty});
    if (with_batch_) table_.rows.back().emplace_back(fixedText(batch, decimals));
  }

  const Table& table() const { return table_; }

 private:
  bool with_sigma_, with_batch_;
  Table table_{"calibration", "As given, and as refined on the way", {"", "given", "refined", "sigma"}, {}, {}};
};

}  // namespace

Table calibrationTable(const RunRecord& record, const OdometryResult& result) {
  const CalibrationEstimate& last = result.window_calibration;
  const CalibrationSigma sigma = last.sigma.value_or(CalibrationSigma());
  CalibrationRows rows(last.sigma.has_value(), result.refinement.accepted);
  const Camera &a = record.calibration.camera, &b = last.camera, &c = result.rig.camera;
  rows.add("fx [px]", a.fx, b.fx, sigma.camera[0], c.fx, 2);
  rows.add("fy [px]", a.fy, b.fy, sigma.camera[1], c.fy, 2);
  rows.add("cx [px]", a.cx, b.cx, sigma.camera[2], c.cx, 2);
  rows.add("cy [px]", a.cy, b.cy, sigma.camera[3], c.cy, 2);
  for (std::size_t i = 0; i < 2; ++i)
    rows.add(lensName(a.model).coefficients[i], a.lens[i], b.lens[i], sigma.camera[4 + static_cast<int>(i)], c.lens[i],
             4);
  const Pose &given = record.calibration.T_b_c, &window = last.T_b_c, &batch = result.rig.T_b_c;
  for (int axis = 0; axis < 3; ++axis)
    rows.add(std::string("camera on the IMU, ") + "xyz"[axis] + " [m]", given.p[axis], window.p[axis],
             sigma.p_b_c_m[axis], batch.p[axis], 4);
  const Eigen::Vector3d window_rad = logRotation(given.q.conjugate() * window.q);
  const Eigen::Vector3d batch_rad = logRotation(given.q.conjugate() * batch.q);
  for (int axis = 0; axis < 3; ++axis)
    rows.add(std::string("camera turned about its ") + "xyz"[axis] + " [deg]", 0, kDegrees * window_rad[axis],
             kDegrees * sigma.R_b_c_rad[axis], kDegrees * batch_rad[axis], 3);
  rows.add("time offset [ms]", 0, 1000 * last.time_offset_s, 1000 * sigma.time_offset_s, 1000 * result.time_offset_s,
           3);
  rows.add("readout of an image [ms]", 1000 * record.calibration.readout_s(), 1000 * last.readout_s,
           1000 * sigma.readout_s, 1000 * result.rig.readout_s(), 3);
  return rows.table();
}

Table costsTable(const RunRecord& record, const OdometryResult& result) {
  const double process_ms = processTimeMs(), frames = std::max(1.0, static_cast<double>(result.statistics.frames));
  Table table{"costs",
              "CPU time of the whole process",
              {"stage", "[s]", "a frame [ms]"},
              {},
              {"What drawing this page cost is in stats.json."}};
  for (const auto& [stage, ms] : record.costs.breakdown(result.statistics, process_ms))
    table.rows.push_back({stage, fixedText(ms / 1000, 3), fixedText(ms / frames, 2)});
  table.rows.push_back({"together", fixedText(process_ms / 1000, 3), fixedText(process_ms / frames, 2)});
  return table;
}

}  // namespace lintel
