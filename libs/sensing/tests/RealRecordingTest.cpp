// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdlib>

#include "TinyEuroc.h"
#include "lintel/sensing/EurocToRawlog.h"

namespace lintel::test {
namespace {

std::string realRecording() {
  const char* folder = std::getenv("LINTEL_TEST_DATA");
  return std::string(folder ? folder : LINTEL_SOURCE_DIR "/../shared/data") + "/MH_01_easy_16s";
}

TEST(RealRecordingTest, BothRoutesGiveTheSame) {
  const std::string root = realRecording();
  if (!std::filesystem::exists(root)) GTEST_SKIP() << root << " is absent; set LINTEL_TEST_DATA";
  const TempFolder folder;
  const std::string rawlog = folder / "real.rawlog";
  eurocToRawlog(root, rawlog);
  const auto direct = openRecording(root), through = openRecording(rawlog);
  EXPECT_EQ(direct->expectedFrames(), 320u);
  expectSameRig(direct->rig(), through->rig());
  std::size_t frames = 0;
  for (;; ++frames) {  // step by step: the images of the whole recording are 115 MB
    const auto a = direct->next(), b = through->next();
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) break;
    expectSameSteps({*a}, {*b});
    ASSERT_EQ(a->imu.size(), frames == 0 ? 101u : 11u);
  }
  EXPECT_EQ(frames, 320u);
  EXPECT_TRUE(direct->warnings().empty());
  EXPECT_TRUE(through->warnings().empty());
}

}  // namespace
}  // namespace lintel::test
