// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapFile.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "lintel/inertial/Preintegration.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

class MapFile : public ::testing::Test {
 protected:
  test::TempFolder folder_;
  const std::string path_ = folder_ / "map.lintel";
};

using test::bytesOf;

void put(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

LineMap sampleMap() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-10, 10);
  const auto vec = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
  const auto vec2 = [&] { return Eigen::Vector2d(any(random), any(random)); };
  const auto pose = [&] {
    return Pose{Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized(), vec()};
  };
  LineMap map;
  map.rig.camera = {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  map.rig.T_b_c = pose();
  map.rig.camera_rate_hz = 19.5, map.rig.imu_rate_hz = 201, map.rig.imu_noise = {1e-3, 2e-4, 3e-5, 4e-6};
  map.configuration = std::string("a: 1\nb: \xC3\xA4\n\0c", 13);
  map.source = "MH_01_easy";
  for (std::uint64_t i = 0; i < 5; ++i)
    map.keyframes.push_back({i * 3, std::int64_t(1403636579763555584 + i), pose(), vec(), vec(), vec()});
  for (std::uint64_t i = 0; i < 20; ++i) {
    map.points.push_back({i, vec(), std::abs(any(random)), -5, 1403636579763555584, {}});
    for (std::uint64_t k = 0; k < i % 4; ++k) map.points.back().observations.push_back({k, vec2()});
  }
  for (std::uint64_t i = 0; i < 20; ++i) {
    MapLine line{i + 100, {vec(), vec()}, 0.01, 0.02, 5, 6, i % 2 == 0, i % 3 == 0, i == 7, int(i % 3) - 1, {}};
    for (std::uint64_t k = 0; k < i % 5; ++k) line.observations.push_back({k, vec2(), vec2()});
    map.lines.push_back(line);
  }
  map.lines[3].segment_w.start = {std::nan(""), -0.0, std::numeric_limits<double>::infinity()};
  map.lines[4].segment_w.start = {std::numeric_limits<double>::denorm_min(), 1e308, 0.1};
  map.lines[19].id = ~std::uint64_t{0};
  map.groups = {{"vertical", {0, 0, 1}, 0.01}, {"", vec(), -1}};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) map.lines[5].covariance(r, c) = 0.1f * static_cast<float>(r + c);
  map.camera_errors.assign(map.keyframes.size(), CameraErrors::Constant(0.25f));
  map.camera_errors[3](5, kErrorDraws - 1) = -1e-4f;
  map.corners = {{vec(), 0.01, {101, 102}}, {vec(), 0.02, {103, 104, 105}}};
  map.planes = {{"floor", {0, 0, 1}, -0.5, 0.003, {101, 102, 103}, {4, 5}}, {"wall 1", vec(), 2, 0.004, {107}, {}}};
  for (int i = 0; i < 30; ++i) map.trajectory.emplace_back(1403636579763555584 + i, pose());
  map.time_offset_s = -0.0031;
  map.recordings = {"MH_01_easy", ""};
  map.pieces = {{0, 5, 8, 0, 0, 0}, {9, 1403636579763555584, 1403636579763555588, 20, 0, 1}};
  auto imu = std::make_shared<Preintegration>(ImuBias{vec(), vec()}, ImuNoise{1e-3, 1e-4, 1e-5, 1e-6, 0.02});
  imu->append({{5, vec(), vec()}, {1000005, vec(), vec(), true}, {2000005, vec(), vec(), false, 0, 0.5F}});
  imu->setStampNoise(0.002, Preintegration::Matrix9::Zero());
  map.keyframes[1].imu = imu;
  map.keyframes[1].at_rest = true;
  map.keyframes[2].offset_change_s = 0.0055;
  map.views.push_back({1, {17, {{{1.5F, 2.25F}, -1, 0, {1, 2, 3, ~std::uint64_t{0}}}, {{0, 0}, 7, 2, {}}}}});
  return map;
}

