// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "Bag.h"
#include "lintel/core/Frame.h"

namespace lintel {

// Messages of ROS from their bytes. All throw ByteReader::OutOfBytes when these end too early.

/// Time of sensor_msgs' headers [ns]; of a message that was never stamped 0.
std::int64_t stampOf(const BagMessage& message, BagEncoding encoding);

/// sensor_msgs/Imu. What a sensor does not measure is 0 in it.
ImuSample imuOf(const BagMessage& message, BagEncoding encoding);

/// sensor_msgs/Image or sensor_msgs/CompressedImage as 8-bit grey. Throws ImageFault naming `where`.
GrayImage imageOf(const BagMessage& message, const BagTopic& topic, const std::string& where);

}  // namespace lintel
