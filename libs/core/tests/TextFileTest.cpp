// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/TextFile.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

void fail(const std::string& what) { throw std::runtime_error(what); }

std::string refusal(const std::string& path, std::size_t most = kLongestText) {
  try {
    textOfFile(path, fail, most);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(TextFile, IsReadWhole) {
  const test::TempFolder folder;
  const std::string text(100000, 'x');
  EXPECT_EQ(textOfFile(folder.write("a", text), fail), text);
  EXPECT_EQ(textOfFile(folder.write("b", ""), fail), "");
}

TEST(TextFile, ThatIsNoneIsRefused) {
  const test::TempFolder folder;
  EXPECT_EQ(refusal(folder / "absent"), folder / "absent: cannot be read; check the name and its permissions");
  EXPECT_EQ(refusal(folder.path().string()),
            folder.path().string() + ": cannot be read; check the name and its permissions");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: longer than 16 MB; give a text file");
}

TEST(TextFile, BytesAreNoneOfWhatCannotBeRead) {
  const test::TempFolder folder;
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(bytesOfFile(folder.write("a", bytes)), bytes);
  EXPECT_EQ(bytesOfFile(folder / "absent"), "");
  EXPECT_EQ(bytesOfFile(folder.path().string()), "");
  EXPECT_EQ(bytesOfFile(""), "");
}

}  // namespace
}  // namespace lintel
