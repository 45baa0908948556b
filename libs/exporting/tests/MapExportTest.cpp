// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/exporting/MapExport.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "Files.h"
#include "Reimport.h"
#include "SampleMap.h"
#include "ViewerPage.h"

namespace lintel {
namespace {

const LineMap kRoom = sampleRoom();

class MapExport : public FolderTest {};

Segment3 upright(const Segment3& s) {  // z up to y up
  const auto turn = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.z(), -p.y()); };
  return {turn(s.start), turn(s.end)};
}

/// `relative`: single precision holds seven digits, so runaway lines far off are compared by their size.
bool same(const Segment3& a, const Segment3& b) {
  const double scale = std::max({1.0, b.start.norm() / 10, b.end.norm() / 10});
  return (a.start - b.start).norm() < 1e-6 * scale && (a.end - b.end).norm() < 1e-6 * scale;
}

void expectSameSegments(const std::vector<Segment3>& found, bool y_up) {
  ASSERT_EQ(found.size(), kRoom.lines.size());
  std::vector<bool> used(found.size());
  for (const MapLine& line : kRoom.lines) {
    const Segment3 wanted = y_up ? upright(line.segment_w) : line.segment_w;
    bool matched = false;
    for (std::size_t i = 0; i < found.size() && !matched; ++i) {
      if (!used[i] && same(found[i], wanted)) used[i] = matched = true;
    }
    EXPECT_TRUE(matched) << "line " << line.id;
  }
}

ExportParams style(LineStyle s) {
  ExportParams params;
  params.style = s;
  return params;
}

TEST_F(MapExport, ObjGivesTheSameSegmentsBack) {
  exportMap(kRoom, in("map.obj"));
  const Reimported obj = reimport(in("map.obj"));
  ASSERT_EQ(obj.error, "");
  expectSameSegments(obj.segments, false);
  EXPECT_EQ(obj.triangles, 12 * kRoom.lines.size());
  exportMap(kRoom, in("lines.obj"), style(LineStyle::kLines));
  const Reimported lines = reimport(in("lines.obj"));
  expectSameSegments(lines.segments, false);
  EXPECT_EQ(lines.triangles, 0u);
}

TEST_F(MapExport, ObjKeepsVertexOneOutOfFaces) {
  exportMap(kRoom, in("map.obj"));
  const std::string text = content(in("map.obj"));
  EXPECT_THAT(text, ::testing::HasSubstr("\nf "));
  for (std::size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) {
    const std::string face = text.substr(at + 2, text.find('\n', at + 1) - at - 2) + " ";
    EXPECT_EQ(face.find(" 1 "), std::string::npos) << face;
  }
}

TEST_F(MapExport, PlyTubesGiveTheSameSegmentsBack) {
  exportMap(kRoom, in("map.ply"));
  const Reimported ply = reimport(in("map.ply"));
  ASSERT_EQ(ply.error, "");
  EXPECT_EQ(ply.triangles, 12 * kRoom.lines.size());
  expectSameSegments(ply.tubes, false);
}

TEST_F(MapExport, GlbGivesTheSameSegmentsBackUnderNamedNodes) {
  const ExportSummary summary = exportMap(kRoom, in("map.glb"));
  EXPECT_EQ(summary.lines, kRoom.lines.size());
  EXPECT_EQ(summary.points, 300u);
  EXPECT_EQ(summary.keyframes, 20u);
  ExportParams params;
  params.layers = {MapLayer::kLines};
  exportMap(kRoom, in("lines.glb"), params);
  const Reimported lines = reimport(in("lines.glb"));
  ASSERT_EQ(lines.error, "");
  expectSameSegments(lines.segments, true);
  const Reimported all = reimport(in("map.glb"));
  EXPECT_EQ(all.points.size(), 300u);
  EXPECT_EQ(all.segments.size(), kRoom.lines.size() + std::size_t{20} * 8 + 199);
  EXPECT_THAT(all.nodes, ::testing::IsSupersetOf({"Map", "Lines", "Lines no group", "Lines group 0", "Lines group 2",
                                                  "Points", "Keyframes", "Trajectory"}));
  params.style = LineStyle::kTubes;
  exportMap(kRoom, in("tubes.glb"), params);
  EXPECT_EQ(reimport(in("tubes.glb")).triangles, 12 * kRoom.lines.size());
}

