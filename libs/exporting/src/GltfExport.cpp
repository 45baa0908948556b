// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "AssimpScene.h"
#include "Writers.h"
#include "lintel/core/Base64.h"

// glTF 2 by assimp, then what assimp cannot say: which data belongs to each line (extras), unlit strokes.
namespace lintel {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942, kMagic = 0x46546C67;

struct Glb {
  Json json;
  std::string binary;
};

std::uint32_t u32At(const std::string& bytes, std::size_t at) {
  if (at + 4 > bytes.size()) throw ExportError("assimp's glb breaks off");
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i)
    v |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return v;
}

void appendU32(std::string& bytes, std::size_t v) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(v >> (8 * i)));
}

Glb splitGlb(const std::string& bytes) {
  Glb glb;
  for (std::size_t at = 12; at < bytes.size();) {
    const std::uint32_t size = u32At(bytes, at), kind = u32At(bytes, at + 4);
    const std::string_view chunk = std::string_view(bytes).substr(at + 8, size);
    if (kind == kJsonChunk) glb.json = Json::parse(chunk);
    if (kind == kBinaryChunk) glb.binary = chunk;
    at += 8 + size;
  }
  return glb;
}

std::string joinGlb(const Glb& glb) {
  std::string json = glb.json.dump();
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string binary = glb.binary;
  binary.append((4 - binary.size() % 4) % 4, '\0');
  std::string bytes;
  bytes.reserve(28 + json.size() + binary.size());
  appendU32(bytes, kMagic), appendU32(bytes, 2);
  appendU32(bytes, 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
  appendU32(bytes, json.size()), appendU32(bytes, kJsonChunk);
  bytes += json;
  if (binary.empty()) return bytes;
  appendU32(bytes, binary.size()), appendU32(bytes, kBinaryChunk);
  return bytes += binary;
}

/// What is known of each line of a part, by column: element i belongs to the mesh's segment i.
Json lineData(const Drawing& drawing, const DrawnPart& part) {
  Json ids = Json::array(), observations = Json::array(), direction = Json::array(), distance = Json::array(),
       degenerate = Json::array(), constrained = Json::array(), mapped = Json::array();
  const auto finite = [](double v) { return std::isfinite(v) ? Json(static_cast<float>(v)) : Json(nullptr); };
  for (const DrawnSegment& s : part.segments) {
    ids.push_back(s.line->id), observations.push_back(s.line->observations.size());
    direction.push_back(finite(s.line->sigma_direction_rad)), distance.push_back(finite(s.line->sigma_distance_m));
    degenerate.push_back(s.line->degenerate ? 1 : 0), constrained.push_back(s.line->constrained ? 1 : 0);
    mapped.push_back(s.line->mapped ? 1 : 0);
  }
  const GroupNames names(*drawing.map);
  return {{"group", part.group},          {"group_name", names(part.group)},  {"id", ids},
          {"observations", observations}, {"sigma_direction_rad", direction}, {"sigma_distance_m", distance},
          {"degenerate", degenerate},     {"constrained", constrained},       {"mapped", mapped}};
}

/// What is known of each keyframe, by column. Times are text: they do not fit a reader's double.
Json keyframeData(const Drawing& drawing) {
  Json ids = Json::array(), times = Json::array();
  for (const MapKeyframe& keyframe : drawing.keyframes)
    ids.push_back(keyframe.id), times.push_back(std::to_string(keyframe.t_ns));
  return {{"id", ids}, {"t_ns", times}, {"strokes_each", kFrustumStrokes}};
}

/// Corners by column, and planes; in the world's axes, z up.
Json structureData(const Drawing& drawing) {
  const auto finite = [](double v) { return std::isfinite(v) ? Json(static_cast<float>(v)) : Json(nullptr); };
  Json places = Json::array(), sigmas = Json::array(), lines = Json::array(), planes = Json::array();
  for (const MapCorner& corner : drawing.structure.corners) {
    places.push_back({finite(corner.p_w.x()), finite(corner.p_w.y()), finite(corner.p_w.z())});
    sigmas.push_back(finite(corner.sigma_m)), lines.push_back(corner.lines);
  }
  for (const MapPlane& plane : drawing.structure.planes) {
    const Eigen::Vector3d& n = plane.normal_w;
    planes.push_back({{"name", plane.name},
                      {"normal", {finite(n.x()), finite(n.y()), finite(n.z())}},
                      {"offset_m", finite(plane.offset_m)},
                      {"spread_m", finite(plane.spread_m)},
                      {"lines", plane.lines}});
  }
  return {{"corners", {{"p_w", places}, {"sigma_m", sigmas}, {"lines", lines}}}, {"planes", planes}};
}

void addExtras(const Drawing& drawing, Json& json) {
  json["asset"]["generator"] = "Lintel";
  json["asset"]["extras"] = {{"source", drawing.map->source},
                             {"lines", drawing.summary.lines},
                             {"points", drawing.summary.points},
                             {"keyframes", drawing.summary.keyframes},
                             {"frame", "world, z up, below the node Map"}};
  if (json.contains("scenes") && !json["scenes"].empty()) json["scenes"][0]["extras"] = structureData(drawing);
  if (!json.contains("nodes")) return;
  for (Json& node : json["nodes"]) {
    for (const DrawnPart& part : drawing.parts) {
      if (part.layer == MapLayer::kLines && node.value("name", "") == part.name)
        node["extras"] = lineData(drawing, part);
      if (part.layer == MapLayer::kKeyframes && node.value("name", "") == part.name)
        node["extras"] = keyframeData(drawing);
    }
  }
}

/// Materials anew: assimp adds an extension that it does not declare. Strokes have no normals, so they are unlit.
void writeMaterials(Json& json) {
  bool any_unlit = false;
  for (Json& material : json["materials"]) {
    const std::string name = material.value("name", "");
    material = {{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.9}}}};
    if (name.rfind("Strokes", 0) != 0) continue;
    material["extensions"]["KHR_materials_unlit"] = Json::object();
    any_unlit = true;
  }
  json.erase("extensionsUsed");
  if (any_unlit) json["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
}

/// glTF allows no empty lists: an empty map is a scene of nodes only.
void removeEmptyLists(Json& json) {
  for (const char* list : {"buffers", "bufferViews", "accessors", "meshes"}) {
    if (json.contains(list) && json[list].empty()) json.erase(list);
  }
  if (!json.contains("meshes")) json.erase("materials"), json.erase("buffers"), json.erase("extensionsUsed");
}

Glb makeGlb(const Drawing& drawing, const std::string& path) {
  const auto scene = makeAssimpScene(drawing);
  Glb glb = splitGlb(exportByAssimp(*scene, "glb2", path));
  addExtras(drawing, glb.json);
  writeMaterials(glb.json);
  removeEmptyLists(glb.json);
  return glb;
}

}  // namespace

OutputFiles glbFiles(const Drawing& drawing, const std::string& path) {
  return {{path, joinGlb(makeGlb(drawing, path))}};
}

OutputFiles gltfFiles(const Drawing& drawing, const std::string& path) {
  Glb glb = makeGlb(drawing, path);
  if (!glb.binary.empty()) glb.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(glb.binary);
  return {{path, glb.json.dump(1) + '\n'}};
}

}  // namespace lintel
