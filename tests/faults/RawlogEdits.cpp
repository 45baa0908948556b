// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include "FaultEdits.h"
#include "TinyRawlog.h"

namespace lintel::test {

namespace {

using Words = std::vector<std::string>;
using Observations = std::vector<ObservationPtr>;

std::size_t placeIn(std::size_t size, const std::string& percent) {
  return std::min(size, static_cast<std::size_t>(std::stod(percent) / 100 * static_cast<double>(size)));
}

/// The observations of a label, from one place to another.
std::vector<std::size_t> chosen(const Observations& all, const Words& w) {
  std::vector<std::size_t> of_label;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i]->sensorLabel == w.at(3)) of_label.push_back(i);
  const std::size_t a = placeIn(of_label.size(), w.at(4)), b = placeIn(of_label.size(), w.at(5));
  return {of_label.begin() + static_cast<long>(a), of_label.begin() + static_cast<long>(b)};
}

template <class Sensor>
Sensor& as(const ObservationPtr& observation) {
  auto* sensor = dynamic_cast<Sensor*>(observation.get());
  if (sensor == nullptr) throw std::runtime_error("an observation of another class");
  return *sensor;
}

using Change =
    std::function<void(mrpt::obs::CObservation& observation, const ObservationPtr& pointer, const Words& words)>;

const std::map<std::string, Change>& changes() {
  using namespace mrpt::obs;
  static const std::map<std::string, Change> kChanges{
      {"label", [](CObservation& o, const ObservationPtr&, const Words& w) { o.sensorLabel = w.at(6); }},
      {"shift",
       [](CObservation& o, const ObservationPtr&, const Words& w) {
         o.timestamp +=
             std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(std::stod(w.at(6))));
       }},
      {"timeless", [](CObservation& o, const ObservationPtr&, const Words&) { o.timestamp = INVALID_TIMESTAMP; }},
      {"value", [](CObservation&, const ObservationPtr& p,
                   const Words& w) { as<CObservationIMU>(p).rawMeasurements.at(3) = std::stod(w.at(6)); }},
      {"without", [](CObservation&, const ObservationPtr& p,
                     const Words& w) { as<CObservationIMU>(p).dataIsPresent.at(std::stoul(w.at(6))) = false; }},
      {"resize",
       [](CObservation&, const ObservationPtr& p, const Words& w) {
         as<CObservationImage>(p).image.resize(std::stoul(w.at(6)), std::stoul(w.at(7)), mrpt::img::CH_GRAY);
       }},
      {"focal", [](CObservation&, const ObservationPtr& p,
                   const Words& w) { as<CObservationImage>(p).cameraParams.fx(std::stod(w.at(6))); }},
      {"lens", [](CObservation&, const ObservationPtr& p,
                  const Words& w) { as<CObservationImage>(p).cameraParams.k1(std::stod(w.at(6))); }},
      {"external", [](CObservation&, const ObservationPtr& p, const Words& w) {
         as<CObservationImage>(p).image.setExternalStorage(w.at(6));
       }}};
  return kChanges;
}

void change(Observations& all, const Words& w) {
  const std::vector<std::size_t> places = chosen(all, w);
  const std::string& verb = w.at(2);
  if (verb == "drop") {
    for (auto i = places.rbegin(); i != places.rend(); ++i) all.erase(all.begin() + static_cast<long>(*i));
  } else if (verb == "repeat") {
    for (auto i = places.rbegin(); i != places.rend(); ++i) all.insert(all.begin() + static_cast<long>(*i), all[*i]);
  } else if (verb == "reverse") {
    for (std::size_t a = 0, b = places.size(); a + 1 < b; ++a) std::swap(all[places[a]], all[places[--b]]);
  } else {
    for (const std::size_t i : places) changes().at(verb)(*all[i], all[i], w);
  }
}

}  // namespace

void applyRawlogEdit(const std::string& rawlog, const std::vector<std::string>& words) {
  edit(rawlog, [&](Observations& all) { change(all, words); });
}

}  // namespace lintel::test
