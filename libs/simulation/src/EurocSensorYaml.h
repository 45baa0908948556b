// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Rig.h"

namespace lintel {

// The sensor.yaml of the EuRoC recordings, as text.

std::string cameraYaml(const Rig& rig);
std::string imuYaml(const Rig& rig);
std::string groundTruthYaml();

}  // namespace lintel
