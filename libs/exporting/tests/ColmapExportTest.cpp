// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "Files.h"
#include "lintel/exporting/ColmapImages.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

class ColmapExport : public FolderTest {
 protected:
  /// Two keyframes whose cameras look along the world's x axis, the second one metre to the right of the first (-y),
  /// and a point four metres ahead of the first: at the middle of its image, and 25 px to the left in the other.
  static LineMap map() {
    LineMap map;
    map.rig.camera = {200, 100, 100, 100, 99.5, 49.5, 0, 0, 0, 0};
    Eigen::Matrix3d R_b_c;
    R_b_c << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    map.rig.T_b_c.q = Eigen::Quaterniond(R_b_c);
    MapKeyframe keyframe;
    keyframe.id = 7;
    keyframe.t_ns = 1000;
    map.keyframes.push_back(keyframe);
    keyframe.id = 9;
    keyframe.t_ns = 2000;
    keyframe.T_w_b.p = {0, -1, 0};
    map.keyframes.push_back(keyframe);
    MapPoint point;
    point.id = 4;
    point.p_w = {4, 0, 0};
    point.observations = {{7, {99.5, 49.5}}, {9, {74.5, 51.5}}};  // the second 2 px off
    map.points.push_back(point);
    return map;
  }

  template <class T>
  static T take(std::string& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.erase(0, sizeof value);
    return value;
  }
};

TEST_F(ColmapExport, TextIsAsComputedByHand) {
  const ExportSummary summary = exportMap(map(), in("model.colmaptxt"));
  EXPECT_EQ(summary.files.front(), in("model.colmaptxt"));
  const auto body = [&](const std::string& name) {
    const std::string text = content(in("model.colmaptxt/" + name));
    return text.substr(text.find('\n') + 1);
  };
  EXPECT_EQ(body("cameras.txt"), "1 PINHOLE 200 100 100 100 100 50\n");
  EXPECT_EQ(body("points3D.txt"), "5 4 0 0 128 128 128 1 1 0 2 0\n");
  // q_c_w: turns x to z, y to -x, z to -y; the second camera's centre is at y = -1, which is x = 1 in the camera
  EXPECT_EQ(body("images.txt"),
            "1 0.5 0.5 -0.5 0.5 0 0 0 1 1000.png\n100 50 5\n2 0.5 0.5 -0.5 0.5 -1 0 0 1 2000.png\n75 52 5\n");
}

TEST_F(ColmapExport, CamerasAreWhereTheyWereWhenTheImageWasTaken) {
  LineMap moving = map();
  moving.time_offset_s = -0.01, moving.keyframes[1].offset_change_s = -0.02;
  for (MapKeyframe& keyframe : moving.keyframes) keyframe.v_w_b = {0, -1, 0};  // 1 m/s to the right
  exportMap(moving, in("model.colmap"));
  std::string images = content(in("model.colmap/images.bin"));
  const auto centre_x = [&](std::size_t at) {  // with these axes -t_x is the centre's x
    double t;
    std::memcpy(&t, images.data() + at, sizeof t);
    return -t;
  };
  const std::size_t first = 8 + 4 + 4 * 8;
  EXPECT_NEAR(centre_x(first), -0.01, 1e-12);
  const std::size_t image_bytes = 4 + 7 * 8 + 4 + std::strlen("1000.png") + 1 + 8 + 24;
  EXPECT_NEAR(centre_x(first + image_bytes), 1 - 0.03, 1e-12);
}

