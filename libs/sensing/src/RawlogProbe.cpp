// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogProbe.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "CameraModel.h"
#include "CanonicalPose.h"
#include "EurocYaml.h"
#include "RawlogFile.h"
#include "RawlogNote.h"

namespace lintel {
namespace {

using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationIMU;

constexpr std::int64_t kProbe_ns = 1000000000;

/// The observations of one label seen by the probe.
template <class Observation>
struct Seen {
  typename Observation::Ptr first;
  std::int64_t first_ns = 0, last_ns = 0;
  int count = 0;

  void add(const typename Observation::Ptr& observation) {
    last_ns = timeOf(*observation);
    if (count++ > 0) return;
    first = observation;
    first_ns = last_ns;
  }
  /// Mean rate, rounded to 0.1 Hz; 0 if unknown.
  double rate_hz() const {
    if (count < 3 || last_ns <= first_ns) return 0;
    return std::round(1e10 * (count - 1) / static_cast<double>(last_ns - first_ns)) / 10;
  }
};

struct Beginning {
  std::map<std::string, Seen<CObservationImage>> images;
  std::map<std::string, Seen<CObservationIMU>> imus;
  std::optional<RawlogNote> note;
  bool has_incomplete_imu = false;
};

bool wanted(const std::string& label, const std::string& chosen) { return chosen.empty() || label == chosen; }

/// The next observation; null also at a damaged place once there is enough: what is before it can still be read.
mrpt::obs::CObservation::Ptr nextOf(RawlogFile& file, bool enough) {
  try {
    return file.next();
  } catch (const RecordingError&) {
    if (!enough) throw;
    return nullptr;
  }
}

Beginning readBeginning(const std::string& path, const RecordingParams& params) {
  Beginning seen;
  RawlogFile file(path);
  std::optional<std::int64_t> until_ns;
  while (const auto observation = nextOf(file, until_ns.has_value())) {
    if (const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(observation)) {
      if (!seen.note) seen.note = parseNote(comment->text, file.where());
    } else if (const auto image = std::dynamic_pointer_cast<CObservationImage>(observation)) {
      if (wanted(image->sensorLabel, params.camera)) seen.images[image->sensorLabel].add(image);
    } else if (const auto imu = std::dynamic_pointer_cast<CObservationIMU>(observation)) {
      if (!wanted(imu->sensorLabel, params.imu)) continue;
      if (isComplete(*imu)) seen.imus[imu->sensorLabel].add(imu);
      seen.has_incomplete_imu = seen.has_incomplete_imu || !isComplete(*imu);
    }
    if (seen.images.empty() || seen.imus.empty()) continue;
    if (!until_ns) until_ns = timeOf(*observation) + kProbe_ns;
    if (timeOf(*observation) > *until_ns) break;
  }
  return seen;
}

void checkBeginning(const Beginning& seen, const std::string& path, const RecordingParams& params) {
  const auto named = [](const std::string& label) { return label.empty() ? "" : " labelled '" + label + "'"; };
  if (seen.images.empty())
    throw RecordingError(path + ": holds no camera image (CObservationImage, CObservationStereoImages)" +
                         named(params.camera) + ": record one, or name another camera");
  if (!seen.imus.empty()) return;
  if (seen.has_incomplete_imu)
    throw RecordingError(path + ": its IMU observations" + named(params.imu) +
                         " lack angular velocities or accelerations: both are needed on all three axes");
  throw RecordingError(path + ": holds no IMU sample (CObservationIMU)" + named(params.imu) + ": the IMU is needed");
}

/// MRPT's names of models are those that CameraModel knows. It has the coefficients in OpenCV's order.
Camera cameraOf(const CObservationImage& observation, const std::string& where) {
  const mrpt::img::TCamera& params = observation.cameraParams;
  CameraDescription description;
  description.width = params.ncols;
  description.height = params.nrows;
  description.intrinsics = {params.fx(), params.fy(), params.cx(), params.cy()};
  description.distortion = mrpt::typemeta::TEnumType<mrpt::img::DistortionModel>::value2name(params.distortion);
  description.coefficients.assign(params.dist.begin(), params.dist.end());
  if (params.distortion == mrpt::img::DistortionModel::kannala_brandt)
    description.coefficients = {params.k1(), params.k2(), params.k3(), params.k4()};
  description.distortion_key = "distortion";
  description.coefficients_key = "dist";
  description.size_key = "ncols, nrows";
  return makeCamera(description, where);
}

Pose poseOf(const mrpt::poses::CPose3D& pose, const std::string& where) {
  const auto T = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = T(row, column);
  return calibratedPose(matrix, where);
}

/// The calibration that the observations and the note carry.
Rig recordedRig(const Beginning& seen, const std::string& path, std::vector<Warning>& warnings) {
  const auto& [camera_label, images] = *seen.images.begin();
  const auto& [imu_label, samples] = *seen.imus.begin();
  EurocCamera camera;
  camera.model = cameraOf(*images.first, path + ": cameraParams of '" + camera_label + "'");
  camera.T_v_c = poseOf(images.first->cameraPose, path + ": cameraPose of '" + camera_label + "'");
  camera.rate_hz = images.rate_hz() > 0 ? images.rate_hz() : Rig().camera_rate_hz;
  EurocImu imu;
  imu.T_v_b = poseOf(samples.first->sensorPose, path + ": sensorPose of '" + imu_label + "'");
  imu.rate_hz = samples.rate_hz() > 0 ? samples.rate_hz() : Rig().imu_rate_hz;
  if (seen.note) {
    imu.noise = seen.note->imu_noise;
    imu.axes = seen.note->axes;
    imu.rate_hz = seen.note->imu_rate_hz;
    const auto rate = seen.note->camera_rates_hz.find(camera_label);
    if (rate != seen.note->camera_rates_hz.end()) camera.rate_hz = rate->second;
    const auto delay = seen.note->line_delays_s.find(camera_label);
    if (delay != seen.note->line_delays_s.end()) camera.line_delay_s = delay->second;
  } else {
    warnings.push_back(
        {Fault::Calibration,
         path + ": lacks the comment with the IMU's noise densities: those of an ADIS16448 are assumed"});
  }
  return rigOf(camera, imu);
}

}  // namespace

bool isComplete(const CObservationIMU& observation) {
  using namespace mrpt::obs;
  for (const TIMUDataIndex index : {IMU_WX, IMU_WY, IMU_WZ, IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC})
    if (!observation.has(index)) return false;
  return true;
}

RawlogProbe probeRawlog(const std::string& path, const RecordingParams& params, const GivenCalibration& given) {
  const Beginning seen = readBeginning(path, params);
  checkBeginning(seen, path, params);
  const auto& [camera_label, images] = *seen.images.begin();
  RawlogProbe probe;
  probe.camera_label = camera_label;
  probe.imu_label = seen.imus.begin()->first;
  if (images.first->image.isExternallyStored())
    probe.first_external_image = images.first->image.getExternalStorageFile();
  std::vector<Warning> of_recorded;
  probe.rig = given.rig([&] { return recordedRig(seen, path, of_recorded); }, probe.warnings);
  if (!given.hasNoise()) probe.warnings.insert(probe.warnings.end(), of_recorded.begin(), of_recorded.end());
  return probe;
}

}  // namespace lintel
