// SPDX-License-Identifier: BSD-3-Clause
#include "Text.h"
#include "Writers.h"

namespace lintel {

OutputFiles csvFiles(const Drawing& drawing, const std::string& path) {
  const GroupNames names(*drawing.map);
  Text text;
  text
      << "id,x0,y0,z0,x1,y1,z1,observations,first_s,last_s,sigma_direction_rad,sigma_distance_m,degenerate,constrained,"
         "group,group_name,source\n";
  for (const MapLine* line : drawing.lines) {
    const auto& [a, b] = line->segment_w;
    text << line->id;
    for (const double v : {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}) text << ',' << v;
    text << ',' << static_cast<std::uint64_t>(line->observations.size()) << ',';
    text.seconds(line->first_t_ns) << ',';
    text.seconds(line->last_t_ns) << ',' << line->sigma_direction_rad << ',' << line->sigma_distance_m << ','
                                  << (line->degenerate ? 1 : 0) << ',' << (line->constrained ? 1 : 0) << ','
                                  << line->group << ',' << names(line->group) << ','
                                  << (line->mapped ? "mapped" : "tracked") << '\n';
  }
  return {{path, std::move(text.bytes())}};
}

}  // namespace lintel
