// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lintel/sensing/Recording.h"

namespace lintel::test {

/// A recording that is computed while it is read: images every 50 ms, IMU samples every 5 ms, gravity along +z of the
/// IMU. After `frames` it ends or, with a complaint, breaks off.
class MadeRecording : public Recording {
 public:
  static constexpr std::int64_t kStep_ns = 50'000'000;

  MadeRecording(Rig rig, int frames, std::string complaint)
      : rig_(std::move(rig)), frames_(frames), complaint_(std::move(complaint)) {}

  const Rig& rig() const override { return rig_; }
  std::size_t expectedFrames() const override { return static_cast<std::size_t>(frames_); }
  std::vector<std::string> warnings() const override { return {}; }

  std::optional<FrameWithImu> next() override {
    if (delivered_ == frames_) {
      if (!complaint_.empty()) throw RecordingError(complaint_);
      return std::nullopt;
    }
    FrameWithImu step;
    const std::int64_t t_ns = delivered_ * kStep_ns;
    step.frame = {t_ns, imageAt(1e-9 * static_cast<double>(t_ns))};
    for (int i = delivered_ == 0 ? -100 : 0; i <= 10; ++i) {
      const std::int64_t at_ns = t_ns - kStep_ns + i * kStep_ns / 10;
      step.imu.push_back({at_ns, gyroAt(1e-9 * static_cast<double>(at_ns)), {0, 0, 9.81}});
    }
    ++delivered_;
    return step;
  }

 private:
  virtual std::shared_ptr<const GrayImage> imageAt(double t_s) const = 0;
  virtual Eigen::Vector3d gyroAt(double t_s) const = 0;

  Rig rig_;
  int frames_, delivered_ = 0;
  std::string complaint_;
};

}  // namespace lintel::test
