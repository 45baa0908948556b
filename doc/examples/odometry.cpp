// SPDX-License-Identifier: BSD-3-Clause
// odometry RECORDING CONFIG.yaml OUT: trajectory and map of a recording, by Lintel's C++ interface; the same files,
// byte for byte, as lintel-vio RECORDING -c CONFIG.yaml -o OUT --export glb,ply
#include <cstdio>
#include <exception>

#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/Results.h"

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fprintf(stderr, "usage: odometry RECORDING CONFIG.yaml OUT\n");
    return 2;
  }
  const auto recording = lintel::openRecording(argv[1]);  // an EuRoC folder or a rawlog
  lintel::Configuration configuration;
  lintel::readConfiguration(argv[2], configuration);

  lintel::RunOptions options;
  options.progress = [](const lintel::RunProgress& progress) {
    const bool frames = progress.stage == lintel::RunStage::kFrames;
    std::fprintf(stderr, "%s %zu of %zu\r", frames ? "frame" : "refinement, percent", progress.done, progress.total);
  };
  const lintel::OdometryResult result = lintel::runOdometry(*recording, configuration, options);
  lintel::writeResults(result, argv[3], {"glb", "ply"});

  std::fprintf(stderr, "%zu poses, %zu lines\n", result.trajectory.size(), result.map.lines.size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "odometry: %s\n", error.what());
  return 1;
}
