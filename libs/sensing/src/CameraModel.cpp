// SPDX-License-Identifier: BSD-3-Clause
#include "CameraModel.h"

#include <algorithm>
#include <cmath>

#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

class CameraMaker {
 public:
  CameraMaker(const CameraDescription& description, const std::string& where) : d_(description), where_(where) {}

  PinholeRadtan make() {
    if (d_.projection != "pinhole" && d_.projection != "PINHOLE")
      refuse(d_.projection_key, "'" + d_.projection + "' is not supported: use pinhole");
    setSize();
    setIntrinsics();
    setDistortion();
    checkValues();
    return camera_;
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const {
    throw RecordingError(where_ + ": " + key + " " + what);
  }

  void checkCount(const std::vector<double>& values, std::size_t count, const std::string& key) const {
    if (values.size() != count)
      refuse(key, "has " + std::to_string(values.size()) + " values, expected " + std::to_string(count));
  }

  void setSize() {
    for (const double pixels : {d_.width, d_.height})
      if (!(pixels >= 1 && pixels <= 65536 && pixels == std::floor(pixels)))
        refuse(d_.size_key, "must be two whole numbers of pixels, width and height");
    camera_.width = static_cast<int>(d_.width);
    camera_.height = static_cast<int>(d_.height);
  }

  void setIntrinsics() {
    checkCount(d_.intrinsics, 4, d_.intrinsics_key);
    camera_.fx = d_.intrinsics[0];
    camera_.fy = d_.intrinsics[1];
    camera_.cx = d_.intrinsics[2];
    camera_.cy = d_.intrinsics[3];
  }

  void setDistortion() {
    if (d_.distortion == "none") return;
    if (d_.distortion != "radial-tangential" && d_.distortion != "radtan" && d_.distortion != "plumb_bob")
      refuse(d_.distortion_key,
             "'" + d_.distortion + "' is not supported: use radial-tangential or none (undistorted images)");
    std::vector<double> k = d_.coefficients;
    // OpenCV and ROS write k3 to k6 as zeros where the model has four coefficients
    while (k.size() > 4 && k.back() == 0) k.pop_back();
    if (k.size() > 4)
      refuse(d_.coefficients_key, "has terms k3 to k6, which are not supported: calibrate with k1 k2 p1 p2 only");
    checkCount(k, 4, d_.coefficients_key);
    camera_.k1 = k[0];
    camera_.k2 = k[1];
    camera_.p1 = k[2];
    camera_.p2 = k[3];
  }

  void checkValues() const {
    const PinholeRadtan& c = camera_;
    for (const double value : {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2})
      if (!std::isfinite(value))
        throw RecordingError(where_ + ": a camera parameter is not finite: calibrate the camera");
    if (c.fx <= 0 || c.fy <= 0)
      throw RecordingError(where_ + ": the focal lengths must be greater than 0: calibrate the camera");
  }

  const CameraDescription& d_;
  const std::string& where_;
  PinholeRadtan camera_;
};

}  // namespace

PinholeRadtan makeCamera(const CameraDescription& description, const std::string& where) {
  return CameraMaker(description, where).make();
}

}  // namespace lintel