TEST_F(MapFile, OtherLensesReturn) {
  for (const LensModel model : {LensModel::kRadialTangential, LensModel::kRational, LensModel::kEquidistant,
                                LensModel::kDoubleSphere, LensModel::kExtendedUnified}) {
    LineMap map = sampleMap();
    map.rig.camera.model = model;
    map.rig.camera.lens = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
    writeMap(map, path_);
    const LineMap back = readMap(path_);
    EXPECT_EQ(back.rig.camera.model, model);
    EXPECT_EQ(back.rig.camera.lens, map.rig.camera.lens);
  }
}

TEST_F(MapFile, EveryValueReturnsToTheBit) {
  const LineMap map = sampleMap();
  writeMap(map, path_);
  const LineMap back = readMap(path_);
  ASSERT_EQ(back.lines.size(), 20u);
  ASSERT_EQ(back.points.size(), 20u);
  ASSERT_EQ(back.keyframes.size(), 5u);
  ASSERT_EQ(back.trajectory.size(), 30u);
  EXPECT_EQ(back.configuration, map.configuration);
  EXPECT_EQ(back.source, "MH_01_easy");
  EXPECT_EQ(back.rig.camera.width, 752);
  EXPECT_EQ(back.rig.camera.lens[3], 1.76187114e-05);
  EXPECT_EQ(back.rig.T_b_c.q.coeffs(), map.rig.T_b_c.q.coeffs());
  EXPECT_EQ(back.rig.imu_noise.accel_walk, 4e-6);
  EXPECT_EQ(back.rig.imu_noise.accel_noise, 3e-5);
  EXPECT_EQ(back.keyframes[2].T_w_b.q.coeffs(), map.keyframes[2].T_w_b.q.coeffs());
  EXPECT_EQ(back.keyframes[2].bias_accel, map.keyframes[2].bias_accel);
  EXPECT_EQ(back.keyframes[4].t_ns, 1403636579763555588);
  EXPECT_EQ(back.keyframes[1].offset_change_s, 0);
  EXPECT_EQ(back.keyframes[2].offset_change_s, 0.0055);
  EXPECT_EQ(back.points[3].observations[2].px, map.points[3].observations[2].px);
  EXPECT_EQ(back.points[3].first_t_ns, -5);
  EXPECT_EQ(back.points[3].sigma_distance_m, map.points[3].sigma_distance_m);
  // NaN and -0 too: by their bits
  for (const std::size_t i : {std::size_t{3}, std::size_t{4}}) {
    const auto bits = [](const Eigen::Vector3d& v) {
      std::array<std::uint64_t, 3> result{};
      std::memcpy(result.data(), v.data(), sizeof result);
      return result;
    };
    EXPECT_EQ(bits(back.lines[i].segment_w.start), bits(map.lines[i].segment_w.start));
    EXPECT_EQ(bits(back.lines[i].segment_w.end), bits(map.lines[i].segment_w.end));
  }
  EXPECT_EQ(back.lines[19].id, ~std::uint64_t{0});
  EXPECT_EQ(back.lines[9].observations[3].end_px, map.lines[9].observations[3].end_px);
  EXPECT_EQ(back.lines[9].constrained, true);
  EXPECT_EQ(back.lines[9].degenerate, false);
  EXPECT_EQ(back.lines[9].mapped, false);
  EXPECT_EQ(back.lines[7].mapped, true);
  EXPECT_EQ(back.lines[8].group, 1);
  EXPECT_EQ(back.lines[9].group, -1);
  EXPECT_EQ(back.lines[8].last_t_ns, 6);
  EXPECT_EQ(back.trajectory[29].first, 1403636579763555584 + 29);
  ASSERT_EQ(back.groups.size(), 2u);
  EXPECT_EQ(back.groups[0].name, "vertical");
  EXPECT_EQ(back.groups[1].direction_w, map.groups[1].direction_w);
  EXPECT_EQ(back.groups[1].spread_rad, -1);
  EXPECT_EQ(back.lines[5].covariance, map.lines[5].covariance);
  EXPECT_TRUE(back.lines[6].covariance.isZero(0));
  EXPECT_EQ(back.camera_errors, map.camera_errors);
  ASSERT_EQ(back.corners.size(), 2u);
  EXPECT_EQ(back.corners[1].p_w, map.corners[1].p_w);
  EXPECT_EQ(back.corners[1].sigma_m, 0.02);
  EXPECT_EQ(back.corners[1].lines, map.corners[1].lines);
  ASSERT_EQ(back.planes.size(), 2u);
  EXPECT_EQ(back.planes[0].name, "floor");
  EXPECT_EQ(back.planes[0].offset_m, -0.5);
  EXPECT_EQ(back.planes[1].normal_w, map.planes[1].normal_w);
  EXPECT_EQ(back.planes[0].points, map.planes[0].points);
  EXPECT_EQ(back.planes[1].lines, map.planes[1].lines);
  EXPECT_EQ(back.trajectory[29].second.p, map.trajectory[29].second.p);
  EXPECT_EQ(back.time_offset_s, -0.0031);
  EXPECT_EQ(back.recordings, map.recordings);
  ASSERT_EQ(back.pieces.size(), 2u);
  EXPECT_EQ(back.pieces[1].first_keyframe, 9u);
  EXPECT_EQ(back.pieces[1].last_ns, 1403636579763555588);
  EXPECT_EQ(back.pieces[1].first_pose, 20u);
  EXPECT_EQ(back.pieces[1].recording, 1);
  EXPECT_FALSE(back.keyframes[0].imu);
  ASSERT_TRUE(back.keyframes[1].imu);
  EXPECT_TRUE(back.keyframes[1].at_rest);
  EXPECT_EQ(back.keyframes[1].imu->deltaP(), map.keyframes[1].imu->deltaP());
  EXPECT_TRUE(back.keyframes[1].imu->samples()[1].bridged);
  EXPECT_TRUE(back.keyframes[1].imu->samples()[2].bridged) << "beyond the range: as uncertain as a drop-out";
  EXPECT_EQ(back.keyframes[1].imu->stampSigma(), 0.002);
  EXPECT_EQ(back.keyframes[1].imu->noise().accel_correlated, 0.02);
  ASSERT_EQ(back.views.size(), 1u);
  EXPECT_EQ(back.views[0].looks.t_ns, 17);
  EXPECT_EQ(back.views[0].looks.features[0].px, Eigen::Vector2f(1.5F, 2.25F));
  EXPECT_EQ(back.views[0].looks.features[0].descriptor[3], ~std::uint64_t{0});
  EXPECT_EQ(back.views[0].looks.features[1].track, 7);
  // All the rest: the map read back makes the same bytes.
  writeMap(back, path_ + "2");
  EXPECT_EQ(bytesOf(path_), bytesOf(path_ + "2"));
}

