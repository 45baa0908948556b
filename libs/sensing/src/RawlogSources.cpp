// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogSources.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "ImageFile.h"
#include "RawlogTime.h"
#include "SensorStream.h"
#include "lintel/geometry/LensNames.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation;

mrpt::poses::CPose3D toMrpt(const Pose& pose) {
  const mrpt::math::CQuaternionDouble q(pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z());
  return {q, pose.p.x(), pose.p.y(), pose.p.z()};
}

mrpt::img::TCamera toMrpt(const Camera& camera, const std::string& name) {
  mrpt::img::TCamera params;
  params.ncols = static_cast<std::uint32_t>(camera.width);
  params.nrows = static_cast<std::uint32_t>(camera.height);
  params.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
  const auto& k = camera.lens;
  if (camera.model >= LensModel::kDoubleSphere)
    throw RecordingError(std::string("camera '") + name + "': a rawlog has no place for the lens model " +
                         lensName(camera.model).name + ": give the folder itself, or calibrate with equidistant");
  if (camera.model == LensModel::kEquidistant) {
    params.setDistortionKannalaBrandt(k[0], k[1], k[2], k[3]);
  } else {
    params.distortion = mrpt::img::DistortionModel::plumb_bob;
    params.dist = k;  // both in the order of OpenCV
  }
  params.cameraName = name;
  return params;
}

template <class Observation>
std::shared_ptr<Observation> stamped(const std::string& label, std::int64_t t_ns) {
  auto observation = Observation::Create();
  observation->sensorLabel = label;
  observation->timestamp = toRawlogTime(t_ns);
  return observation;
}

void fill(mrpt::img::CImage& image, const GrayImage& gray) {
  image.resize(static_cast<std::size_t>(gray.width), static_cast<std::size_t>(gray.height), mrpt::img::CH_GRAY);
  for (int row = 0; row < gray.height; ++row)
    std::copy_n(gray.pixels.data() + static_cast<std::ptrdiff_t>(row) * gray.width, gray.width,
                image.ptrLine<std::uint8_t>(static_cast<unsigned>(row)));
}

CObservation::Ptr observationOf(const ImuSample& sample, const std::string& label, const mrpt::poses::CPose3D& pose) {
  using namespace mrpt::obs;
  auto observation = stamped<CObservationIMU>(label, sample.t_ns);
  observation->sensorPose = pose;
  observation->set(IMU_WX, sample.gyro.x());
  observation->set(IMU_WY, sample.gyro.y());
  observation->set(IMU_WZ, sample.gyro.z());
  observation->set(IMU_X_ACC, sample.accel.x());
  observation->set(IMU_Y_ACC, sample.accel.y());
  observation->set(IMU_Z_ACC, sample.accel.z());
  return observation;
}

class ImageSource final : public RawlogSource {
 public:
  ImageSource(const std::string& folder, std::string label, const EurocCamera& camera, ImagePlacer* placer)
      : list_(folder),
        label_(std::move(label)),
        params_(toMrpt(camera.model, label_)),
        pose_(toMrpt(camera.T_v_c)),
        placer_(placer) {}

  bool advance(const WarningSink& warn) override {
    const auto next = list_.next(warn);
    if (next) entry_ = *next;
    return next.has_value();
  }

  std::int64_t t_ns() const override { return entry_.t_ns; }

  CObservation::Ptr make(const WarningSink& warn) override {
    auto observation = stamped<mrpt::obs::CObservationImage>(label_, entry_.t_ns);
    observation->cameraParams = params_;
    observation->cameraPose = pose_;
    try {
      if (placer_)
        link(observation->image);
      else
        embed(observation->image);
    } catch (const ImageFault& fault) {
      warn(Fault::Image, std::string(fault.what()) + ": left out");
      return nullptr;
    }
    return observation;
  }

 private:
  void link(mrpt::img::CImage& image) {
    std::error_code ignored;
    if (!fs::exists(entry_.path, ignored)) throw ImageFault(entry_.path + ": image file missing");
    const std::string name = label_ + "_" + fs::path(entry_.path).filename().string();
    placer_->place(entry_.path, name);
    image.setExternalStorage(name);
  }

  void embed(mrpt::img::CImage& image) const { fill(image, readGrayImage(entry_.path)); }

  EurocImageList list_;
  std::string label_;
  mrpt::img::TCamera params_;
  mrpt::poses::CPose3D pose_;
  ImagePlacer* placer_;
  ImageEntry entry_;
};

class ImuSource final : public RawlogSource {
 public:
  ImuSource(const std::string& folder, std::string label, const EurocImu& imu)
      : list_(folder), label_(std::move(label)), pose_(toMrpt(imu.T_v_b)) {}

  bool advance(const WarningSink& warn) override {
    const auto next = list_.next(warn);
    if (next) sample_ = *next;
    return next.has_value();
  }

  std::int64_t t_ns() const override { return sample_.t_ns; }

  CObservation::Ptr make(const WarningSink&) override { return observationOf(sample_, label_, pose_); }

