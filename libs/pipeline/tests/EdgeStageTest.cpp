// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeStage.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

constexpr std::int64_t kStep_ns = 50'000'000;

class EdgeStageTest : public testing::Test {
 protected:
  EdgeStageTest() {
    rig_.camera = {100, 80, 80, 80, 50, 40, 0, 0, 0, 0};
    auto image = std::make_shared<GrayImage>();
    *image = {100, 80, std::vector<std::uint8_t>(8000, 40)};
    for (std::size_t i = 4000; i < 8000; ++i) image->pixels[i] = 160;  // one edge across
    image_ = image;
  }

  void add(EdgeStage& stage, int frame, EstimatorStatus status, bool keyframe = false) {
    WindowUpdate update;
    update.t_ns = frame * kStep_ns;
    update.status = status;
    update.keyframe = keyframe;
    stage.add({update.t_ns, image_}, update, clock_);
  }

  static std::vector<std::int64_t> times(const EdgeStage& stage) {
    std::vector<std::int64_t> times;
    for (const auto& [t_ns, edges] : stage.edges()) {
      times.push_back(t_ns / kStep_ns);
      EXPECT_EQ(edges.size(), 1U);
    }
    return times;
  }

  Rig rig_;
  DensifyParams params_;
  std::shared_ptr<const GrayImage> image_;
  StageClock clock_;
};

TEST_F(EdgeStageTest, OnlyKeyframesAreSearchedOnceTheNextFrameSaysSo) {
  params_.interval_s = 0;
  EdgeStage stage(rig_, params_);
  add(stage, 0, EstimatorStatus::kTracking);
  add(stage, 1, EstimatorStatus::kPropagated);
  add(stage, 2, EstimatorStatus::kTracking, false);  // frame 0 was none
  add(stage, 4, EstimatorStatus::kTracking, true);   // frame 2 was one
  add(stage, 6, EstimatorStatus::kTracking, true);
  EXPECT_EQ(times(stage), (std::vector<std::int64_t>{2, 4}));
  EXPECT_EQ(clock_.ms().size(), 2U);
}

TEST_F(EdgeStageTest, TheFramesOfAStartAreKeyframes) {
  params_.interval_s = 0;
  EdgeStage stage(rig_, params_);
  for (int i = 0; i < 5; ++i) add(stage, i, EstimatorStatus::kInitializing);
  add(stage, 5, EstimatorStatus::kTracking);
  EXPECT_EQ(times(stage), (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
}

TEST_F(EdgeStageTest, WhatComesSoonAfterAnotherIsLeftOut) {
  params_.interval_s = 0.2;
  EdgeStage stage(rig_, params_);
  for (int i = 0; i < 14; ++i) add(stage, i, EstimatorStatus::kTracking, true);
  EXPECT_EQ(times(stage), (std::vector<std::int64_t>{0, 4, 8, 12}));
}

}  // namespace
}  // namespace lintel
