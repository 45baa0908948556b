// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>

#include "Text.h"
#include "Tube.h"
#include "Writers.h"

// X3D written here: assimp's own writer puts lines into face sets, which no viewer shows.
namespace lintel {

namespace {

/// Vertices, their colours and elements of one shape, as X3D lists them.
struct X3dShape {
  Text indices, coordinates, colours;
  std::uint64_t count = 0;

  void vertex(const Eigen::Vector3d& p, Rgb c) {
    coordinates.vector(p.cast<float>().eval()) << ' ';
    colours << static_cast<float>(c.r) / 255 << ' ' << static_cast<float>(c.g) / 255 << ' '
            << static_cast<float>(c.b) / 255 << ' ';
    ++count;
  }
  void stroke(const DrawnSegment& s) {
    indices << count << ' ' << count + 1 << " -1 ";
    vertex(s.start, s.colour), vertex(s.end, s.colour);
  }
  void tube(const Tube& tube, Rgb colour) {
    for (const auto& [a, b, c] : kTubeTriangles) indices << count + a << ' ' << count + b << ' ' << count + c << " -1 ";
    for (const Eigen::Vector3d& corner : tube.corners) vertex(corner, colour);
  }
};

void writeShape(std::string_view geometry, std::string_view fields, X3dShape& shape, bool lit, Text& text) {
  if (shape.count == 0) return;
  text << "<Shape><Appearance><Material " << (lit ? "ambientIntensity='0.4'" : "emissiveColor='1 1 1'")
       << "/></Appearance>\n<" << geometry << fields;
  if (!shape.indices.bytes().empty()) text << " coordIndex='" << shape.indices.bytes() << '\'';
  text << ">\n<Coordinate point='" << shape.coordinates.bytes() << "'/>\n<Color color='" << shape.colours.bytes()
       << "'/>\n</" << geometry << "></Shape>\n";
}

void writePart(const Drawing& drawing, const DrawnPart& part, Text& text) {
  std::string name = part.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  text << "<Group DEF='" << name << "'>\n";
  X3dShape shape, points;
  const bool tubes = drawing.style == LineStyle::kTubes;
  for (const DrawnSegment& s : part.segments) {
    if (!tubes) {
      shape.stroke(s);
    } else if (const auto tube = makeTube(s.start, s.end, drawing.radiusOf(s))) {
      shape.tube(*tube, s.colour);
    }
  }
  for (const DrawnPoint& p : part.points) points.vertex(p.p, p.colour);
  writeShape(tubes ? "IndexedFaceSet" : "IndexedLineSet", tubes ? " creaseAngle='0'" : "", shape, tubes, text);
  writeShape("PointSet", "", points, false, text);
  text << "</Group>\n";
}

}  // namespace

OutputFiles x3dFiles(const Drawing& drawing, const std::string& path) {
  Text text;
  text << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<!DOCTYPE X3D PUBLIC \"ISO//Web3D//DTD X3D 3.3//EN\" \"http://www.web3d.org/specifications/x3d-3.3.dtd\">\n"
          "<X3D profile='Interchange' version='3.3'>\n<head>\n<meta name='generator' content='Lintel'/>\n"
          "<meta name='description' content='Line map; world, z up, below the node Map'/>\n</head>\n<Scene>\n"
          "<Transform DEF='Map' rotation='1 0 0 -1.5707963267948966'>\n";  // z up to y up
  for (const DrawnPart& part : drawing.parts) writePart(drawing, part, text);
  text << "</Transform>\n</Scene>\n</X3D>\n";
  return {{path, std::move(text.bytes())}};
}

}  // namespace lintel
