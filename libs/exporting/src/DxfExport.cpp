// SPDX-License-Identifier: BSD-3-Clause
#include <dxflib/dl_dxf.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "Writers.h"

// DXF R12, the form every CAD program reads: lines and points on a layer for each part.
namespace lintel {

namespace {

/// A file in memory with a name: dxflib writes only to named files and does not notice a full disk.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("lintel", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw ExportError("no memory for a drawing; free some");
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  std::string content() const {
    const off_t size = ::lseek(descriptor_, 0, SEEK_END);
    std::string bytes(static_cast<std::size_t>(std::max<off_t>(size, 0)), '\0');
    std::size_t have = 0;
    while (have < bytes.size()) {
      const ssize_t taken = ::pread(descriptor_, bytes.data() + have, bytes.size() - have, static_cast<off_t>(have));
      if (taken <= 0) throw ExportError("a drawing in memory cannot be read back");
      have += static_cast<std::size_t>(taken);
    }
    return bytes;
  }

 private:
  int descriptor_;
};

/// The nearest of AutoCAD's indexed colours: 24 hues from 10 (red) on in steps of ten, 8 and 9 greys.
int colourIndex(Rgb c) {
  const int high = std::max({c.r, c.g, c.b}), low = std::min({c.r, c.g, c.b}), range = high - low;
  if (range < high / 4 + 1) return high < 160 ? 8 : 9;
  double hue = 0;  // in sixths of the circle
  if (high == c.r) {
    hue = static_cast<double>(c.g - c.b) / range;
  } else if (high == c.g) {
    hue = 2 + static_cast<double>(c.b - c.r) / range;
  } else {
    hue = 4 + static_cast<double>(c.r - c.g) / range;
  }
  return 10 + 10 * ((static_cast<int>(std::lround(hue * 4)) + 24) % 24);
}

std::string layerName(const DrawnPart& part) {
  std::string name = part.name;
  for (char& c : name) c = c == ' ' || c == '.' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

void writeTables(const Drawing& drawing, DL_Dxf& dxf, DL_WriterA& out) {
  out.sectionTables();
  out.tableLinetypes(1);
  dxf.writeLinetype(out, DL_LinetypeData("CONTINUOUS", "Solid line", 0, 0, 0.0));
  out.tableEnd();
  out.tableLayers(static_cast<int>(drawing.parts.size()) + 1);
  dxf.writeLayer(out, DL_LayerData("0", 0), DL_Attributes("", 7, 0, "CONTINUOUS", 1.0));
  for (const DrawnPart& part : drawing.parts) {
    const Rgb colour = part.segments.empty() ? part.points.front().colour : part.segments.front().colour;
    dxf.writeLayer(out, DL_LayerData(layerName(part), 0), DL_Attributes("", colourIndex(colour), 0, "CONTINUOUS", 1.0));
  }
  out.tableEnd();
  out.sectionEnd();
}

void writeEntities(const Drawing& drawing, DL_Dxf& dxf, DL_WriterA& out) {
  out.sectionEntities();
  for (const DrawnPart& part : drawing.parts) {
    const std::string layer = layerName(part);
    for (const DrawnSegment& s : part.segments) {
      dxf.writeLine(out, DL_LineData(s.start.x(), s.start.y(), s.start.z(), s.end.x(), s.end.y(), s.end.z()),
                    DL_Attributes(layer, colourIndex(s.colour), 0, "CONTINUOUS", 1.0));
    }
    for (const DrawnPoint& p : part.points) {
      dxf.writePoint(out, DL_PointData(p.p.x(), p.p.y(), p.p.z()),
                     DL_Attributes(layer, colourIndex(p.colour), 0, "CONTINUOUS", 1.0));
    }
  }
  out.sectionEnd();
}

}  // namespace

OutputFiles dxfFiles(const Drawing& drawing, const std::string& path) {
  const MemoryFile memory;
  DL_Dxf dxf;
  const std::unique_ptr<DL_WriterA> out(dxf.out(memory.name().c_str(), DL_Codes::AC1009));
  if (!out) throw ExportError(path + ": dxflib cannot begin a drawing; is /proc there?");
  out->sectionHeader();
  out->dxfString(9, "$ACADVER");
  out->dxfString(1, "AC1009");
  out->sectionEnd();
  writeTables(drawing, dxf, *out);
  writeEntities(drawing, dxf, *out);
  out->dxfEOF();
  out->close();
  std::string bytes = memory.content();
  const std::string_view tail = std::string_view(bytes).substr(bytes.size() - std::min<std::size_t>(bytes.size(), 8));
  if (tail.find("EOF") == std::string_view::npos) throw ExportError(path + ": dxflib broke off; is memory full?");
  return {{path, std::move(bytes)}};
}

}  // namespace lintel
