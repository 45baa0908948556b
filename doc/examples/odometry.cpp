// SPDX-License-Identifier: BSD-3-Clause
// odometry RECORDING MAP.EXT: trajectory on standard output, map to a file, by Lintel's C++ interface.
#include <cstdio>
#include <exception>

#include "lintel/estimator/Estimator.h"
#include "lintel/exporting/MapExport.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEnd.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: odometry RECORDING MAP.EXT\n");
    return 2;
  }
  const auto recording = lintel::openRecording(argv[1]);  // an EuRoC folder or a rawlog
  lintel::FrontEnd front_end(recording->rig(), lintel::FrontEndParams{});
  lintel::Estimator estimator(recording->rig(), lintel::EstimatorParams{});
  lintel::MapBuilder map(recording->rig(), lintel::MapParams{});

  while (const auto step = recording->next()) {  // a frame and the IMU samples before it
    const lintel::FrameTracks tracks = front_end.process(step->frame, step->imu);
    const lintel::WindowUpdate update = estimator.process(tracks, step->imu);
    map.add(update);
    if (!update.hasPose()) continue;
    const Eigen::Vector3d& p_w_b = update.T_w_b.p;
    std::printf("%lld %.6f %.6f %.6f\n", static_cast<long long>(update.t_ns), p_w_b.x(), p_w_b.y(), p_w_b.z());
  }
  map.add(estimator.finish());
  lintel::exportMap(map.build(), argv[2]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "odometry: %s\n", error.what());
  return 1;
}
