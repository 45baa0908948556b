// SPDX-License-Identifier: BSD-3-Clause
#include "CameraModel.h"

#include <algorithm>
#include <cmath>

#include "lintel/geometry/LensNames.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

class CameraMaker {
 public:
  CameraMaker(const CameraDescription& description, const std::string& where) : d_(description), where_(where) {}

  Camera make() {
    setSize();
    if (d_.projection == "pinhole" || d_.projection == "PINHOLE") {
      setIntrinsics(d_.intrinsics);
      setDistortion();
    } else {
      setProjection();
    }
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

  void setIntrinsics(const std::vector<double>& values) {
    checkCount(values, 4, d_.intrinsics_key);
    camera_.fx = values[0];
    camera_.fy = values[1];
    camera_.cx = values[2];
    camera_.cy = values[3];
  }

  /// A lens that is a projection of its own has its coefficients before fx fy cx cy, as Kalibr writes them.
  void setProjection() {
    const auto model = lensModel(d_.projection);
    if (!model || *model < LensModel::kDoubleSphere)
      refuse(d_.projection_key, "'" + d_.projection + "' is not supported: use pinhole, double-sphere or eucm");
    checkCount(d_.intrinsics, 6, d_.intrinsics_key);
    setLens(camera_, *model, {d_.intrinsics[0], d_.intrinsics[1]});
    setIntrinsics({d_.intrinsics.begin() + 2, d_.intrinsics.end()});
  }

  void setDistortion() {
    if (d_.distortion == "none") return;
    auto model = lensModel(d_.distortion);
    if (!model || *model >= LensModel::kDoubleSphere)
      refuse(d_.distortion_key, "'" + d_.distortion +
                                    "' is not supported: use radial-tangential, rational, equidistant or none "
                                    "(undistorted images)");
    std::vector<double> k = d_.coefficients;
    if (*model == LensModel::kRadialTangential) {
      // OpenCV and ROS write more coefficients than the model has, as zeros or for the rational one
      while (k.size() > 4 && k.back() == 0) k.pop_back();
      if (k.size() > 5 && k.size() <= 8) {
        model = LensModel::kRational;
        k.resize(8);
      }
    }
    if (!setLens(camera_, *model, k))
      refuse(d_.coefficients_key,
             "has " + std::to_string(k.size()) + " values, expected " + lensCoefficientCount(*model));
  }

  void checkValues() const {
    const Camera& c = camera_;
    std::vector<double> values = lensCoefficients(c);
    values.insert(values.end(), {c.fx, c.fy, c.cx, c.cy});
    for (const double value : values)
      if (!std::isfinite(value))
        throw RecordingError(where_ + ": a camera parameter is not finite: calibrate the camera");
    if (c.fx <= 0 || c.fy <= 0)
      throw RecordingError(where_ + ": the focal lengths must be greater than 0: calibrate the camera");
  }

  const CameraDescription& d_;
  const std::string& where_;
  Camera camera_;
};

}  // namespace

Camera makeCamera(const CameraDescription& description, const std::string& where) {
  return CameraMaker(description, where).make();
}

}  // namespace lintel
