// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "Drawing.h"

namespace lintel {

/// A file to be written: made in memory first, so that every form is written, checked and renamed the same way.
struct OutputFile {
  std::string path;
  std::string bytes;
};
using OutputFiles = std::vector<OutputFile>;

// One writer per form, each in a file of its name. The first file has the name `path`; others stand beside it.
// Throw ExportError for errors of their form.
OutputFiles csvFiles(const Drawing& drawing, const std::string& path);        // table of lines
OutputFiles jsonFiles(const Drawing& drawing, const std::string& path);       // the full data
OutputFiles objFiles(const Drawing& drawing, const std::string& path);        // with .mtl
OutputFiles plyFiles(const Drawing& drawing, const std::string& path);        // ASCII
OutputFiles glbFiles(const Drawing& drawing, const std::string& path);        // glTF 2, binary
OutputFiles gltfFiles(const Drawing& drawing, const std::string& path);       // glTF 2, text with the data inside
OutputFiles daeFiles(const Drawing& drawing, const std::string& path);        // Collada
OutputFiles x3dFiles(const Drawing& drawing, const std::string& path);        // X3D
OutputFiles sceneFiles(const Drawing& drawing, const std::string& path);      // MRPT COpenGLScene
OutputFiles simplemapFiles(const Drawing& drawing, const std::string& path);  // MRPT CSimpleMap: keyframes
OutputFiles dxfFiles(const Drawing& drawing, const std::string& path);        // CAD, lines on layers
OutputFiles pngFiles(const Drawing& drawing, const std::string& path);        // picture of three views
OutputFiles htmlFiles(const Drawing& drawing, const std::string& path);       // page that shows the map in a browser
OutputFiles tumFiles(const Drawing& drawing, const std::string& path);        // trajectory alone, as TUM's text
OutputFiles kittiFiles(const Drawing& drawing, const std::string& path);      // trajectory alone, as KITTI's matrices
OutputFiles eurocFiles(const Drawing& drawing, const std::string& path);      // trajectory alone, as EuRoC's states

// Of folders: `path` is the folder, which holds all files.
OutputFiles colmapFiles(const Drawing& drawing, const std::string& path);      // COLMAP's sparse model, binary
OutputFiles colmapTextFiles(const Drawing& drawing, const std::string& path);  // the same as text

}  // namespace lintel
