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

/// `accelerometer_axes` of an IMU (Rig.h), if given.
std::optional<Eigen::Matrix3d> accelerometerAxes(const YamlFile& file);
/// Of nine numbers, row by row.
Eigen::Matrix3d checkedAxes(const std::vector<double>& values, const std::string& where);
/// As a list in YAML.
std::string axesText(const Eigen::Matrix3d& axes);

}  // namespace lintel
