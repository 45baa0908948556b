// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/AtomicFile.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace lintel {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("lintel_atomic_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
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
  EXPECT_EQ(content(in("a")), big + "end");
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStaysAndNothingElse) {
  AtomicFile::writeWhole(in("a"), "old");
  {
    AtomicFile file(in("a"));
    file.write("new");
  }
  EXPECT_EQ(content(in("a")), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(AtomicFileTest, FollowsALinkAndReportsAFullDevice) {
  AtomicFile::writeWhole(in("real"), "old");
  fs::create_symlink(in("real"), in("link"));
  AtomicFile::writeWhole(in("link"), "new");
  EXPECT_TRUE(fs::is_symlink(in("link")));
  EXPECT_EQ(content(in("real")), "new");
  fs::create_symlink("/dev/full", in("full"));
  EXPECT_THROW(AtomicFile::writeWhole(in("full"), "x"), FileWriteError);
  EXPECT_THROW(AtomicFile::writeWhole("", "x"), FileWriteError);
  EXPECT_THROW(AtomicFile::writeWhole(in("no/such"), "x"), FileWriteError);
}

}  // namespace
}  // namespace lintel
