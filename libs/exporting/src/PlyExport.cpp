// SPDX-License-Identifier: BSD-3-Clause
#include "Text.h"
#include "Tube.h"
#include "Writers.h"

namespace lintel {

namespace {

/// Vertices and elements of an ASCII PLY. Tubes: 8 vertices each (Tube.h), lines in the drawing's order first.
/// Lines: vertices by two with `edge` elements.
class PlyWriter {
 public:
  explicit PlyWriter(const Drawing& drawing) : drawing_(drawing) {
    const bool tubes = drawing.style == LineStyle::kTubes;
    for (const DrawnPart& part : drawing_.parts) {
      for (const DrawnSegment& s : part.segments) tubes ? addTube(s) : addEdge(s);
      for (const DrawnPoint& p : part.points) tubes ? addTetrahedron(p) : vertex(p.p.cast<float>().eval(), p.colour);
    }
  }

  std::string write() {
    Text text;
    text << "ply\nformat ascii 1.0\ncomment Line map made by Lintel; world [m], z up\n";
    if (drawing_.style == LineStyle::kTubes) {
      text << "comment tubes of 8 vertices: the mean of the first four is one end of a line, of the last four the "
              "other\n";
    }
    text << "element vertex " << vertex_count_
         << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
            "green\nproperty uchar blue\n";
    if (edge_count_ == 0) text << "element face " << face_count_ << "\nproperty list uchar int vertex_indices\n";
    if (edge_count_ > 0)
      text << "element edge " << edge_count_
           << "\nproperty int vertex1\nproperty int vertex2\nproperty uchar red\nproperty uchar green\nproperty uchar "
              "blue\n";
    text << "end_header\n" << vertices_.bytes() << elements_.bytes();
    return std::move(text.bytes());
  }

 private:
  void vertex(const Eigen::Vector3f& p, Rgb c) {
    vertices_.vector(p) << ' ' << int{c.r} << ' ' << int{c.g} << ' ' << int{c.b} << '\n';
    ++vertex_count_;
  }

  template <class Corners, class Triangles>
  void body(const Corners& corners, const Triangles& triangles, Rgb colour) {
    const std::uint64_t base = vertex_count_;
    for (const Eigen::Vector3d& corner : corners) vertex(corner.cast<float>().eval(), colour);
    for (const auto& [a, b, c] : triangles) elements_ << "3 " << base + a << ' ' << base + b << ' ' << base + c << '\n';
    face_count_ += triangles.size();
  }

  void addTube(const DrawnSegment& s) {
    if (const auto tube = makeTube(s.start, s.end, drawing_.radiusOf(s))) body(tube->corners, kTubeTriangles, s.colour);
  }

  void addTetrahedron(const DrawnPoint& p) {
    if (const auto corners = makeTetrahedron(p.p, drawing_.radius_m)) body(*corners, kTetrahedronTriangles, p.colour);
  }

  void addEdge(const DrawnSegment& s) {
    const Rgb c = s.colour;
    elements_ << vertex_count_ << ' ' << vertex_count_ + 1 << ' ' << int{c.r} << ' ' << int{c.g} << ' ' << int{c.b}
              << '\n';
    vertex(s.start.cast<float>().eval(), c), vertex(s.end.cast<float>().eval(), c);
    ++edge_count_;
  }

  const Drawing& drawing_;
  Text vertices_, elements_;
  std::uint64_t vertex_count_ = 0, face_count_ = 0, edge_count_ = 0;
};

}  // namespace

OutputFiles plyFiles(const Drawing& drawing, const std::string& path) { return {{path, PlyWriter(drawing).write()}}; }

}  // namespace lintel
