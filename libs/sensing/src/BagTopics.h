// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "Bag.h"
#include "Warnings.h"

namespace lintel {

/// The topic of images to read: `named`, else `preferred` if it is there, else the alphabetically first that is no
/// depth image; a choice among several is noted. `path`: for messages. Throws RecordingError.
BagTopic chooseImages(const std::vector<BagTopic>& topics, const std::string& named, const std::string& preferred,
                      const std::string& path, std::vector<Warning>& warnings);

/// The topic of the IMU, or those of gyroscope and accelerometer ("GYRO,ACCEL" when named). Topics that hold half a
/// sensor are known by "gyro" and "accel" in their names.
std::vector<BagTopic> chooseImu(const std::vector<BagTopic>& topics, const std::string& named,
                                const std::string& preferred, const std::string& path, std::vector<Warning>& warnings);

}  // namespace lintel
