// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/places/PlaceDescriber.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "SyntheticPlaces.h"

namespace lintel {
namespace {

using namespace test;

/// Rectangles of random grey, softened.
cv::Mat clutter() {
  cv::Mat image(480, 752, CV_8UC1, cv::Scalar(90));
  std::mt19937 random(11);
  for (int i = 0; i < 300; ++i) {
    const cv::Rect where(static_cast<int>(random() % 720), static_cast<int>(random() % 450),
                         8 + static_cast<int>(random() % 50), 8 + static_cast<int>(random() % 50));
    cv::rectangle(image, where, cv::Scalar(static_cast<double>(random() % 256)), cv::FILLED);
  }
  cv::GaussianBlur(image, image, {5, 5}, 1);
  return image;
}

Frame frameOf(const cv::Mat& image) {
  auto grey = std::make_shared<GrayImage>();
  grey->width = image.cols;
  grey->height = image.rows;
  grey->pixels.assign(image.datastart, image.dataend);
  return {5, grey};
}

std::vector<PointObservation> tracksAt(const std::vector<Eigen::Vector2d>& places) {
  std::vector<PointObservation> tracks(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    tracks[i].id = 100 + i;
    tracks[i].px = places[i];
  }
  return tracks;
}

TEST(PlaceDescriber, TrackedPointsAreDescribedInThreeSizesAndCornersBesides) {
  const PlaceView view =
      PlaceDescriber(placeCamera()).describe(frameOf(clutter()), tracksAt({{200, 200}, {400.5, 300.2}}), {0, 1, 0});
  EXPECT_EQ(view.t_ns, 5);
  int corners = 0;
  std::map<std::int64_t, int> sizes;
  for (const PlaceFeature& feature : view.features)
    feature.track == PlaceFeature::kNoTrack ? ++corners : ++sizes[feature.track];
  EXPECT_EQ(sizes, (std::map<std::int64_t, int>{{100, 3}, {101, 3}}));
  EXPECT_GT(corners, 100);
  EXPECT_LE(corners, 240) << "five in each of 48 cells";
}

TEST(PlaceDescriber, ACameraThatRollsSeesTheSame) {
  Camera camera = placeCamera();
  camera.cx = 376, camera.cy = 240;
  const cv::Mat image = clutter();
  const double roll = 0.5;
  const cv::Mat turn = cv::getRotationMatrix2D({376, 240}, -roll * 180 / M_PI, 1);  // clockwise in the image
  cv::Mat turned;
  cv::warpAffine(image, turned, turn, image.size());
  std::vector<Eigen::Vector2d> places, moved;
  for (int i = 0; i < 20; ++i) {
    places.emplace_back(260 + 12 * i, 140 + 10 * i);
    const Eigen::Vector2d d = places.back() - Eigen::Vector2d(376, 240);
    moved.emplace_back(Eigen::Vector2d(376, 240) + Eigen::Rotation2Dd(roll) * d);
  }
  const PlaceDescriber describer(camera);
  const PlaceView upright = describer.describe(frameOf(image), tracksAt(places), {0, 1, 0});
  const PlaceView tilted = describer.describe(frameOf(turned), tracksAt(moved), {-std::sin(roll), std::cos(roll), 0});
  int alike = 0, compared = 0;
  for (const PlaceFeature& a : upright.features)
    for (const PlaceFeature& b : tilted.features) {
      if (a.track == PlaceFeature::kNoTrack || a.track != b.track || a.level != b.level) continue;
      ++compared;
      alike += hammingDistance(a.descriptor, b.descriptor) < 50;
    }
  EXPECT_EQ(compared, 60);
  EXPECT_GT(alike, 50);
}

TEST(PlaceDescriber, AnEvenImageAndTracksAtTheEdgeAreNoTrouble) {
  const cv::Mat black(480, 752, CV_8UC1, cv::Scalar(0));
  const PlaceView view =
      PlaceDescriber(placeCamera()).describe(frameOf(black), tracksAt({{0, 0}, {751, 479}}), {0, 0, 1});
  for (const PlaceFeature& feature : view.features) EXPECT_TRUE(feature.px.allFinite());
}

TEST(PlaceDescriptor, DistanceIsTheNumberOfDifferentBits) {
  EXPECT_EQ(hammingDistance({0, 0, 0, 0}, {0, 0, 0, 0}), 0);
  EXPECT_EQ(hammingDistance({1, 0, 0, 0}, {2, 0, 0, ~std::uint64_t{0}}), 66);
}

}  // namespace
}  // namespace lintel