 private:
  EurocImuList list_;
  std::string label_;
  mrpt::poses::CPose3D pose_;
  ImuSample sample_;
};

class StreamImageSource final : public RawlogSource {
 public:
  StreamImageSource(std::shared_ptr<SensorStream> stream, std::string label, std::string folder)
      : stream_(std::move(stream)),
        label_(std::move(label)),
        folder_(std::move(folder)),
        params_(toMrpt(stream_->rig().camera, label_)),
        pose_(toMrpt(stream_->rig().T_b_c)) {}

  bool advance(const WarningSink& warn) override {
    auto next = stream_->nextFrame(warn);
    if (next) frame_ = std::move(*next);
    return next.has_value();
  }

  std::int64_t t_ns() const override { return frame_.t_ns; }

  CObservation::Ptr make(const WarningSink& warn) override {
    auto observation = stamped<mrpt::obs::CObservationImage>(label_, frame_.t_ns);
    observation->cameraParams = params_;
    observation->cameraPose = pose_;
    try {
      fill(observation->image, frame_.decode());
    } catch (const ImageFault& fault) {
      warn(Fault::Image, std::string(fault.what()) + ": left out");
      return nullptr;
    }
    if (!folder_.empty()) store(observation->image);
    return observation;
  }

 private:
  void store(mrpt::img::CImage& image) const {
    const std::string name = label_ + "_" + std::to_string(frame_.t_ns) + ".png";
    if (!image.saveToFile((fs::path(folder_) / name).string()))
      throw std::runtime_error(folder_ + "/" + name + ": cannot be written: is the disk full?");
    image = mrpt::img::CImage();
    image.setExternalStorage(name);
  }

  std::shared_ptr<SensorStream> stream_;
  std::string label_, folder_;
  mrpt::img::TCamera params_;
  mrpt::poses::CPose3D pose_;
  FrameRef frame_;
};

class StreamImuSource final : public RawlogSource {
 public:
  explicit StreamImuSource(std::shared_ptr<SensorStream> stream) : stream_(std::move(stream)) {}

  bool advance(const WarningSink& warn) override {
    const auto next = stream_->nextImu(std::numeric_limits<std::int64_t>::max() / 2, warn);
    if (next) sample_ = *next;
    return next.has_value();
  }

  std::int64_t t_ns() const override { return sample_.t_ns; }
  CObservation::Ptr make(const WarningSink&) override { return observationOf(sample_, "imu0", {}); }

 private:
  std::shared_ptr<SensorStream> stream_;
  ImuSample sample_;
};

class GroundtruthSource final : public RawlogSource {
 public:
  explicit GroundtruthSource(const std::string& csv) : csv_(csv, 8) {}

  bool advance(const WarningSink& warn) override {
    while (csv_.next(warn)) {
      double v[7];
      if (!csv_.numbers(1, 7, v, warn)) continue;
      const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
      pose_ = {q.normalized(), {v[0], v[1], v[2]}};
      t_ns_ = cutToTick(csv_.time_ns());
      const auto where = [this] { return csv_.where(); };
      if (pose_.p.allFinite() && q.coeffs().allFinite() && q.norm() > 0.5) {
        if (gate_.admit(t_ns_, where, warn)) return true;
      } else {
        warn(Fault::Other, where() + ": true pose is not finite: left out");
      }
    }
    return false;
  }

  std::int64_t t_ns() const override { return t_ns_; }

  CObservation::Ptr make(const WarningSink&) override {
    auto observation = stamped<mrpt::obs::CObservationRobotPose>("groundtruth", t_ns_);
    observation->pose.mean = toMrpt(pose_);
    return observation;
  }

 private:
  EurocTable csv_;
  StampGate gate_{"true pose", Fault::Other};
  Pose pose_;
  std::int64_t t_ns_ = 0;
};

}  // namespace

std::unique_ptr<RawlogSource> makeImageSource(const std::string& folder, const std::string& label,
                                              const EurocCamera& camera, ImagePlacer* placer) {
  return std::make_unique<ImageSource>(folder, label, camera, placer);
}

std::unique_ptr<RawlogSource> makeImuSource(const std::string& folder, const std::string& label, const EurocImu& imu) {
  return std::make_unique<ImuSource>(folder, label, imu);
}

std::unique_ptr<RawlogSource> makeImageSource(const std::shared_ptr<SensorStream>& stream, const std::string& label,
                                              const std::string& folder) {
  return std::make_unique<StreamImageSource>(stream, label, folder);
}

std::unique_ptr<RawlogSource> makeImuSource(const std::shared_ptr<SensorStream>& stream) {
  return std::make_unique<StreamImuSource>(stream);
}

std::unique_ptr<RawlogSource> makeGroundtruthSource(const std::string& csv) {
  return std::make_unique<GroundtruthSource>(csv);
}

std::shared_ptr<CObservation> makeComment(const std::string& text, std::int64_t t_ns) {
  // Without this MRPT would set the present time, and the recording would last years.
  auto comment = stamped<mrpt::obs::CObservationComment>("", t_ns);
  comment->text = text;
  return comment;
}

}  // namespace lintel
