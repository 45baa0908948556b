// SPDX-License-Identifier: BSD-3-Clause
#include "Text.h"
#include "Writers.h"

// The trajectory of a map alone, as evaluation tools read it: T_w_b of every frame, metres.
namespace lintel {

namespace {

using StampedPose = std::pair<std::int64_t, Pose>;

template <class Row>
OutputFiles rows(const Drawing& drawing, const std::string& path, const char* head, const Row& row) {
  Text text;
  text << head;
  for (const StampedPose& stamped : drawing.map->trajectory) {
    if (!drawable(stamped.second)) continue;
    row(stamped, text);
    text << '\n';
  }
  return {{path, std::move(text.bytes())}};
}

}  // namespace

OutputFiles tumFiles(const Drawing& drawing, const std::string& path) {
  return rows(drawing, path, "", [](const StampedPose& stamped, Text& text) {
    const Eigen::Quaterniond& q = stamped.second.q;
    text.seconds(stamped.first) << ' ';
    text.vector(stamped.second.p) << ' ';
    text.vector(q.vec()) << ' ' << q.w();
  });
}

OutputFiles kittiFiles(const Drawing& drawing, const std::string& path) {
  return rows(drawing, path, "", [](const StampedPose& stamped, Text& text) {
    const Eigen::Matrix3d R_w_b = stamped.second.q.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      text << (row > 0 ? " " : "");
      text.vector(R_w_b.row(row)) << ' ' << stamped.second.p[row];
    }
  });
}

OutputFiles eurocFiles(const Drawing& drawing, const std::string& path) {
  constexpr const char* kHead =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n";
  return rows(drawing, path, kHead, [](const StampedPose& stamped, Text& text) {
    const auto& [p, q] = std::pair(stamped.second.p, stamped.second.q);
    text << stamped.first;
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) text << ',' << value;
  });
}

}  // namespace lintel
