// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <string>
#include <vector>

#include "lintel/geometry/Segment.h"

namespace lintel {

/// What a file holds as seen by assimp, node transformations applied.
struct Reimported {
  std::string error;
  std::vector<Segment3> segments;  ///< of line elements
  std::vector<Segment3> tubes;     ///< axes of bodies of 8 vertices that follow each other
  std::vector<Eigen::Vector3d> points;
  std::vector<std::string> nodes;
  std::size_t triangles = 0;
};

inline Eigen::Vector3d vertexOf(const aiMesh& mesh, unsigned i, const aiMatrix4x4& T) {
  const aiVector3D v = T * mesh.mVertices[i];
  return {v.x, v.y, v.z};
}

inline void collect(const aiMesh& mesh, const aiMatrix4x4& T, Reimported& out) {
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices == 1) out.points.push_back(vertexOf(mesh, face.mIndices[0], T));
    if (face.mNumIndices == 2)
      out.segments.push_back({vertexOf(mesh, face.mIndices[0], T), vertexOf(mesh, face.mIndices[1], T)});
    if (face.mNumIndices == 3) ++out.triangles;
  }
  if (!(mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) || mesh.mNumVertices % 8 != 0) return;
  for (unsigned base = 0; base + 8 <= mesh.mNumVertices; base += 8) {
    Segment3 axis;
    for (unsigned i = 0; i < 4; ++i)
      axis.start += 0.25 * vertexOf(mesh, base + i, T), axis.end += 0.25 * vertexOf(mesh, base + 4 + i, T);
    out.tubes.push_back(axis);
  }
}

inline void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, Reimported& out) {
  const aiMatrix4x4 T = parent * node.mTransformation;
  out.nodes.emplace_back(node.mName.C_Str());
  for (unsigned i = 0; i < node.mNumMeshes; ++i) collect(*scene.mMeshes[node.mMeshes[i]], T, out);
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], T, out);
}

inline Reimported reimport(const std::string& path) {
  Reimported out;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (!scene || !scene->mRootNode) {
    out.error = std::string("assimp: ") + importer.GetErrorString();
    return out;
  }
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), out);
  return out;
}

}  // namespace lintel
