// SPDX-License-Identifier: BSD-3-Clause
#include "ImageRemarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lintel {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::Not;

TEST(ImagesRemark, CountsWhatWasLeftOut) {
  FrontEndStatistics tracking;
  EXPECT_THAT(imagesRemark(tracking), IsEmpty());
  tracking.images_repeated = 30;
  EXPECT_THAT(imagesRemark(tracking), AllOf(HasSubstr("30 images are the one before"), HasSubstr("left out")));
  tracking.images_without_contrast = 2;
  EXPECT_THAT(imagesRemark(tracking), AllOf(HasSubstr("30 images"), HasSubstr("2 images show nothing")));
}

TEST(VehicleRemark, SaysHowMuchOfTheImageAndWhereItIs) {
  EXPECT_THAT(vehicleRemark(0), IsEmpty());
  EXPECT_THAT(vehicleRemark(0.174), AllOf(HasSubstr("17 % of the image move with the camera"), HasSubstr("mask.pgm")));
  EXPECT_THAT(vehicleRemark(0.174), Not(HasSubstr("projector")));
  EXPECT_THAT(vehicleRemark(0.83), HasSubstr("projector"));
}

TEST(ImageFault, IsWhatATenthOfTheImagesShow) {
  FrontEndStatistics tracking;
  EXPECT_THAT(imageFault(tracking), IsEmpty());
  tracking.frames = 100;
  tracking.images_without_contrast = tracking.images_repeated = 5;
  EXPECT_THAT(imageFault(tracking), IsEmpty()) << "a lost image is no fault";
  tracking.images_repeated = 50;
  EXPECT_THAT(imageFault(tracking), HasSubstr("50 % of the images repeat the one before"));
  tracking.images_without_contrast = 25;
  EXPECT_THAT(imageFault(tracking), HasSubstr("25 % of the images show nothing"));
}

TEST(TextureFault, IsThatMostPointsAreLostInTheNextImage) {
  PointStatistics points;
  EXPECT_THAT(textureFault(points), IsEmpty());
  points.detected = 1000;
  points.tracked = 1000;  // an image each, as with much noise
  EXPECT_THAT(textureFault(points), IsEmpty());
  points.tracked = 400;
  EXPECT_THAT(textureFault(points), HasSubstr("surfaces without texture"));
}

}  // namespace
}  // namespace lintel
