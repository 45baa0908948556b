// SPDX-License-Identifier: BSD-3-Clause
#include "RecordingInfo.h"

#include "ProgramMain.h"

#include <filesystem>
#include <iomanip>
#include <ostream>
#include <stdexcept>

#include "lintel/core/AtomicFile.h"
#include "lintel/sensing/Calibration.h"
#include "lintel/sensing/RecordedSensors.h"
#include "lintel/sensing/RigReport.h"

namespace lintel {
namespace {

void printSensors(const std::string& recording, const RecordingParams& params, std::ostream& out) {
  std::size_t width = 5;
  const std::vector<RecordedSensor> sensors = recordedSensors(recording, params);
  for (const RecordedSensor& sensor : sensors) width = std::max(width, sensor.label.size());
  out << recording << ":\n" << std::fixed << std::setprecision(1);
  for (const RecordedSensor& sensor : sensors) {
    out << "  " << std::left << std::setw(static_cast<int>(width)) << sensor.label << "  " << std::right << std::setw(9)
        << sensor.count;
    if (sensor.rate_hz > 0)
      out << std::setw(9) << sensor.rate_hz << " Hz  ";
    else
      out << std::string(14, ' ');
    out << sensor.kind << "\n";
  }
}

}  // namespace

void printRecordingInfo(const InfoRequest& request, std::ostream& out, std::ostream& err) {
  if (!request.save_calibration.empty() && std::filesystem::exists(request.save_calibration) && !request.overwrite)
    throw std::runtime_error(request.save_calibration + ": exists already; choose another name or add -w");
  if (!request.recording.empty()) printSensors(request.recording, request.params, out);
  const RigReport report = reportRig(request.recording, request.params);
  out << rigInWords(report.rig, report.time_shift_s);
  for (const std::string& warning : report.warnings) err << "lintel-vio: warning: " << oneLine(warning) << "\n";
  if (request.save_calibration.empty()) return;
  AtomicFile::writeWhole(request.save_calibration, writeCalibration(report.rig, report.time_shift_s, request.form));
}

}  // namespace lintel
