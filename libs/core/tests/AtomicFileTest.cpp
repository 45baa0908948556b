// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/AtomicFile.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_ / name; }

  test::TempFolder folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
  const std::string big(3 << 20, 'x');
  {
    AtomicFile file(in("a"));
    file.write(big);
    EXPECT_FALSE(fs::exists(in("a")));
    file.write("end");
    file.commit();
  }
  EXPECT_EQ(test::bytesOf(in("a")), big + "end");
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStaysAndNothingElse) {
  AtomicFile::writeWhole(in("a"), "old");
  {
    AtomicFile file(in("a"));
    file.write("new");
  }
  EXPECT_EQ(test::bytesOf(in("a")), "old");
  EXPECT_EQ(folder_.entries(), 1);
}

TEST_F(AtomicFileTest, FollowsALinkAndReportsAFullDevice) {
  AtomicFile::writeWhole(in("real"), "old");
  fs::create_symlink(in("real"), in("link"));
  AtomicFile::writeWhole(in("link"), "new");
  EXPECT_TRUE(fs::is_symlink(in("link")));
  EXPECT_EQ(test::bytesOf(in("real")), "new");
  fs::create_symlink("/dev/full", in("full"));
  EXPECT_THROW(AtomicFile::writeWhole(in("full"), "x"), FileWriteError);
  EXPECT_THROW(AtomicFile::writeWhole("", "x"), FileWriteError);
  EXPECT_THROW(AtomicFile::writeWhole(in("no/such"), "x"), FileWriteError);
}

}  // namespace
}  // namespace lintel
