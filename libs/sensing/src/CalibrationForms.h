// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "CameraModel.h"
#include "YamlFile.h"
#include "lintel/sensing/Calibration.h"

namespace lintel {

/// A camera whose model is made, and refused, when it is chosen.
CameraCalibration describedCamera(CameraDescription description, const std::string& where);

/// Adds a camera, in the place of one with the same label.
void addCamera(CameraCalibration camera, Calibration& calibration);

/// The path that a file gives for `key`, beside it unless absolute.
std::string besideFile(const YamlFile& file, const std::string& key);

/// Of VINS-Mono, which has the camera in the same file, or of VINS-Fusion, which names a file for each camera.
void readVinsForm(const YamlFile& file, Calibration& calibration);

/// The camera alone, as OpenCV's calibration program and ROS' camera_calibration write it.
void readOpenCvForm(const YamlFile& file, Calibration& calibration);

/// The delay from row to row that a camera's file gives under `line_delay_s`, if it does. Throws RecordingError.
std::optional<double> lineDelay_s(const YamlFile& file);
/// Throws RecordingError naming `where` unless it is one that a sensor may have.
double checkedLineDelay_s(double line_delay_s, const std::string& where);

/// `accelerometer_axes` and `gyroscope_axes` of an IMU, A and G of AxesErrors, if one of them is given.
std::optional<AxesErrors> axesErrors(const YamlFile& file);
/// Of nine numbers, row by row.
Eigen::Matrix3d checkedAxes(const std::vector<double>& values, const std::string& where);
/// The same two as lines of YAML, without those that are right.
std::string axesLines(const AxesErrors& axes, const std::string& indentation = "");

}  // namespace lintel
