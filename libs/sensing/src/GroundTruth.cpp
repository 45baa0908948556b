// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/GroundTruth.h"

#include <mrpt/obs/CObservationRobotPose.h>

#include <filesystem>

#include "EurocFolder.h"
#include "RawlogFile.h"
#include "RawlogSources.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

namespace {

using TruePoses = std::vector<std::pair<std::int64_t, Pose>>;

void append(const mrpt::obs::CObservation& observation, TruePoses& poses) {
  const auto* robot = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation);
  if (robot == nullptr || robot->sensorLabel != "groundtruth") return;
  const std::int64_t t_ns = timeOf(observation);
  if (t_ns < 0 || (!poses.empty() && t_ns <= poses.back().first)) return;
  const auto T = robot->pose.mean.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = T(row, column);
  if (matrix.allFinite()) poses.emplace_back(t_ns, poseFromMatrix(matrix));
}

template <class Next>
TruePoses collect(const Next& next) {
  TruePoses poses;
  while (const auto observation = next()) append(*observation, poses);
  return poses;
}

}  // namespace

TruePoses readGroundTruth(const std::string& recording) {
  const WarningSink ignore = [](Fault, const std::string&) {};
  if (std::filesystem::is_directory(recording)) {
    const std::string csv = findMav0(recording) + "/state_groundtruth_estimate0/data.csv";
    if (!std::filesystem::exists(csv)) return {};
    const auto source = makeGroundtruthSource(csv);
    return collect([&] { return source->advance(ignore) ? source->make(ignore) : nullptr; });
  }
  RawlogFile file(recording);
  TruePoses poses;
  try {
    while (const auto observation = file.next()) append(*observation, poses);
  } catch (const RecordingError&) {  // what is before the damage is true all the same
    if (poses.empty()) throw;
  }
  return poses;
}

}  // namespace lintel
