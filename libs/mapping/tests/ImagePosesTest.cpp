// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/ImagePoses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// A body on a circle of 2 m, a turn in 6.3 s, looking ahead, frames every 40 to 60 ms.
class ImagePosesTest : public testing::Test {
 protected:
  static Pose at(double t_s) { return {expRotation({0, 0, t_s}), {2 * std::cos(t_s), 2 * std::sin(t_s), 0.1 * t_s}}; }
  static double secondsOf(std::int64_t t_ns) { return 1e-9 * static_cast<double>(t_ns); }

  ImagePosesTest() {
    std::int64_t t_ns = 0;
    for (int i = 0; i < 20; ++i, t_ns += (i % 2 ? 40 : 60) * kMillisecond)
      material_.trajectory.emplace_back(t_ns, at(secondsOf(t_ns)));
    for (const std::size_t i : {0u, 10u, 19u}) {
      RetiredKeyframe keyframe;
      keyframe.id = i, keyframe.t_ns = material_.trajectory[i].first;
      material_.keyframes.push_back(keyframe);
    }
  }

  /// The largest difference from where the body was `offset(i)` after the stamps of the frames `from` to `to`.
  template <class Offset>
  double error(const std::vector<std::pair<std::int64_t, Pose>>& poses, std::size_t from, std::size_t to,
               const Offset& offset) const {
    double largest = 0;
    for (std::size_t i = from; i <= to; ++i) {
      const Pose truth = at(secondsOf(poses[i].first) + offset(i));
      largest = std::max(
          {largest, (poses[i].second.p - truth.p).norm(), logRotation(poses[i].second.q.conjugate() * truth.q).norm()});
    }
    return largest;
  }

  MapMaterial material_;
};

TEST_F(ImagePosesTest, AnImageShowsWhereTheBodyWasAnOffsetAfterItsStamp) {
  for (const double offset_s : {-0.008, 0.008}) {
    material_.time_offset_s = offset_s;
    const auto poses = posesOfImages(material_);
    ASSERT_EQ(poses.size(), material_.trajectory.size());
    EXPECT_EQ(poses[7].first, material_.trajectory[7].first) << "the stamps stay";
    EXPECT_LT(error(poses, 1, 18, [&](std::size_t) { return offset_s; }), 2e-4) << "of 16 mm and 8 mrad";
    EXPECT_LT(error(poses, 0, 19, [&](std::size_t) { return offset_s; }), 1e-3) << "ends have one neighbour";
  }
}

TEST_F(ImagePosesTest, WithoutAnOffsetNothingMoves) {
  EXPECT_LT(error(posesOfImages(material_), 0, 19, [](std::size_t) { return 0.0; }), 1e-12);
}

TEST_F(ImagePosesTest, TheOffsetChangesEvenlyBetweenKeyframes) {
  material_.time_offset_s = 0.002;
  material_.keyframes[1].offset_change_s = material_.keyframes[2].offset_change_s = 0.008;
  const double until_s = secondsOf(material_.keyframes[1].t_ns);
  const auto offset = [&](std::size_t i) {
    return 0.002 + 0.008 * std::min(1.0, secondsOf(material_.trajectory[i].first) / until_s);
  };
  EXPECT_LT(error(posesOfImages(material_), 1, 18, offset), 2e-4);
}

TEST_F(ImagePosesTest, NoMotionIsTakenFromAnotherPieceOrAcrossAGap) {
  material_.time_offset_s = 0.01;
  for (std::size_t i = 10; i < 20; ++i) material_.trajectory[i].second.p.x() += 100;
  material_.pieces = {{0, 0, material_.trajectory[9].first, 0, 0, 0},
                      {10, material_.trajectory[10].first, material_.trajectory[19].first, 10, 1, 0}};
  const auto pieces = posesOfImages(material_);
  EXPECT_LT((pieces[9].second.p - at(secondsOf(pieces[9].first) + 0.01).p).norm(), 1e-3);
  material_.pieces.clear();
  for (std::size_t i = 10; i < 20; ++i) material_.trajectory[i].first += 1000 * kMillisecond;
  const auto gap = posesOfImages(material_);
  EXPECT_LT((gap[9].second.p - pieces[9].second.p).norm(), 1e-12);
  EXPECT_LT((gap[10].second.p - pieces[10].second.p).norm(), 1e-12);
}

TEST_F(ImagePosesTest, StatesComeBackFromThePosesOfTheImages) {
  material_.time_offset_s = 0.008;
  EXPECT_LT(error(posesOfStates(material_, posesOfImages(material_)), 1, 18, [](std::size_t) { return 0.0; }), 2e-4)
      << "the acceleration's part, twice";
}

TEST_F(ImagePosesTest, AgreeWithTheCamerasOfTheKeyframes) {
  material_.time_offset_s = 0.006;
  material_.rig.T_b_c = {expRotation({0.1, 1.2, -0.4}), {0.2, -0.1, 0.3}};
  for (RetiredKeyframe& keyframe : material_.keyframes) {
    keyframe.T_w_b = at(secondsOf(keyframe.t_ns));
    keyframe.v_w_b = keyframe.T_w_b.q * Eigen::Vector3d(0, 2, 0.1);
    auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    ImuBatch samples;
    for (int i = -4; i <= 0; ++i) samples.push_back({keyframe.t_ns + 5 * i * kMillisecond, {0, 0, 1}, {-2, 0, 9.81}});
    imu->append(samples);
    keyframe.imu = imu;
  }
  const KeyframeCameras cameras(material_);
  const Pose by_camera = cameras.T_w_c(10) * material_.rig.T_b_c.inverse(), pose = posesOfImages(material_)[10].second;
  EXPECT_LT((by_camera.p - pose.p).norm(), 2e-4);
  EXPECT_LT(logRotation(by_camera.q.conjugate() * pose.q).norm(), 1e-6);
}

}  // namespace
}  // namespace lintel
