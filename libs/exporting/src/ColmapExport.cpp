// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unordered_map>

#include "ColmapNames.h"
#include "Text.h"
#include "Writers.h"
#include "lintel/geometry/LensNames.h"

// Keyframes and points as a sparse model of COLMAP: a folder with cameras, images and points3D, as text or binary
// (https://colmap.github.io/format.html). Its poses are T_c_w, and the centre of its upper left pixel is (0.5, 0.5).
namespace lintel {

namespace {

constexpr double kPixelCentre_px = 0.5;
constexpr std::uint32_t kCamera = 1;  ///< there is one

struct ColmapPoint2 {
  Eigen::Vector2d px;
  std::uint64_t point = 0;
};

struct ColmapImage {
  std::uint32_t id = 0;
  Pose T_c_w;
  std::string name;
  std::vector<ColmapPoint2> points;
};

struct ColmapPoint {
  std::uint64_t id = 0;
  Eigen::Vector3d p_w;
  double error_px = 0;                                         ///< mean of its reprojections
  std::vector<std::pair<std::uint32_t, std::uint32_t>> track;  ///< image, place among its points
};

struct ColmapModel {
  Camera camera;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;
};

class ModelMaker {
 public:
  explicit ModelMaker(const Drawing& drawing) {
    model_.camera = drawing.map->rig.camera;
    for (const MapKeyframe& keyframe : drawing.keyframes) addImage(keyframe, drawing.map->rig);
    for (const DrawnPart& part : drawing.parts)
      for (const DrawnPoint& point : part.points) addPoint(*point.point);
  }
  ColmapModel take() { return std::move(model_); }

 private:
  void addImage(const MapKeyframe& keyframe, const Rig& rig) {
    places_[keyframe.id] = model_.images.size();
    model_.images.push_back({static_cast<std::uint32_t>(model_.images.size() + 1),
                             (keyframe.T_w_b * rig.T_b_c).inverse(),
                             colmapName(keyframe.t_ns),
                             {}});
  }

  void addPoint(const MapPoint& point) {
    ColmapPoint added;
    added.id = point.id + 1;
    added.p_w = point.p_w;
    for (const MapPointObservation& observation : point.observations) {
      const auto place = places_.find(observation.keyframe_id);
      if (place == places_.end()) continue;
      ColmapImage& image = model_.images[place->second];
      const Eigen::Vector3d p_c = image.T_c_w * point.p_w;
      if (!model_.camera.projects(p_c)) continue;
      added.error_px += (model_.camera.project(p_c) - observation.px).norm();
      added.track.emplace_back(image.id, static_cast<std::uint32_t>(image.points.size()));
      image.points.push_back({observation.px + Eigen::Vector2d::Constant(kPixelCentre_px), added.id});
    }
    if (added.track.empty()) return;
    added.error_px /= static_cast<double>(added.track.size());
    model_.points.push_back(std::move(added));
  }