TEST_F(MapFile, WhatIsBeyondTheRangeOfTheImuReturnsAsADropOut) {
  LineMap map = sampleMap();
  auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
  ImuBatch samples{{0}, {1'000'000}, {2'000'000}};
  samples[1].accel_open = 0.5F;
  imu->append(samples);
  map.keyframes[1].imu = imu;
  writeMap(map, path_);
  const auto back = readMap(path_).keyframes[1].imu;
  EXPECT_TRUE(back->samples()[1].bridged);
  EXPECT_FALSE(back->samples()[2].bridged);
}

TEST_F(MapFile, AnEmptyMapIsAFile) {
  writeMap({}, path_);
  const LineMap back = readMap(path_);
  EXPECT_TRUE(back.lines.empty() && back.points.empty() && back.keyframes.empty() && back.trajectory.empty());
}

TEST_F(MapFile, EveryTruncationIsRefused) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    put(path_, whole.substr(0, size));
    EXPECT_THROW(readMap(path_), MapFileError) << size;
  }
  put(path_, whole + "x");
  EXPECT_THROW(readMap(path_), MapFileError);
}

TEST_F(MapFile, EveryFlippedBitIsRefused) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    std::string mutated = whole;
    const std::size_t at = i < 200 ? static_cast<std::size_t>(i) % whole.size() : random() % whole.size();
    mutated[at] = static_cast<char>(mutated[at] ^ (1 << random() % 8));
    EXPECT_THROW(mapFromBytes(mutated, "mutated"), MapFileError) << "byte " << at;
  }
}