TEST_F(MapExport, TubesOfKeyframesAreThinnerThanThoseOfLines) {
  ExportParams params = style(LineStyle::kTubes);
  params.radius_m = 0.1;
  const auto widest = [&](MapLayer layer) {
    params.layers = {layer};
    exportMap(kRoom, in("map.ply"), params);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(in("map.ply"), 0);
    const aiVector3D* v = scene->mMeshes[0]->mVertices;
    return (v[0] - v[2]).Length();  // across the first tube
  };
  EXPECT_NEAR(widest(MapLayer::kLines), 0.2, 1e-5);
  EXPECT_NEAR(widest(MapLayer::kKeyframes), 0.06, 1e-5);
}

TEST_F(MapExport, GltfDaeAndX3dGiveTheSameSegmentsBack) {
  ExportParams params;
  params.layers = {MapLayer::kLines};
  for (const char* name : {"map.gltf", "map.dae", "map.x3d"}) {
    exportMap(kRoom, in(name), params);
    const Reimported found = reimport(in(name));
    ASSERT_EQ(found.error, "") << name;
    SCOPED_TRACE(name);
    expectSameSegments(found.segments, true);
  }
}

TEST_F(MapExport, DxfHoldsTheLinesOnTheirLayers) {
  exportMap(kRoom, in("map.dxf"));
  std::istringstream text(content(in("map.dxf")));
  std::map<int, std::string> entity;
  std::vector<Segment3> lines;
  std::string code, value;
  while (std::getline(text, code) && std::getline(text, value)) {
    if (std::stoi(code) == 0) {
      if (entity[0] == "LINE" && entity[8].rfind("LINES_", 0) == 0) {
        const auto at = [&](int c) { return std::stod(entity.at(c)); };
        lines.push_back({{at(10), at(20), at(30)}, {at(11), at(21), at(31)}});
      }
      entity.clear();
    }
    entity[std::stoi(code)] = value;
  }
  EXPECT_EQ(value, "EOF");
  expectSameSegments(lines, false);
}

TEST_F(MapExport, JsonHoldsTheFullData) {
  LineMap map = kRoom;
  map.configuration = "a: \"b\\c\"\n\t\x01";
  map.lines[5].sigma_distance_m = std::nan("");
  exportMap(map, in("map.json"));
  const auto json = nlohmann::json::parse(content(in("map.json")));
  EXPECT_EQ(json["configuration"], map.configuration);
  ASSERT_EQ(json["lines"].size(), map.lines.size());
  EXPECT_TRUE(json["lines"][5]["sigma_distance_m"].is_null());
  EXPECT_EQ(json["lines"][30]["start"][0].get<double>(), map.lines[30].segment_w.start.x());
  EXPECT_EQ(json["lines"][30]["observations"].size(), map.lines[30].observations.size());
  EXPECT_EQ(json["lines"][30]["observations"][0]["end_px"][1], 4);
  EXPECT_EQ(json["points"].size(), 300u);
  EXPECT_EQ(json["keyframes"][3]["t_ns"].get<std::int64_t>(), map.keyframes[3].t_ns);
  EXPECT_EQ(json["trajectory"].size(), 200u);
  EXPECT_EQ(json["rig"]["fx"], 458.654);
}

/// Three lines, of which the last was seen in two keyframes only.
LineMap smallCorner() {
  LineMap map;
  addLine(map, {0, 0, 0}, {1, 0, 0}, -1);
  addLine(map, {0, 0, 0}, {0, 1, 0}, -1);
  addLine(map, {1, 1, 0}, {1, 0, 0}, -1);
  map.lines[0].observations.resize(9), map.lines[1].observations.resize(9), map.lines[2].observations.resize(2);
  map.corners = {{{0, 0, 0}, 0.01, {10, 11}}, {{1, 0, 0}, 0.02, {10, 12}}};
  map.planes = {{"floor", {0, 0, 1}, 0.25, 0.002, {10, 11, 12}, {7}}};
  return map;
}

