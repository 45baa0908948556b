// SPDX-License-Identifier: BSD-3-Clause
#include "GroupNames.h"

#include <gmock/gmock.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "Files.h"
#include "Reimport.h"
#include "SampleMap.h"
#include "ViewerPage.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

LineMap namedRoom() {
  LineMap map = sampleRoom();
  map.groups = {{"horizontal 1", {1, 0, 0}, 0.01}, {"horizontal 2", {0, 1, 0}, 0.02}, {"vertical", {0, 0, 1}, 0}};
  return map;
}

class GroupsInFiles : public FolderTest {
 protected:
  /// What a form makes of the room with names.
  std::string written(const std::string& name) const {
    exportMap(namedRoom(), in(name));
    return content(in(name));
  }
};

TEST_F(GroupsInFiles, AreNodesInGlbAndGltf) {
  for (const char* name : {"map.glb", "map.gltf"}) {
    written(name);
    EXPECT_THAT(reimport(in(name)).nodes,
                IsSupersetOf({"Lines horizontal 1", "Lines horizontal 2", "Lines vertical", "Lines no group"}))
        << name;
  }
  const auto gltf = nlohmann::json::parse(content(in("map.gltf")));
  std::set<std::string> in_extras;
  for (const auto& node : gltf["nodes"])
    if (node.contains("extras")) in_extras.insert(node["extras"].value("group_name", ""));
  EXPECT_THAT(in_extras, IsSupersetOf({"horizontal 1", "horizontal 2", "vertical", "no group"}));
}

TEST_F(GroupsInFiles, AreLayersInDxf) {
  std::istringstream text(written("map.dxf"));
  std::set<std::string> layers, used;
  std::string code, value, kind;
  while (std::getline(text, code) && std::getline(text, value)) {
    if (std::stoi(code) == 0) kind = value;
    if (std::stoi(code) == 2 && kind == "LAYER") layers.insert(value);
    if (std::stoi(code) == 8 && kind == "LINE") used.insert(value);
  }
  EXPECT_THAT(layers, IsSupersetOf({"LINES_HORIZONTAL_1", "LINES_HORIZONTAL_2", "LINES_VERTICAL", "LINES_NO_GROUP"}));
  EXPECT_THAT(layers, IsSupersetOf(used));
}

TEST_F(GroupsInFiles, AreAListInJson) {
  const auto json = nlohmann::json::parse(written("map.json"));
  ASSERT_EQ(json["groups"].size(), 3u);
  EXPECT_EQ(json["groups"][2]["name"], "vertical");
  EXPECT_EQ(json["groups"][2]["direction"][2], 1);
  EXPECT_EQ(json["groups"][1]["spread_rad"], 0.02);
  EXPECT_EQ(json["groups"][json["lines"][0]["group"].get<std::size_t>()]["name"], "horizontal 1");
}

TEST_F(GroupsInFiles, AreNamedObjectsInTheOtherForms) {
  EXPECT_THAT(written("map.dae"), HasSubstr("name=\"Lines vertical\""));
  EXPECT_THAT(written("map.obj"), HasSubstr("\no Lines_horizontal_2\n"));
  EXPECT_THAT(written("map.x3d"), HasSubstr("DEF='Lines_vertical'"));
  EXPECT_THAT(written("map.csv"), HasSubstr(",0,horizontal 1,tracked\n"));
  written("map.3Dscene");
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(in("map.3Dscene")));
  EXPECT_TRUE(scene.getByName("Lines vertical"));
  EXPECT_TRUE(scene.getByName("Lines no group"));
  if (!std::filesystem::exists(kThreeFolder)) return;
  EXPECT_THAT(written("map.html"), HasSubstr(R"({"group":2,"name":"vertical"})"));
}

TEST(GroupNames, AreDifferentAndCanBeSpelledEverywhere) {
  LineMap map;
  map.groups.resize(7);
  map.groups[0].name = "vertical";
  map.groups[1].name = "VERTICAL";
  map.groups[2].name = "No_Group";
  map.groups[4].name = "a\n0\nEOF</script>'\"\xff and much more than a layer can take";
  map.groups[5].name = "group 3";
  const GroupNames names(map);
  EXPECT_EQ(names(0), "vertical");
  EXPECT_EQ(names(1), "VERTICAL-1");
  EXPECT_EQ(names(2), "No_Group-2");
  EXPECT_EQ(names(3), "group 3");
  EXPECT_EQ(names(4), "a_0_EOF__script_");
  EXPECT_EQ(names(5), "group 3-5");
  EXPECT_EQ(names(6), "group 6");
  EXPECT_EQ(names(99), "group 99");
  EXPECT_EQ(names(-5), "no group");
}

}  // namespace
}  // namespace lintel
