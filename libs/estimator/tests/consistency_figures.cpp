// SPDX-License-Identifier: BSD-3-Clause
// A measuring program, not a test: errors and consistency on simulated tracks with white noise and an exact model. Not
// built by default:
//
//   ninja -C build/release consistency_figures
//   build/release/libs/estimator/consistency_figures SEEDS DURATION_S LINES [MODE] [FIRST_SEED]
//
// LINES in each image: 25 or 0. MODE: plain (without robust losses), given (the IMU's noise is not measured anew),
// plain,given, or default. Prints the error of the causal trajectory (RMSE after
// alignment of position and yaw) and, at some times, the mean over the seeds of the squared errors in units of the
// estimated covariance (NEES) for each degree of freedom, which is 1 where that is right, with the bounds of 95 %, the
// median, and the largest. Points and lines: of single distances and directions, as handed over to the map; their
// bounds are left out, since those of one flight are not independent.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "ConsistencyFlight.h"

using namespace lintel::test;

namespace {

struct Values {
  std::vector<double> values;
  int freedom = 1;
};
using Table = std::map<std::string, Values>;

void add(const SquaredErrors& errors, Table& table) {
  for (const auto& [name, error] : errors) {
    table[name].values.push_back(error.value);
    table[name].freedom = error.freedom;
  }
}

void print(Table& table, bool with_bounds) {
  for (auto& [name, v] : table) {
    std::sort(v.values.begin(), v.values.end());
    double sum = 0;
    for (const double value : v.values) sum += value;
    const double mean = sum / static_cast<double>(v.values.size());
    const auto [low, high] = boundsOfMean(v.values.size(), v.freedom);
    std::printf("  %-20s %6.2f", name.c_str(), mean / v.freedom);
    if (with_bounds)
      std::printf("  [%.2f, %.2f] %-5s", low / v.freedom, high / v.freedom,
                  mean < low    ? "low"
                  : mean > high ? "HIGH"
                                : "in");
    std::printf("  median %5.2f  largest %6.1f  of %zu\n", v.values[v.values.size() / 2] / v.freedom,
                v.values.back() / v.freedom, v.values.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  ConsistencySetting setting;
  setting.duration_s = argc > 2 ? std::atof(argv[2]) : 30;
  setting.lines = argc > 3 ? std::atoi(argv[3]) : 25;
  const std::string mode = argc > 4 ? argv[4] : "";
  setting.plain = mode.find("plain") != std::string::npos;
  setting.imu_as_given = mode.find("given") != std::string::npos;
  const int first = argc > 5 ? std::atoi(argv[5]) : 1;
  setting.times_s = {6, 30, 120};
  std::vector<double> errors;
  std::map<double, Table> at;
  Table points, lines;
  int lost = 0;
  double logs = 0;
  for (int s = first; s < first + seeds; ++s) {
    const ConsistencyFlight flight = flyConsistently(static_cast<std::uint64_t>(s), setting);
    lost += flight.lost;
    std::printf("%.4f ", flight.rmse_m);
    std::fflush(stdout);
    if (flight.rmse_m < 0) continue;
    errors.push_back(flight.rmse_m);
    logs += std::log(flight.rmse_m);
    for (const auto& [t, by_name] : flight.at) add(by_name, at[t]);
    for (const SquaredErrors& point : flight.points) add(point, points);
    for (const SquaredErrors& line : flight.lines) add(line, lines);
  }
  std::sort(errors.begin(), errors.end());
  std::printf("\nRMSE median %.4f geometric mean %.4f m of %zu flights, %d lost\n",
              errors.empty() ? 0 : errors[errors.size() / 2], std::exp(logs / static_cast<double>(errors.size())),
              errors.size(), lost);
  for (auto& [t, table] : at) {
    std::printf("after %.0f s\n", t);
    print(table, true);
  }
  std::printf("points\n");
  print(points, false);
  std::printf("lines\n");
  print(lines, false);
  return 0;
}
