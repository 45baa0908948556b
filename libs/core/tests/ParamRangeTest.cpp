// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/ParamRange.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "lintel/core/FrameRate.h"

namespace lintel {
namespace {

struct Inner {
  double length_px = 10;
  std::string mode = "fast";
  template <class F>
  void fields(F&& field) {
    field("length_px", length_px, ReferencePixels{1, 1000});
    field("mode", mode, OneOf{"fast careful"});
  }
};

struct Outer {
  int count = 3;
  double noise_px = 0.5;
  bool on = true;
  Inner inner;
  template <class F>
  void fields(F&& field) {
    field("count", count, Range{1, 10});
    field("noise_px", noise_px, Range{0.1, 2});
    field("on", on);
    field("inner", inner);
  }
};

std::string complaintAbout(const Outer& params) {
  try {
    checkRanges(params, "outer.");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Camera cameraOf(double focal_px) {
  Camera camera;
  camera.fx = camera.fy = focal_px;
  return camera;
}

TEST(ParamRange, LimitsAreAllowed) {
  Outer params;
  EXPECT_EQ(complaintAbout(params), "");
  params.count = 10;
  params.inner.length_px = 1;
  EXPECT_EQ(complaintAbout(params), "");
}

TEST(ParamRange, NamesKeyValueAndLimits) {
  Outer params;
  params.count = 11;
  EXPECT_EQ(complaintAbout(params), "outer.count = 11, must be from 1 to 10");
  params = {};
  params.noise_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaintAbout(params), "outer.noise_px = nan, must be from 0.1 to 2");
  params = {};
  params.inner.length_px = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaintAbout(params), "outer.inner.length_px = inf, must be from 1 to 1000");
  params = {};
  params.inner.mode = "fas";
  EXPECT_EQ(complaintAbout(params), "outer.inner.mode = fas, must be one of fast, careful");
}

TEST(ParamRange, AnglesFollowTheFocalLengthAndThePixelGridDoesNot) {
  const Outer scaled = scaledTo(cameraOf(1374), Outer{});
  EXPECT_EQ(scaled.inner.length_px, 30);
  EXPECT_EQ(scaled.noise_px, 0.5);
  EXPECT_EQ(scaled.count, 3);
}

TEST(ParamRange, CamerasLikeEurocsAreTheReference) {
  for (const double focal_px : {435.0, 457.975, 460.0, 500.0}) EXPECT_EQ(pixelScale(cameraOf(focal_px)), 1) << focal_px;
  EXPECT_EQ(pixelScale(cameraOf(229)), 0.5);
  EXPECT_EQ(pixelScale(cameraOf(1500)), 3.25);
  EXPECT_EQ(pixelScale(cameraOf(20)), 0.25);
}

TEST(FrameRate, TimesStayWhenImagesComeFaster) {
  EXPECT_EQ(framesAtRate(2, 20), 2);
  EXPECT_EQ(framesAtRate(2, 19.6), 2);
  EXPECT_EQ(framesAtRate(2, 30), 3);
  EXPECT_EQ(framesAtRate(2, 60), 6);
  EXPECT_EQ(framesAtRate(2, 10), 1);
  EXPECT_EQ(framesAtRate(2, 5), 1);
  EXPECT_EQ(framesAtRate(0, 60), 0);
}

}  // namespace
}  // namespace lintel
