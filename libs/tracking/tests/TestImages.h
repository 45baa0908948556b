// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel::testing {

/// EuRoC-like lens on a smaller image.
inline Rig testRig() {
  Rig rig;
  rig.camera.width = 480;
  rig.camera.height = 320;
  rig.camera.fx = rig.camera.fy = 300;
  rig.camera.cx = 240;
  rig.camera.cy = 160;
  rig.camera.lens[0] = -0.28;
  rig.camera.lens[1] = 0.07;
  rig.T_b_c.q = Eigen::Quaterniond(0, std::sqrt(0.5), std::sqrt(0.5), 0);  // axes swapped: a mix-up shows
  return rig;
}

/// Grey value (0 to 255) of a scene at normalised coordinates.
using Scene = std::function<double(const Eigen::Vector2d&)>;

/// Where the 2x2 samples of each pixel look, normalised: pixels row by row.
inline std::vector<Eigen::Vector2d> samplePlaces(const Camera& camera) {
  std::vector<Eigen::Vector2d> places;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      for (const double dy : {-0.25, 0.25})
        for (const double dx : {-0.25, 0.25}) places.push_back(camera.normalise({x + dx, y + dy}));
  return places;
}

inline bool isOfTestRig(const Camera& camera) {
  const Camera usual = testRig().camera;
  return camera.width == usual.width && camera.height == usual.height && camera.fx == usual.fx &&
         camera.fy == usual.fy && camera.cx == usual.cx && camera.cy == usual.cy && camera.lens == usual.lens &&
         camera.model == usual.model;
}

/// What the camera sees of a scene at infinity after turning by R_c_w: 2x2 samples a pixel.
inline Frame renderScene(const Rig& rig, const Scene& scene, std::int64_t t_ns,
                         const Eigen::Quaterniond& R_c_w = Eigen::Quaterniond::Identity()) {
  static const std::vector<Eigen::Vector2d> usual_places = samplePlaces(testRig().camera);  // half of the time if anew
  const std::vector<Eigen::Vector2d> own_places =
      isOfTestRig(rig.camera) ? std::vector<Eigen::Vector2d>{} : samplePlaces(rig.camera);
  const Eigen::Vector2d* place = own_places.empty() ? usual_places.data() : own_places.data();
  auto image = std::make_shared<GrayImage>();
  image->width = rig.camera.width;
  image->height = rig.camera.height;
  const Eigen::Matrix3d R_w_c = R_c_w.conjugate().toRotationMatrix();
  for (int pixel = 0; pixel < image->width * image->height; ++pixel) {
    double sum = 0;
    for (int sample = 0; sample < 4; ++sample) {
      const Eigen::Vector3d ray = R_w_c * (place++)->homogeneous();
      sum += scene(ray.head<2>() / ray.z());
    }
    image->pixels.push_back(static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, sum / 4)))));
  }
  return {t_ns, image};
}

/// A plane that faces the first camera, `depth` away; grey values at normalised coordinates of its own, empty where one
/// sees through it.
struct Layer {
  double depth;
  std::function<std::optional<double>(const Eigen::Vector2d&)> grey;
};

/// What a camera sees of layers, nearer ones first, from `p_w` without turning: 2x2 samples a pixel.
inline Frame renderLayers(const Rig& rig, const std::vector<Layer>& layers, std::int64_t t_ns,
                          const Eigen::Vector3d& p_w) {
  const Scene scene = [&](const Eigen::Vector2d& x) {
    for (const Layer& layer : layers) {
      const Eigen::Vector2d at = (x * (layer.depth - p_w.z()) + p_w.head<2>()) / layer.depth;
      if (const auto grey = layer.grey(at)) return *grey;
    }
    return 0.0;
  };
  return renderScene(rig, scene, t_ns);
}

/// Smooth random blobs: corners everywhere, the same for the same seed.
inline Scene blobs(unsigned seed) {
  return [seed](const Eigen::Vector2d& x) {
    const auto hash = [&](int i, int j) {
      std::uint32_t h =
          static_cast<std::uint32_t>(i) * 73856093u ^ static_cast<std::uint32_t>(j) * 19349663u ^ seed * 83492791u;
      h ^= h >> 13;
      h *= 0x5bd1e995u;
      h ^= h >> 15;
      return (h & 0xffff) / 65535.0;
    };
    const double u = x.x() * 25, v = x.y() * 25;
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const auto ease = [](double s) { return s * s * (3 - 2 * s); };
    const double a = ease(u - i), b = ease(v - j);
    return 30 + 200 * ((1 - a) * (1 - b) * hash(i, j) + a * (1 - b) * hash(i + 1, j) + (1 - a) * b * hash(i, j + 1) +
                       a * b * hash(i + 1, j + 1));
  };
}

/// A bright strip on a dark ground, between two points (normalised), `half_width` wide to each side.
struct Strip {
  Eigen::Vector2d start, end;
  double half_width;
};

/// Strips of grey `bright` on `dark`; `hidden` marks places that show the ground.
inline Scene strips(std::vector<Strip> list, std::function<bool(const Eigen::Vector2d&)> hidden = {}, double dark = 60,
                    double bright = 180) {
  return [=](const Eigen::Vector2d& x) {
    if (hidden && hidden(x)) return dark;
    for (const Strip& strip : list) {
      const Eigen::Vector2d d = (strip.end - strip.start).normalized();
      const double along = d.dot(x - strip.start),
                   across = std::abs(d.x() * (x - strip.start).y() - d.y() * (x - strip.start).x());
      if (along > 0 && along < (strip.end - strip.start).norm() && across < strip.half_width) return bright;
    }
    return dark;
  };
}

/// Gyro samples of a constant rate (body frame) from t0 to t1, both included.
inline ImuBatch constantRate(std::int64_t t0_ns, std::int64_t t1_ns, const Eigen::Vector3d& rate_b) {
  ImuBatch batch;
  for (int i = 0; i <= 10; ++i) {
    ImuSample sample;
    sample.t_ns = t0_ns + (t1_ns - t0_ns) * i / 10;
    sample.gyro = rate_b;
    batch.push_back(sample);
  }
  return batch;
}

constexpr std::int64_t kStep_ns = 50'000'000;  ///< between frames

/// Turns the camera at a constant rate (camera frame) before a scene and tracks it.
inline std::vector<FrameTracks> trackTurning(const std::vector<Scene>& scenes, const FrontEndParams& params,
                                             const Eigen::Vector3d& rate_c, const Eigen::Vector3d& bias_b = {0, 0, 0}) {
  const Rig rig = testRig();
  FrontEnd front_end(rig, params);
  std::vector<FrameTracks> result;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto t_ns = static_cast<std::int64_t>(i) * kStep_ns;
    const Eigen::Quaterniond R_w_c = expRotation(rate_c * 0.05 * static_cast<double>(i));
    const Frame frame = renderScene(rig, scenes[i], t_ns, R_w_c.conjugate());
    result.push_back(front_end.process(frame, constantRate(t_ns - kStep_ns, t_ns, rig.T_b_c.q * rate_c + bias_b)));
  }
  return result;
}

}  // namespace lintel::testing
