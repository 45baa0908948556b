// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/MapDensification.h"

#include <gtest/gtest.h>

#include "MadeRecording.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {
namespace {

class GreyRecording : public test::MadeRecording {
 public:
  using MadeRecording::MadeRecording;

 private:
  std::shared_ptr<const GrayImage> imageAt(double /*t_s*/) const override {
    return std::make_shared<GrayImage>(GrayImage{200, 150, std::vector<std::uint8_t>(200 * 150, 128)});
  }
  Eigen::Vector3d gyroAt(double /*t_s*/) const override { return Eigen::Vector3d::Zero(); }
};

TEST(MapDensification, GivenPosesAreThoseOfTheImagesWhateverTheMapSaysOfTheClocks) {
  Rig rig;
  rig.camera = {200, 150, 160, 160, 99.5, 74.5, 0, 0, 0, 0};
  LineMap map;
  map.rig = rig;
  map.time_offset_s = 0.01;
  MapDensificationOptions options;
  for (int i = 0; i < 4; ++i) {
    MapKeyframe keyframe;
    keyframe.id = static_cast<std::uint64_t>(i), keyframe.t_ns = i * test::MadeRecording::kStep_ns;
    keyframe.v_w_b = {1, 0, 0}, keyframe.offset_change_s = 0.002 * i;
    map.keyframes.push_back(keyframe);
    options.poses.emplace_back(keyframe.t_ns, Pose{Eigen::Quaterniond::Identity(), {0.1 * i, 0, 0}});
  }
  GreyRecording recording(rig, 4, "");
  const LineMap found = densifyMap(map, recording, options).map;
  ASSERT_EQ(found.trajectory.size(), 4u);
  const KeyframeCameras cameras(found);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((found.trajectory[i].second.p - options.poses[i].second.p).norm(), 1e-12) << i;
    EXPECT_LT((cameras.T_w_c(found.keyframes[i].id).p - options.poses[i].second.p).norm(), 1e-12) << i;
  }
}

}  // namespace
}  // namespace lintel
