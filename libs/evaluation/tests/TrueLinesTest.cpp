// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrueLines.h"

#include <gmock/gmock.h>

#include "TestFiles.h"
#include "lintel/evaluation/TrajectoryFile.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class TrueLines : public test::TestFiles {};

constexpr const char* kHeader = "#id,x0 [m],y0 [m],z0 [m],x1 [m],y1 [m],z1 [m],direction_group,kind,frames_seen\n";

TEST_F(TrueLines, ReadsColumnsByName) {
  const auto lines = readTrueLines(write("a.csv", std::string(kHeader) + "7,1,2,3,4,5,6,0,wall,61\n"
                                                                         "8,1,1,1,1,1,1,0,point,99\n"));
  ASSERT_EQ(lines.size(), 1u);  // the second has no length
  EXPECT_EQ(lines[0].segment_w.start, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(lines[0].segment_w.end, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(lines[0].frames_seen, 61);
}

TEST_F(TrueLines, WithoutFramesSeenEveryLineCounts) {
  EXPECT_GE(readTrueLines(write("a.csv", "z1,y1,x1,z0,y0,x0\n6,5,4,3,2,1\n")).at(0).frames_seen, 1000000);
}

TEST_F(TrueLines, NamesTheLineOfAFault) {
  const auto complaint = [&](const std::string& text) {
    const std::string file = write("a.csv", text);
    try {
      readTrueLines(file);
    } catch (const EvaluationError& error) {
      return std::string(error.what()).substr(file.size());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(complaint("x0,y0,z0,x1,y1\n"), StartsWith(":1: the header names no column 'z1'"));
  EXPECT_THAT(complaint(std::string(kHeader) + "7,1,2,3,4,5\n"), StartsWith(":2: column 7 is missing"));
  EXPECT_THAT(complaint(std::string(kHeader) + "7,1,2,3,4,five,6,0,wall,61\n"), StartsWith(":2: column 6 should be"));
  EXPECT_THAT(complaint(kHeader), HasSubstr("holds no lines"));
  EXPECT_THAT(complaint(""), HasSubstr("is empty"));
}

}  // namespace
}  // namespace lintel
