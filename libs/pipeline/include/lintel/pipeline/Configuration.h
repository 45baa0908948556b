// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "lintel/densification/DensifyParams.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/MapParams.h"
#include "lintel/places/PlaceSearch.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Everything that can be set of lintel-vio. The params' field lists drive reading, writing and checking.
struct Configuration {
  FrontEndParams tracking;
  EstimatorParams estimator;
  MapParams map;
  PlaceParams loops;
  RefinementParams refinement;
  DensifyParams densification;

  template <class F>
  void fields(F&& field) {
    field("features", tracking.features, FrontEndParams::kFeatures);
    field("tracking", tracking);
    field("estimator", estimator);
    field("map", map);
    field("loops", loops);
    field("refinement", refinement);
    field("densification", densification);
  }
};

/// A key that does not exist, a value of the wrong type or beyond its limits: one line naming file and key.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sets what the YAML file holds; what it leaves out keeps its value. Throws ConfigurationError.
void readConfiguration(const std::string& path, Configuration& configuration);

/// Sets `key=value`, the key with dots, e.g. estimator.keyframes=8. Throws ConfigurationError.
void setOption(const std::string& assignment, Configuration& configuration);

/// The whole configuration as YAML; reading it back gives the same values to the last bit.
std::string writeConfiguration(const Configuration& configuration);

}  // namespace lintel
