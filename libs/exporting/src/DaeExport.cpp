// SPDX-License-Identifier: BSD-3-Clause
#include "AssimpScene.h"
#include "Writers.h"

// Collada by assimp, without the time of day that it writes.
namespace lintel {

namespace {

/// Replaces what stands between `<tag>` and `</tag>` wherever it occurs.
void replaceBetween(std::string& text, const std::string& tag, const std::string& content) {
  const std::string open = "<" + tag + ">", close = "</" + tag + ">";
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const std::size_t from = at + open.size(), to = text.find(close, from);
    if (to != std::string::npos) text.replace(from, to - from, content);
  }
}

}  // namespace

OutputFiles daeFiles(const Drawing& drawing, const std::string& path) {
  std::string text = exportByAssimp(*makeAssimpScene(drawing), "collada", path);
  for (const char* tag : {"created", "modified"}) replaceBetween(text, tag, "2000-01-01T00:00:00");
  return {{path, std::move(text)}};
}

}  // namespace lintel
