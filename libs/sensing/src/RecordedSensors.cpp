// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/RecordedSensors.h"

#include <mrpt/obs/CObservation.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "Bag.h"
#include "EurocFolder.h"
#include "PlainStream.h"
#include "RawlogFile.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

/// Counts stamps.
struct Stamps {
  std::size_t count = 0;
  std::int64_t first_ns = 0, last_ns = 0;

  void add(std::int64_t t_ns) {
    if (count++ == 0) first_ns = t_ns;
    last_ns = t_ns;
  }
  double rate_hz() const { return BagTopic{"", "", BagEncoding::kRos1, count, first_ns, last_ns}.rate_hz(); }
};

std::vector<RecordedSensor> sensorsOfBag(const std::string& path) {
  std::vector<RecordedSensor> sensors;
  const std::unique_ptr<Bag> bag = openBag(path);
  for (const BagTopic& topic : bag->topics()) sensors.push_back({topic.name, topic.type, topic.count, topic.rate_hz()});
  return sensors;
}

std::vector<RecordedSensor> sensorsOfFolder(const std::string& path) {
  const std::string mav0 = findMav0(path);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(mav0))
    if (fs::exists(entry.path() / "data.csv")) names.insert(entry.path().filename().string());
  std::vector<RecordedSensor> sensors;
  for (const std::string& name : names) {
    EurocTable table((fs::path(mav0) / name / "data.csv").string(), 2);
    Stamps stamps;
    while (table.next([](Fault, const std::string&) {})) stamps.add(table.time_ns());
    const char* kind = fs::is_directory(fs::path(mav0) / name / "data") ? "images" : "table";
    sensors.push_back({name, kind, stamps.count, stamps.rate_hz()});
  }
  return sensors;
}

std::vector<RecordedSensor> sensorsOfRawlog(const std::string& path) {
  std::map<std::pair<std::string, std::string>, Stamps> found;
  RawlogFile file(path);
  try {
    while (const auto observation = file.nextAsRead())
      found[{observation->sensorLabel, observation->GetRuntimeClass()->className}].add(timeOf(*observation));
  } catch (const RecordingError&) {  // what is before the damage is listed
    if (found.empty()) throw;
  }
  std::vector<RecordedSensor> sensors;
  sensors.reserve(found.size());
  for (const auto& [name, stamps] : found) sensors.push_back({name.first, name.second, stamps.count, stamps.rate_hz()});
  return sensors;
}

std::vector<RecordedSensor> sensorsOfTables(const std::string& path, const RecordingParams& params) {
  const PlainTables tables = plainTables(path, params);
  Stamps images, samples;
  for (const TimedImage& image : readImageTimes(tables.times)) images.add(image.t_ns);
  const ImuSource imu = openImuTables(tables.imu);
  while (const auto sample = imu([](Fault, const std::string&) {})) samples.add(sample->t_ns);
  return {
      {fs::path(tables.times).filename().string(), isFilm(path) ? "film" : "images", images.count, images.rate_hz()},
      {fs::path(tables.imu).filename().string(), "IMU", samples.count, samples.rate_hz()}};
}

}  // namespace

std::vector<RecordedSensor> recordedSensors(const std::string& path, const RecordingParams& params) {
  if (isFilm(path) || isImageFolder(path)) return sensorsOfTables(path, params);
  if (isBag(path)) return sensorsOfBag(path);
  return fs::is_directory(path) ? sensorsOfFolder(path) : sensorsOfRawlog(path);
}

}  // namespace lintel