TEST_F(MapExport, CornersAndPlanesNameLinesThatAreThere) {
  const LineMap map = smallCorner();
  exportMap(map, in("map.json"));
  auto json = nlohmann::json::parse(content(in("map.json")));
  ASSERT_EQ(json["corners"].size(), 2u);
  EXPECT_EQ(json["corners"][1]["p_w"], (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(json["corners"][1]["lines"], (std::vector<int>{10, 12}));
  EXPECT_EQ(json["planes"][0]["name"], "floor");
  EXPECT_EQ(json["planes"][0]["offset_m"], 0.25);
  EXPECT_EQ(json["planes"][0]["points"].size(), 0u) << "the map has no point 7";
  ExportParams params;
  params.min_observations = 3;
  exportMap(map, in("some.json"), params);
  json = nlohmann::json::parse(content(in("some.json")));
  EXPECT_EQ(json["corners"].size(), 1u);
  EXPECT_EQ(json["planes"][0]["lines"], (std::vector<int>{10, 11}));
}

TEST_F(MapExport, GlbTellsOfCornersAndPlanes) {
  exportMap(smallCorner(), in("map.glb"));
  const std::string glb = content(in("map.glb"));
  const auto extras = nlohmann::json::parse(glb.substr(20, glb.find("BIN") - 24))["scenes"][0]["extras"];
  EXPECT_EQ(extras["corners"]["lines"][0], (std::vector<int>{10, 11}));
  EXPECT_EQ(extras["corners"]["p_w"][1], (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(extras["planes"][0]["name"], "floor");
}

TEST_F(MapExport, HtmlIsOnePageWithItsData) {
  if (!std::filesystem::exists(kThreeFolder)) GTEST_SKIP() << "libjs-three is not installed";
  LineMap map = kRoom;
  map.source = "</script><b>[[DATA]] \xff & more";
  exportMap(map, in("map.html"));
  const std::string page = content(in("map.html"));
  EXPECT_THAT(page, ::testing::HasSubstr("<title>Line map of &lt;/script&gt;&lt;b&gt;&#91;&#91;DATA]] "));
  for (const char* tag : {"<script src", "<link", "<img", "import("}) {
    EXPECT_EQ(page.find(tag), std::string::npos) << "nothing is loaded from elsewhere: " << tag;
  }
  EXPECT_THAT(page, ::testing::HasSubstr("OrbitControls"));
  const std::string begin = "id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  const auto json = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(json["lines"]["id"].size(), kRoom.lines.size());
  EXPECT_EQ(json["lines"]["ends"].get<std::string>().size(), (kRoom.lines.size() * 24 + 2) / 3 * 4);
  EXPECT_EQ(json["colours"]["height"]["rgb"].get<std::string>().size(), (kRoom.lines.size() * 3 + 2) / 3 * 4);
  EXPECT_EQ(json["path"]["seconds"][199], 9.95);
}

TEST_F(MapExport, CsvHoldsTheColumnsLosslessly) {
  LineMap map = kRoom;
  map.lines.resize(2);
  map.lines[0].segment_w = {{0.1, -1e-17, 3}, {1e10, 1.0 / 3, -0.0}};
  map.lines[0].last_t_ns = -1500000000;
  exportMap(map, in("map.csv"));
  const std::string text = content(in("map.csv"));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "id,x0,y0,z0,x1,y1,z1,observations,first_s,last_s,sigma_direction_rad,sigma_distance_m,degenerate,"
            "constrained,group,group_name,source");
  EXPECT_THAT(text, ::testing::HasSubstr("\n10,0.1,-1e-17,3,1e+10,0.3333333333333333,-0,2,1403636579.763555584,-1."
                                         "500000000,0.001,0.003,0,1,0,group 0,tracked\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST_F(MapExport, FiltersAndColoursAreHeeded) {
  ExportParams params;
  params.min_observations = 4;
  params.min_length_m = 0.5;
  params.max_sigma_m = 0.02;
  const ExportSummary summary = exportMap(kRoom, in("map.csv"), params);
  std::size_t wanted = 0;
  for (const MapLine& line : kRoom.lines)
    wanted += line.observations.size() >= 4 && line.segment_w.length() >= 0.5 && line.sigma_distance_m <= 0.02;
  EXPECT_EQ(summary.lines, wanted);
  EXPECT_EQ(summary.filtered, kRoom.lines.size() - wanted);
  EXPECT_GT(wanted, 0u);
  std::set<std::string> different;
  for (const LineColour colour :
       {LineColour::kKind, LineColour::kGroup, LineColour::kUncertainty, LineColour::kHeight}) {
    params.colour = colour;
    exportMap(kRoom, in("map.ply"), params);
    different.insert(content(in("map.ply")));
  }
  EXPECT_EQ(different.size(), 4u);
}

TEST_F(MapExport, NotFiniteLinesAreDroppedAndCounted) {
  LineMap map = kRoom;
  map.lines[0].segment_w.start.x() = std::nan("");
  map.lines[1].segment_w.end.z() = std::numeric_limits<double>::infinity();
  map.lines[2].segment_w.end = map.lines[2].segment_w.start;
  map.points[0].p_w.y() = -std::numeric_limits<double>::infinity();
  map.keyframes[0].T_w_b.p.x() = std::nan("");
  map.trajectory[3].second.p.x() = std::nan("");
  for (const std::string& extension : exportFormats()) {
    if (extension == "html" && !std::filesystem::exists(kThreeFolder)) continue;
    ExportParams params;
    params.layers = {MapLayer::kLines, MapLayer::kPoints, MapLayer::kKeyframes, MapLayer::kTrajectory};
    const ExportSummary summary = exportMap(map, in("map." + extension), params);
    EXPECT_EQ(summary.lines, kRoom.lines.size() - 3) << extension;
    EXPECT_EQ(summary.dropped, 6u) << extension;
  }
  for (const char* name : {"map.obj", "map.ply", "map.csv"}) {
    const std::string text = content(in(name));
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
    EXPECT_EQ(text.find("inf"), std::string::npos) << name;
  }
}

TEST_F(MapExport, WhatIsNoRotationIsDroppedAndCounted) {
  LineMap map = kRoom;
  map.keyframes[0].T_w_b.q.coeffs().setZero();
  map.trajectory[3].second.q.coeffs() *= 3;
  for (const char* extension : {"glb", "json", "simplemap", "colmap", "tum", "kitti"}) {
    ExportParams params;
    params.layers = {MapLayer::kKeyframes, MapLayer::kTrajectory};
    EXPECT_EQ(exportMap(map, in(std::string("map.") + extension), params).dropped, 2u) << extension;
  }
}

TEST_F(MapExport, WhatAMapLacksForAFormIsKnownBefore) {
  EXPECT_EQ(missingFor(kRoom, "map.glb"), "");
  LineMap map = kRoom;
  map.lines.clear();
  EXPECT_EQ(missingFor(map, "map.obj"), "lines");
  EXPECT_EQ(missingFor(map, "map.glb"), "");
  map.keyframes.clear();
  EXPECT_EQ(missingFor(map, "map.simplemap"), "keyframes");
  EXPECT_EQ(missingFor(map, "map.colmap"), "keyframes") << "its points would have no image";
  map.trajectory.clear();
  EXPECT_EQ(missingFor(map, "map.tum"), "trajectory");
  EXPECT_EQ(missingFor({}, "map.glb"), "lines, no points, no keyframes and no trajectory");
  ExportParams params;
  params.layers = {MapLayer::kPoints};
  EXPECT_EQ(missingFor(map, "map.obj", params), "") << "the points are asked for";
}

TEST_F(MapExport, PointsAtTheHorizonDoNotShrinkTheLinesInAViewer) {
  LineMap map = kRoom;
  map.points[7].p_w = {500, 0, 0};
  const ExportSummary drawn = exportMap(map, in("map.glb"));
  EXPECT_EQ(drawn.points, 299u);
  EXPECT_EQ(drawn.far_points, 1u);
  for (const Eigen::Vector3d& p : reimport(in("map.glb")).points) EXPECT_LT(p.norm(), 100);
  EXPECT_EQ(exportMap(map, in("map.json")).points, 300u) << "data is whole";
  map.lines.clear();
  EXPECT_EQ(exportMap(map, in("map.glb")).points, 300u) << "without lines nothing is far from them";
}

TEST_F(MapExport, UnknownExtensionsAndParametersAreNamed) {
  EXPECT_THROW(exportMap(kRoom, in("map.stl")), ExportError);
  EXPECT_THROW(exportMap(kRoom, in("map")), ExportError);
  ExportParams params;
  params.radius_m = std::nan("");
  EXPECT_THROW(exportMap(kRoom, in("map.ply"), params), ExportError);
  EXPECT_EQ(folder_.entries(), 0);
  EXPECT_NO_THROW(exportMap(kRoom, in("MAP.PLY")));
}

class EveryFormat : public FolderTest, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    if (GetParam() == "html" && !std::filesystem::exists(kThreeFolder)) GTEST_SKIP() << "libjs-three is not installed";
  }
  std::string map() const { return in("map." + GetParam()); }

  /// Of the file, or of all files of the folder.
  std::string whole() const {
    if (!std::filesystem::is_directory(map())) return content(map());
    std::string all;
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(map())) files.insert(entry.path());
    for (const auto& path : files) all += path.filename().string() + content(path.string());
    return all;
  }

  /// Lines that the form holds of `count`.
  std::size_t linesOf(std::size_t count) const {
    const std::set<std::string> without{"colmap", "colmaptxt", "tum", "kitti", "euroc"};
    return without.count(GetParam()) ? 0 : count;
  }
};

TEST_P(EveryFormat, IsTheSameFromRunToRun) {
  exportMap(kRoom, map());
  const std::string first = whole();
  exportMap(kRoom, map());
  EXPECT_GT(first.size(), 100u);
  EXPECT_TRUE(whole() == first);
}

TEST_P(EveryFormat, TakesAnEmptyMapAndASingleLine) {
  exportMap({}, map());
  if (linesOf(1) == 1) {
    EXPECT_GT(whole().size(), 40u);
  }
  LineMap one;
  addLine(one, {0, 0, 0}, {0, 0, 1}, -1);
  EXPECT_EQ(exportMap(one, map()).lines, linesOf(1));
  if (linesOf(1) == 1) {
    EXPECT_GT(whole().size(), GetParam() == "simplemap" ? 40u : 100u);  // it holds keyframes: none
  }
}

TEST_P(EveryFormat, ReportsAFullDiskAndLeavesNoFile) {
  EXPECT_THROW(exportMap(kRoom, in("missing/map." + GetParam())), ExportError);
  std::filesystem::create_symlink("/dev/full", map());
  EXPECT_THROW(exportMap(kRoom, map()), ExportError);
  std::filesystem::remove(map());
  EXPECT_EQ(folder_.entries(), 0);
}

TEST_P(EveryFormat, CopesWithExtremeNumbers) {
  LineMap extreme;
  addLine(extreme, {1e29, 0, 0}, {1e29, 1e29, 1}, 0);
  addLine(extreme, {1e7, 1e7, 1e7}, {1e7 + 2, 1e7, 1e7}, 2000000000);
  addLine(extreme, {1e-30, 0, 0}, {2e-30, 0, 0}, -7);
  extreme.lines[0].sigma_distance_m = std::nan("");
  EXPECT_EQ(exportMap(extreme, map()).lines, linesOf(3));
}

INSTANTIATE_TEST_SUITE_P(Export, EveryFormat, ::testing::ValuesIn(exportFormats()),
                         [](const auto& test) { return test.param; });

TEST_F(MapExport, TwoHundredThousandLinesGoToGlb) {
  const LineMap map = manyLines(200000);
  EXPECT_EQ(exportMap(map, in("map.glb")).lines, 200000u);
  EXPECT_LT(std::filesystem::file_size(in("map.glb")), 40u << 20);
  const std::string glb = content(in("map.glb"));
  const auto json = nlohmann::json::parse(glb.substr(20, glb.find("BIN") - 24));
  std::size_t ends = 0;
  for (const auto& mesh : json["meshes"]) {
    ends += json["accessors"][mesh["primitives"][0]["indices"].get<std::size_t>()]["count"].get<std::size_t>();
  }
  EXPECT_EQ(ends, 400000u);
}

}  // namespace
}  // namespace lintel