/// Repairs the checksums, so that the mutations reach the decoding behind them.
std::string withRightChecksums(std::string bytes) {
  for (std::size_t at = 12; at + 16 <= bytes.size();) {
    std::uint64_t size;
    std::memcpy(&size, bytes.data() + at + 4, 8);
    if (size > bytes.size() - at - 16) break;
    const auto crc =
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data() + at), 12 + size));
    std::memcpy(bytes.data() + at + 12 + size, &crc, 4);
    at += 16 + size;
  }
  return bytes;
}

TEST_F(MapFile, MutationsWithRightChecksumsNeverCrash) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  ASSERT_EQ(withRightChecksums(whole), whole);
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string mutated = whole;
    const std::uint32_t changes = 1 + random() % 4;
    for (std::uint32_t k = 0; k < changes; ++k) {
      const std::size_t at = random() % whole.size();
      const char values[] = {0, 1, char(0x7f), char(0x80), char(0xff), static_cast<char>(random())};
      std::fill_n(mutated.begin() + static_cast<std::ptrdiff_t>(at),
                  std::min<std::size_t>(1 + random() % 8, whole.size() - at), values[random() % 6]);
    }
    try {
      const LineMap map = mapFromBytes(withRightChecksums(mutated), "mutated");
      EXPECT_LE(map.lines.size(), whole.size());
    } catch (const MapFileError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    }
  }
  EXPECT_GT(refused, 150);
}

