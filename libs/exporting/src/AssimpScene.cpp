// SPDX-License-Identifier: BSD-3-Clause
#include "AssimpScene.h"

#include <assimp/material.h>
#include <assimp/Exporter.hpp>

#include <map>
#include <vector>

#include "Tube.h"

namespace lintel {

namespace {

/// Vertices and faces of a mesh to be.
struct MeshParts {
  std::string name;
  unsigned indices_per_face = 2;  // 1 points, 2 lines, 3 triangles
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Rgb> colours;  // of the vertices
  std::vector<std::uint32_t> indices;

  void body(const Eigen::Vector3d* corners, std::size_t count, Rgb c, const std::uint32_t* triangles,
            std::size_t triangle_indices) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (std::size_t i = 0; i < count; ++i) vertices.push_back(corners[i].cast<float>()), colours.push_back(c);
    for (std::size_t i = 0; i < triangle_indices; ++i) indices.push_back(base + triangles[i]);
  }

  void add(const DrawnSegment& s, const Drawing& drawing) {
    if (drawing.style == LineStyle::kTubes) {
      indices_per_face = 3;
      const auto tube = makeTube(s.start, s.end, drawing.radiusOf(s));
      if (tube) body(tube->corners.data(), 8, s.colour, kTubeTriangles[0].data(), 3 * kTubeTriangles.size());
      return;
    }
    const Eigen::Vector3d ends[2] = {s.start, s.end};
    constexpr std::uint32_t both[2] = {0, 1};
    body(ends, 2, s.colour, both, 2);
  }

  void add(const DrawnPoint& p, const Drawing&) {
    indices_per_face = 1;
    constexpr std::uint32_t one[1] = {0};
    body(&p.p, 1, p.colour, one, 1);
  }
};

aiMesh* makeMesh(const MeshParts& parts, unsigned material) {
  auto* mesh = new aiMesh;
  mesh->mName = parts.name;
  mesh->mMaterialIndex = material;
  mesh->mPrimitiveTypes = parts.indices_per_face == 1   ? aiPrimitiveType_POINT
                          : parts.indices_per_face == 2 ? aiPrimitiveType_LINE
                                                        : aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = static_cast<unsigned>(parts.vertices.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  mesh->mColors[0] = new aiColor4D[mesh->mNumVertices];
  for (unsigned i = 0; i < mesh->mNumVertices; ++i) {
    const Eigen::Vector3f& v = parts.vertices[i];
    const Rgb c = parts.colours[i];
    mesh->mVertices[i] = {v.x(), v.y(), v.z()};
    mesh->mColors[0][i] = {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
                           1};
  }
  const unsigned n = parts.indices_per_face;
  mesh->mNumFaces = static_cast<unsigned>(parts.indices.size()) / n;
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
    mesh->mFaces[f].mNumIndices = n;
    mesh->mFaces[f].mIndices = new unsigned[n];
    for (unsigned i = 0; i < n; ++i) mesh->mFaces[f].mIndices[i] = parts.indices[f * n + i];
  }
  return mesh;
}

/// White, as the vertices bring the colour: for strokes unlit, for tubes dull.
aiMaterial* makeMaterial(bool unlit) {
  auto* material = new aiMaterial;
  const aiString material_name(unlit ? "Strokes" : "Tubes");
  const aiColor3D white(1, 1, 1), black(0, 0, 0);
  const aiColor4D base(1, 1, 1, 1);
  const float rough = 0.9F, metallic = 0;
  material->AddProperty(&material_name, AI_MATKEY_NAME);
  material->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
  material->AddProperty(&black, 1, AI_MATKEY_COLOR_SPECULAR);
  material->AddProperty(&black, 1, AI_MATKEY_COLOR_AMBIENT);
  // Strokes have no normals: a viewer without "unlit" shows at least what they emit.
  material->AddProperty(unlit ? &white : &black, 1, AI_MATKEY_COLOR_EMISSIVE);
  material->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
  material->AddProperty(&rough, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  material->AddProperty(&metallic, 1, AI_MATKEY_METALLIC_FACTOR);
  const int shading = unlit ? aiShadingMode_Unlit : aiShadingMode_Gouraud;
  material->AddProperty(&shading, 1, AI_MATKEY_SHADING_MODEL);
  return material;
}

/// Collects nodes, meshes and materials; hands them to an aiScene at the end.
class SceneBuilder {
 public:
  explicit SceneBuilder(const Drawing& drawing) : drawing_(drawing) {}

  std::unique_ptr<aiScene> build() {
    auto scene = std::make_unique<aiScene>();
    auto* root = new aiNode("Map");
    root->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);  // z up to y up, exactly
    scene->mRootNode = root;
    addLines(*root);
    for (const DrawnPart& part : drawing_.parts) {
      if (part.layer != MapLayer::kLines) addPart(part, *root);
    }
    if (materials_.empty()) materialOf(true);  // assimp needs one even for an empty map
    scene->mNumMeshes = static_cast<unsigned>(meshes_.size());
    scene->mMeshes = meshes_.empty() ? nullptr : new aiMesh*[meshes_.size()];
    std::copy(meshes_.begin(), meshes_.end(), scene->mMeshes);
    scene->mNumMaterials = static_cast<unsigned>(materials_.size());
    scene->mMaterials = new aiMaterial*[materials_.size()];
    std::copy(materials_.begin(), materials_.end(), scene->mMaterials);
    if (meshes_.empty()) scene->mFlags |= AI_SCENE_FLAGS_INCOMPLETE;
    return scene;
  }

 private:
  static aiNode* addNode(const std::string& name, aiNode& parent) {
    auto* node = new aiNode(name);
    parent.addChildren(1, &node);
    return node;
  }

  void addLines(aiNode& root) {
    aiNode* lines = nullptr;  // a node without anything is not good style in glTF
    for (const DrawnPart& part : drawing_.parts) {
      if (part.layer != MapLayer::kLines) continue;
      if (!lines) lines = addNode("Lines", root);
      addPart(part, *lines);
    }
  }

  void addPart(const DrawnPart& part, aiNode& parent) {
    MeshParts parts;
    parts.name = part.name;
    for (const DrawnSegment& s : part.segments) parts.add(s, drawing_);
    for (const DrawnPoint& p : part.points) parts.add(p, drawing_);
    aiNode* node = addNode(part.name, parent);
    if (parts.indices.empty()) return;  // every tube too thin for single precision
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{static_cast<unsigned>(meshes_.size())};
    meshes_.push_back(makeMesh(parts, materialOf(parts.indices_per_face != 3)));
  }

  unsigned materialOf(bool unlit) {
    const auto [entry, is_new] = known_.try_emplace(unlit, static_cast<unsigned>(materials_.size()));
    if (is_new) materials_.push_back(makeMaterial(unlit));
    return entry->second;
  }

  const Drawing& drawing_;
  std::vector<aiMesh*> meshes_;
  std::vector<aiMaterial*> materials_;
  std::map<bool, unsigned> known_;
};

}  // namespace

std::unique_ptr<aiScene> makeAssimpScene(const Drawing& drawing) { return SceneBuilder(drawing).build(); }

std::string exportByAssimp(const aiScene& scene, const std::string& format, const std::string& path) {
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, format);
  if (!blob) throw ExportError(path + ": assimp cannot make it: " + exporter.GetErrorString());
  return {static_cast<const char*>(blob->data), blob->size};
}

}  // namespace lintel
