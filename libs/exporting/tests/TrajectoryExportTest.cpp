// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "Files.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

class TrajectoryExport : public FolderTest {
 protected:
  /// A pose turned half about z, and a pose that is not finite.
  static LineMap map() {
    LineMap map;
    Pose pose;
    pose.p = {1, 2.5, -3};
    pose.q = Eigen::Quaterniond(0, 0, 0, 1);
    map.trajectory.emplace_back(1403636579763555500, pose);
    pose.p.x() = std::numeric_limits<double>::quiet_NaN();
    map.trajectory.emplace_back(1403636579813555500, pose);
    return map;
  }
};

TEST_F(TrajectoryExport, FormsAreAsTheirToolsReadThem) {
  const LineMap one = map();
  exportMap(one, in("way.tum"));
  exportMap(one, in("way.kitti"));
  exportMap(one, in("way.euroc"));
  EXPECT_EQ(content(in("way.tum")), "1403636579.763555500 1 2.5 -3 0 0 1 0\n");
  EXPECT_EQ(content(in("way.kitti")), "-1 0 0 1 0 -1 0 2.5 0 0 1 -3\n");
  EXPECT_EQ(content(in("way.euroc")),
            "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"
            "1403636579763555500,1,2.5,-3,0,0,0,1\n");
}

}  // namespace
}  // namespace lintel