TEST_F(MapFile, WholeSectionsThatSayWhatCannotBeAreRefused) {
  const std::vector<std::pair<const char*, std::function<void(LineMap&)>>> cases{
      {"records that are out of order", [](LineMap& m) { m.keyframes[2].id = m.keyframes[1].id; }},
      {"records that are out of order", [](LineMap& m) { std::swap(m.points[2], m.points[3]); }},
      {"records that are out of order", [](LineMap& m) { m.lines[3].id = 0; }},
      {"a keyframe of the number 18446744073709551615", [](LineMap& m) { m.keyframes.back().id = ~std::uint64_t{0}; }},
      {"a line in a group that does not exist", [](LineMap& m) { m.lines[3].group = 2; }},
      {"a line in a group that does not exist", [](LineMap& m) { m.lines[3].group = -2; }},
      {"a camera whose numbers are out of range", [](LineMap& m) { m.rig.camera.width = -1; }},
      {"a camera whose numbers are out of range", [](LineMap& m) { m.rig.camera.fx = std::nan(""); }},
      {"clocks that are an hour apart", [](LineMap& m) { m.time_offset_s = 1e300; }},
      {"times that are out of range", [](LineMap& m) { m.keyframes[0].t_ns = INT64_MIN; }},
      {"times that are out of range", [](LineMap& m) { m.trajectory[0].first = INT64_MAX; }},
      {"times that are out of range", [](LineMap& m) { m.lines[0].last_t_ns = INT64_MAX; }},
      {"times that are out of range", [](LineMap& m) { m.views[0].looks.t_ns = INT64_MIN; }},
      {"a piece in the frame of a later one", [](LineMap& m) { m.pieces[0].world = 1; }},
      {"a piece of a recording that it does not name", [](LineMap& m) { m.pieces[1].recording = 2; }},
      {"a piece of a recording that it does not name", [](LineMap& m) { m.pieces[1].recording = -1; }},
      {"a piece that ends before it begins", [](LineMap& m) { m.pieces[0].last_ns = 4; }},
      {"pieces out of order", [](LineMap& m) { m.pieces[1].first_keyframe = 0; }},
      {"a piece beyond its trajectory", [](LineMap& m) { m.pieces[1].first_pose = 31; }},
      {"an hour of IMU from one keyframe to the next",
       [](LineMap& m) {
         auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
         imu->append({{5, {}, {}}, {4'000'000'000'000, {}, {}}});
         m.keyframes[1].imu = imu;
       }},
      {"stamps that are off by no time that can be",
       [](LineMap& m) {
         auto imu = std::make_shared<Preintegration>(*m.keyframes[1].imu);
         imu->setStampNoise(2, Preintegration::Matrix9::Zero());
         m.keyframes[1].imu = imu;
       }},
      {"noise that no accelerometer has", [](LineMap& m) {
         auto imu = std::make_shared<Preintegration>(*m.keyframes[1].imu);
         imu->raiseNoise({0, 0, 0, 0, 100});
         m.keyframes[1].imu = imu;
       }}};
  for (const auto& [what, change] : cases) {
    LineMap map = sampleMap();
    change(map);
    writeMap(map, path_);
    try {
      readMap(path_);
      ADD_FAILURE() << "read: " << what;
    } catch (const MapFileError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }
}

TEST_F(MapFile, AbsurdCountsAreRefusedBeforeAnythingIsReserved) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  for (const char* section : {"KEYF", "PNTS", "LINE", "TRAJ", "GRPS"}) {
    const std::size_t at = whole.find(section) + 12;
    for (const std::uint64_t count : {std::uint64_t{1} << 24, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
      std::string mutated = whole;
      std::memcpy(mutated.data() + at, &count, 8);
      try {
        mapFromBytes(withRightChecksums(mutated), "mutated");
        ADD_FAILURE() << section << " with " << count << " records was read";
      } catch (const MapFileError& error) {
        EXPECT_NE(std::string(error.what()).find("announces more records than it has bytes"), std::string::npos)
            << error.what();
      }
    }
  }
}

TEST_F(MapFile, TheBytesOfThisVersionAreSettled) {
  LineMap map;
  map.source = "a";
  map.keyframes = {{3, 4, {}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  map.points = {{5, {1, 2, 3}, 0.5, 6, 7, {{3, {8, 9}}}}};
  map.lines = {{8, {{1, 2, 3}, {4, 5, 6}}, 0.25, 0.5, 9, 10, true, false, false, 0, {{3, {1, 2}, {3, 4}}}}};
  map.groups = {{"vertical", {0, 0, 1}, 0.125}};
  map.trajectory = {{11, {}}};
  writeMap(map, path_);
  const std::string bytes = bytesOf(path_);
  EXPECT_EQ(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()), 1631493303u)
      << "maps that people have could not be read any more: raise the version and keep reading this one";
}

TEST_F(MapFile, UnknownSectionsAreSkipped) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  std::string later =
      whole.substr(0, 12) + "NEWS" + std::string("\5\0\0\0\0\0\0\0", 8) + "hello" + "crc!" + whole.substr(12);
  later = withRightChecksums(later);
  put(path_, later);
  writeMap(readMap(path_), path_);
  EXPECT_EQ(bytesOf(path_), whole);
}

TEST_F(MapFile, AFileFromBeforeASectionWasAddedIsRead) {
  writeMap(sampleMap(), path_);
  const std::string whole = bytesOf(path_);
  const std::size_t groups = whole.find("GRPS"), end = whole.rfind("END_");
  ASSERT_TRUE(groups != std::string::npos && end != std::string::npos && groups < end);
  const LineMap back = mapFromBytes(whole.substr(0, groups) + whole.substr(end), "earlier");
  EXPECT_TRUE(back.groups.empty());
  EXPECT_EQ(back.lines.size(), 20u);
}

TEST_F(MapFile, ALaterVersionAndOtherFilesAreNamed) {
  writeMap({}, path_);
  std::string bytes = bytesOf(path_);
  bytes[8] = 9;
  put(path_, bytes);
  const auto message = [](const std::string& path) -> std::string {
    try {
      readMap(path);
      return "read";
    } catch (const MapFileError& error) {
      return error.what();
    }
  };
  EXPECT_NE(message(path_).find("format 9"), std::string::npos);
  EXPECT_NE(message(folder_.path().string()).find(folder_.path().string()), std::string::npos);
  EXPECT_NE(message(path_ + ".missing").find("No such file"), std::string::npos);
  put(path_, "id,x0,y0\n");
  EXPECT_NE(message(path_).find("does not begin"), std::string::npos);
}

TEST_F(MapFile, AFailedWriteLeavesTheOldFileAndNothingElse) {
  EXPECT_THROW(writeMap({}, folder_ / "missing/map.lintel"), MapFileError);
  EXPECT_THROW(writeMap({}, folder_.path().string()), MapFileError);
  EXPECT_THROW(writeMap(sampleMap(), "/dev/full"), MapFileError);
  EXPECT_EQ(folder_.entries(), 0);
  writeMap(sampleMap(), path_);
  EXPECT_EQ(folder_.entries(), 1);
}

}  // namespace
}  // namespace lintel
