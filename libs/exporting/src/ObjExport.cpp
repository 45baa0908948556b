// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <map>

#include "Text.h"
#include "Tube.h"
#include "Writers.h"

namespace lintel {

namespace {

/// Writes an OBJ whose elements `l` hold every segment exactly and whose faces, if any, are its tube. Ends of all `l`
/// come first: MeshLab 2020.09 ends on faces that use vertex 1.
class ObjWriter {
 public:
  explicit ObjWriter(const Drawing& drawing) : drawing_(drawing) {}

  std::string write(const std::string& material_file) {
    text_ << "# Line map made by Lintel; world [m], z up\nmtllib " << material_file << '\n';
    for (const DrawnPart& part : drawing_.parts) {
      for (const DrawnSegment& s : part.segments) vertex(s.start, s.colour), vertex(s.end, s.colour);
      for (const DrawnPoint& p : part.points) vertex(p.p, p.colour);
    }
    std::uint64_t first = 1;
    for (const DrawnPart& part : drawing_.parts) {
      writePart(part, first);
      first += 2 * part.segments.size() + part.points.size();
    }
    return std::move(text_.bytes());
  }

  std::string materials() const {
    Text text;
    text << "# Colours of a line map made by Lintel\n";
    for (const auto& [colour, name] : materials_) {
      const float r = static_cast<float>(colour.r) / 255, g = static_cast<float>(colour.g) / 255,
                  b = static_cast<float>(colour.b) / 255;
      text << "newmtl " << name << "\nKa 0 0 0\nKd " << r << ' ' << g << ' ' << b << "\nKs 0 0 0\nd 1\nillum 1\n";
    }
    return std::move(text.bytes());
  }

 private:
  template <class Vector>
  void vertex(const Vector& p, Rgb c) {
    text_ << "v ";
    text_.vector(p) << ' ' << static_cast<float>(c.r) / 255 << ' ' << static_cast<float>(c.g) / 255 << ' '
                    << static_cast<float>(c.b) / 255 << '\n';
    ++vertices_;
  }

  void useMaterial(Rgb colour) {
    if (used_ && colour == last_colour_) return;
    used_ = true, last_colour_ = colour;
    auto& name = materials_[colour];
    if (name.empty()) {
      constexpr char digits[] = "0123456789abcdef";
      name = "colour_";
      for (int shift = 20; shift >= 0; shift -= 4) name.push_back(digits[colour.packed() >> shift & 15]);
    }
    text_ << "usemtl " << name << '\n';
  }

  static std::string objectName(const DrawnPart& part) {
    std::string name = part.name;
    for (char& c : name) c = c == ' ' ? '_' : c;
    return name;
  }

  void writePart(const DrawnPart& part, std::uint64_t first) {
    text_ << "o " << objectName(part) << '\n';
    used_ = false;
    std::uint64_t v = first;
    for (const DrawnSegment& s : part.segments)
      useMaterial(s.colour), text_ << "l " << v << ' ' << v + 1 << '\n', v += 2;
    for (const DrawnPoint& p : part.points) useMaterial(p.colour), text_ << "p " << v++ << '\n';
    if (drawing_.style != LineStyle::kTubes) return;
    text_ << "o " << objectName(part) << (part.points.empty() ? "_tubes\n" : "_bodies\n");
    used_ = false;
    for (const DrawnSegment& s : part.segments) {
      if (const auto tube = makeTube(s.start, s.end, drawing_.radiusOf(s)))
        body(tube->corners, kTubeTriangles, s.colour);
    }
    for (const DrawnPoint& p : part.points) {
      if (const auto corners = makeTetrahedron(p.p, drawing_.radius_m)) body(*corners, kTetrahedronTriangles, p.colour);
    }
  }

  template <class Corners, class Triangles>
  void body(const Corners& corners, const Triangles& triangles, Rgb colour) {
    useMaterial(colour);
    const std::uint64_t base = vertices_ + 1;
    for (const Eigen::Vector3d& corner : corners) vertex(corner.cast<float>().eval(), colour);
    for (const auto& [a, b, c] : triangles) text_ << "f " << base + a << ' ' << base + b << ' ' << base + c << '\n';
  }

  const Drawing& drawing_;
  Text text_;
  std::uint64_t vertices_ = 0;
  std::map<Rgb, std::string> materials_;
  Rgb last_colour_;
  bool used_ = false;
};

}  // namespace

OutputFiles objFiles(const Drawing& drawing, const std::string& path) {
  // A library's name in OBJ ends at a blank for some readers.
  std::filesystem::path material_path = std::filesystem::path(path).replace_extension(".mtl");
  std::string material_name = material_path.filename().string();
  for (char& c : material_name) c = c == ' ' || c == '\t' ? '_' : c;
  material_path.replace_filename(material_name);
  ObjWriter writer(drawing);
  std::string obj = writer.write(material_name);
  return {{path, std::move(obj)}, {material_path.string(), writer.materials()}};
}

}  // namespace lintel