  ColmapModel model_;
  std::unordered_map<std::uint64_t, std::size_t> places_;  ///< of keyframes among the images
};

/// A camera in COLMAP's words.
struct ColmapCamera {
  std::int32_t model;
  const char* name;
  std::vector<double> parameters;
};

ColmapCamera colmapCamera(const Camera& c) {
  const auto with = [&](std::size_t coefficients) {
    std::vector<double> parameters{c.fx, c.fy, c.cx + kPixelCentre_px, c.cy + kPixelCentre_px};
    parameters.insert(parameters.end(), c.lens.begin(), c.lens.begin() + static_cast<std::ptrdiff_t>(coefficients));
    return parameters;
  };
  if (c.model == LensModel::kRadialTangential && c.lens == decltype(c.lens){}) return {1, "PINHOLE", with(0)};
  if (c.model == LensModel::kEquidistant) return {5, "OPENCV_FISHEYE", with(4)};
  if (c.wide())
    throw std::runtime_error(std::string("COLMAP has no lens model ") + lensName(c.model).name +
                             ": undistorted (lintel-map --undistorted) it is a pinhole camera");
  if (c.model == LensModel::kRational || c.lens[4] != 0) return {6, "FULL_OPENCV", with(8)};
  return {4, "OPENCV", with(4)};
}

/// The scalar part first and not negative, as COLMAP writes it; no negative zeros.
std::vector<double> poseNumbers(const Pose& T) {
  const double sign = T.q.w() < 0 ? -1 : 1;
  std::vector<double> numbers{sign * T.q.w(), sign * T.q.x(), sign * T.q.y(), sign * T.q.z(),
                              T.p.x(),        T.p.y(),        T.p.z()};
  for (double& number : numbers) number += 0.0;
  return numbers;
}

OutputFile file(const std::string& folder, const std::string& name, std::string bytes) {
  return {(std::filesystem::path(folder) / name).string(), std::move(bytes)};
}

std::string camerasText(const ColmapModel& model) {
  Text text;
  const ColmapCamera camera = colmapCamera(model.camera);
  text << "# CAMERA_ID MODEL WIDTH HEIGHT fx fy cx cy and the lens' coefficients\n"
       << kCamera << ' ' << camera.name << ' ' << model.camera.width << ' ' << model.camera.height;
  for (const double value : camera.parameters) text << ' ' << value;
  text << '\n';
  return std::move(text.bytes());
}

std::string imagesText(const ColmapModel& model) {
  Text text;
  text << "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, and a line of X Y POINT3D_ID …\n";
  for (const ColmapImage& image : model.images) {
    text << image.id;
    for (const double value : poseNumbers(image.T_c_w)) text << ' ' << value;
    text << ' ' << kCamera << ' ' << image.name << '\n';
    const char* space = "";
    for (const ColmapPoint2& point : image.points) {
      text << space << point.px.x() << ' ' << point.px.y() << ' ' << point.point;
      space = " ";
    }
    text << '\n';
  }
  return std::move(text.bytes());
}

std::string pointsText(const ColmapModel& model) {
  Text text;
  text << "# POINT3D_ID X Y Z R G B ERROR, and IMAGE_ID POINT2D_IDX …\n";
  for (const ColmapPoint& point : model.points) {
    text << point.id << ' ' << point.p_w.x() << ' ' << point.p_w.y() << ' ' << point.p_w.z() << " 128 128 128 "
         << point.error_px;
    for (const auto& [image, place] : point.track) text << ' ' << image << ' ' << place;
    text << '\n';
  }
  return std::move(text.bytes());
}

/// Little-endian values one after the other.
class Binary {
 public:
  template <class T>
  Binary& put(T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
    return *this;
  }
  Binary& put(const std::vector<double>& values) {
    for (const double value : values) put(value);
    return *this;
  }
  Binary& text(const std::string& value) {
    bytes_.append(value.c_str(), value.size() + 1);
    return *this;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

std::string camerasBinary(const ColmapModel& model) {
  const ColmapCamera camera = colmapCamera(model.camera);
  Binary out;
  out.put(std::uint64_t{1}).put(kCamera).put(camera.model);
  out.put(static_cast<std::uint64_t>(model.camera.width)).put(static_cast<std::uint64_t>(model.camera.height));
  return out.put(camera.parameters).take();
}

std::string imagesBinary(const ColmapModel& model) {
  Binary out;
  out.put(static_cast<std::uint64_t>(model.images.size()));
  for (const ColmapImage& image : model.images) {
    out.put(image.id).put(poseNumbers(image.T_c_w)).put(kCamera).text(image.name);
    out.put(static_cast<std::uint64_t>(image.points.size()));
    for (const ColmapPoint2& point : image.points) out.put(point.px.x()).put(point.px.y()).put(point.point);
  }
  return out.take();
}

std::string pointsBinary(const ColmapModel& model) {
  Binary out;
  out.put(static_cast<std::uint64_t>(model.points.size()));
  for (const ColmapPoint& point : model.points) {
    out.put(point.id).put(point.p_w.x()).put(point.p_w.y()).put(point.p_w.z());
    for (int channel = 0; channel < 3; ++channel) out.put(std::uint8_t{128});
    out.put(point.error_px).put(static_cast<std::uint64_t>(point.track.size()));
    for (const auto& [image, place] : point.track) out.put(image).put(place);
  }
  return out.take();
}

}  // namespace

OutputFiles colmapFiles(const Drawing& drawing, const std::string& path) {
  const ColmapModel model = ModelMaker(drawing).take();
  return {file(path, "cameras.bin", camerasBinary(model)), file(path, "images.bin", imagesBinary(model)),
          file(path, "points3D.bin", pointsBinary(model))};
}

OutputFiles colmapTextFiles(const Drawing& drawing, const std::string& path) {
  const ColmapModel model = ModelMaker(drawing).take();
  return {file(path, "cameras.txt", camerasText(model)), file(path, "images.txt", imagesText(model)),
          file(path, "points3D.txt", pointsText(model))};
}

}  // namespace lintel
