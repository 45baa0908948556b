// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/CameraSensor.h"

#include <algorithm>
#include <cmath>

#include "lintel/simulation/Random.h"

namespace lintel {

namespace {

constexpr int kGaussians = 1 << 16;  // drawn once: a picture takes a quarter of a million
constexpr int kMostExposures = 12;
constexpr double kExposureStep_px = 1.5;  // of motion from one to the next: less than two pixels leave no steps

/// Grey level of a radiance: linear in the dark, saturating softly as an automatic exposure would leave it.
float greyOf(float radiance) { return 255.0f * (1.0f - std::exp(-2.8f * radiance)); }

}  // namespace

CameraSensor::CameraSensor(const ImageRenderer& renderer, const Camera& camera, const Pose& T_b_c,
                           const CameraSensorParams& params)
    : renderer_(renderer), camera_(camera), T_b_c_(T_b_c), params_(params) {
  RandomStream random(params.seed, 0x6e6f697365);
  gaussians_.resize(kGaussians);
  for (float& g : gaussians_) g = static_cast<float>(random.gaussian());
  const double corner2 = 0.25 * (camera.width * camera.width + camera.height * camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double r2 = (std::pow(x - 0.5 * camera.width, 2) + std::pow(y - 0.5 * camera.height, 2)) / corner2;
      vignette_.push_back(static_cast<float>(1 - params.vignetting * r2));
    }
  }
}

double CameraSensor::gain(double t_s) const {
  if (params_.exposure_change == 0) return 1;
  RandomStream random(params_.seed, 0x6761696e);  // the same phases at every call
  double sum = 0;
  for (const double frequency_hz : {0.07, 0.16, 0.31, 0.55}) {
    sum += std::sin(6.283185307 * (frequency_hz * t_s + random.uniform())) / std::sqrt(2.0);  // variance 4 * 1/4
  }
  return std::exp(params_.exposure_change * sum);
}

Radiance CameraSensor::expose(const Trajectory& trajectory, double t_s) const {
  const auto poseAt = [&](double t) { return trajectory.at(t).T_w_b * T_b_c_; };
  const auto renderAt = [&](double t, const EdgeSampling& edges) {
    if (params_.line_delay_s == 0) return renderer_.render(poseAt(t), edges);
    return renderer_.render(
        [&](int row) { return poseAt(t + (row - 0.5 * (camera_.height - 1)) * params_.line_delay_s); }, edges);
  };
  if (params_.exposure_time_s <= 0) return renderAt(t_s, {});
  // the motion in steps, judged by rotation and by translation at 2 m
  const KinematicState state = trajectory.at(t_s);
  const double motion_px =
      (state.omega_b.norm() + 0.5 * state.v_w_b.norm()) * params_.exposure_time_s * camera_.meanFocal();
  const int count = std::clamp(static_cast<int>(std::ceil(motion_px / kExposureStep_px)), 1, kMostExposures);
  Radiance sum;
  for (int i = 0; i < count; ++i) {
    // two exposures share the rays of one: their grids complement each other
    const EdgeSampling edges = count == 1 ? EdgeSampling{} : i % 2 == 0 ? EdgeSampling{4, 2} : EdgeSampling{2, 4};
    const Radiance part = renderAt(t_s + params_.exposure_time_s * ((i + 0.5) / count - 0.5), edges);
    if (sum.empty()) sum.assign(part.size(), 0.0f);
    for (std::size_t k = 0; k < part.size(); ++k) sum[k] += part[k] / static_cast<float>(count);
  }
  return sum;
}

GrayImage CameraSensor::take(const Trajectory& trajectory, double t_s) const {
  const Radiance radiance = expose(trajectory, t_s);
  const float gain_now = static_cast<float>(gain(t_s)), noise = static_cast<float>(params_.noise);
  const std::uint64_t name = mixBits(params_.seed) ^ static_cast<std::uint64_t>(std::llround(t_s * 1e6));
  GrayImage image{camera_.width, camera_.height, {}};
  image.pixels.reserve(radiance.size());
  const auto width = static_cast<std::size_t>(camera_.width);
  std::size_t place = 0;
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    if (i % width == 0) place = mixBits(name + i);  // every row starts somewhere else in the table
    float grey = greyOf(gain_now * vignette_[i] * radiance[i]);
    if (noise > 0) grey += noise * std::sqrt(1.0f + 0.01f * grey) * gaussians_[place++ % kGaussians];
    image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(grey + 0.5f, 0.0f, 255.0f)));
  }
  return image;
}

}  // namespace lintel