TEST_F(ColmapExport, BinaryHoldsTheSame) {
  exportMap(map(), in("model.colmap"));
  std::string cameras = content(in("model.colmap/cameras.bin")), images = content(in("model.colmap/images.bin")),
              points = content(in("model.colmap/points3D.bin"));
  EXPECT_EQ(take<std::uint64_t>(cameras), 1U);
  EXPECT_EQ(take<std::uint32_t>(cameras), 1U);
  EXPECT_EQ(take<std::int32_t>(cameras), 1);  // PINHOLE
  EXPECT_EQ(take<std::uint64_t>(cameras), 200U);
  EXPECT_EQ(take<std::uint64_t>(cameras), 100U);
  for (const double value : {100., 100., 100., 50.}) EXPECT_EQ(take<double>(cameras), value);
  EXPECT_EQ(cameras, "");

  EXPECT_EQ(take<std::uint64_t>(images), 2U);
  for (const std::uint32_t id : {1U, 2U}) {
    EXPECT_EQ(take<std::uint32_t>(images), id);
    for (const double value : {0.5, 0.5, -0.5, 0.5, id == 1 ? 0. : -1., 0., 0.})
      EXPECT_NEAR(take<double>(images), value, 1e-15);
    EXPECT_EQ(take<std::uint32_t>(images), 1U);
    EXPECT_STREQ(images.c_str(), id == 1 ? "1000.png" : "2000.png");
    images.erase(0, 9);
    EXPECT_EQ(take<std::uint64_t>(images), 1U);
    EXPECT_EQ(take<double>(images), id == 1 ? 100. : 75.);
    EXPECT_EQ(take<double>(images), id == 1 ? 50. : 52.);
    EXPECT_EQ(take<std::uint64_t>(images), 5U);
  }
  EXPECT_EQ(images, "");

  EXPECT_EQ(take<std::uint64_t>(points), 1U);
  EXPECT_EQ(take<std::uint64_t>(points), 5U);
  for (const double value : {4., 0., 0.}) EXPECT_EQ(take<double>(points), value);
  points.erase(0, 3);
  EXPECT_NEAR(take<double>(points), 1, 1e-12);
  EXPECT_EQ(take<std::uint64_t>(points), 2U);
  for (const std::uint32_t value : {1U, 0U, 2U, 0U}) EXPECT_EQ(take<std::uint32_t>(points), value);
  EXPECT_EQ(points, "");
}

/// Each lens with the model of COLMAP that holds all of its coefficients; one that has none is refused by name.
TEST_F(ColmapExport, LensesHaveTheirModels) {
  const auto camera = [&](LensModel model, const std::array<double, 8>& lens) {
    LineMap lensed = map();
    lensed.rig.camera.model = model;
    lensed.rig.camera.lens = lens;
    std::filesystem::remove_all(in("model.colmaptxt"));
    exportMap(lensed, in("model.colmaptxt"));
    const std::string text = content(in("model.colmaptxt/cameras.txt"));
    return text.substr(text.find('\n') + 1);
  };
  EXPECT_EQ(camera(LensModel::kEquidistant, {0.5, 0.25, 0.125, 0.0625}),
            "1 OPENCV_FISHEYE 200 100 100 100 100 50 0.5 0.25 0.125 0.0625\n");
  EXPECT_EQ(camera(LensModel::kRadialTangential, {0.5, 0.25, 0.125, 0.0625}),
            "1 OPENCV 200 100 100 100 100 50 0.5 0.25 0.125 0.0625\n");
  EXPECT_EQ(camera(LensModel::kRational, {0.5, 0.25, 0.125, 0.0625, 1, 2, 3, 4}),
            "1 FULL_OPENCV 200 100 100 100 100 50 0.5 0.25 0.125 0.0625 1 2 3 4\n");
  EXPECT_EQ(camera(LensModel::kRadialTangential, {0.5, 0.25, 0.125, 0.0625, 2}),
            "1 FULL_OPENCV 200 100 100 100 100 50 0.5 0.25 0.125 0.0625 2 0 0 0\n");
  EXPECT_THAT(
      [&] {
        camera(LensModel::kDoubleSphere, {-0.2, 0.6});
      },
      testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("COLMAP has no lens model double-sphere")));
}

TEST_F(ColmapExport, ImagesHaveTheNamesOfTheModel) {
  std::int64_t t_ns = 0;
  const auto image = std::make_shared<const GrayImage>(GrayImage{4, 2, std::vector<std::uint8_t>(8, 77)});
  const auto next = [&]() -> std::optional<Frame> { return Frame{t_ns += 500, image}; };
  EXPECT_EQ(writeColmapImages(map(), in("model/images"), next), 2U);
  EXPECT_EQ(t_ns, 2000);  // not read beyond the last keyframe
  EXPECT_TRUE(std::filesystem::exists(in("model/images/1000.png")));
  EXPECT_TRUE(std::filesystem::exists(in("model/images/2000.png")));
  EXPECT_EQ(writeColmapImages(map(), in("model/images"), []() -> std::optional<Frame> { return {}; }), 0U);
}

TEST_F(ColmapExport, AFileInTheWayIsAnError) {
  std::ofstream(in("model.colmap")) << "something else";
  EXPECT_THROW(exportMap(map(), in("model.colmap")), ExportError);
}

}  // namespace
}  // namespace lintel
