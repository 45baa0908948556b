// SPDX-License-Identifier: BSD-3-Clause
#include "GzStream.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>

#include "RawlogFile.h"
#include "TinyEuroc.h"

namespace lintel::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(GzStreamTest, ReadsBackWhatItWroteAtEveryLevel) {
  const TempFolder folder;
  std::string text(100000, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * i % 251);
  for (const int level : {0, 1, 9}) {
    GzOutput out(folder / "file", level);
    out.Write(text.data(), text.size());
    out.close();
    EXPECT_EQ(bytesOf(folder / "file") == text, level == 0);
    GzInput in(folder / "file");
    std::string back(text.size() + 10, ' ');
    ASSERT_EQ(in.Read(back.data(), back.size()), text.size());
    EXPECT_EQ(back.substr(0, text.size()), text);
    EXPECT_FALSE(in.damaged());
  }
}

TEST(GzStreamTest, ACutCompressedFileIsDamaged) {
  const TempFolder folder;
  GzOutput out(folder / "file", 5);
  for (int i = 0; i < 1000; ++i) out.Write(&i, sizeof i);
  out.close();
  std::filesystem::resize_file(folder / "file", std::filesystem::file_size(folder / "file") - 9);
  GzInput in(folder / "file");
  std::string bytes(5000, ' ');
  in.Read(bytes.data(), bytes.size());
  EXPECT_TRUE(in.damaged());
}

TEST(GzStreamTest, AFullDiskIsOneLine) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  for (const int level : {0, 1}) {
    GzOutput out("/dev/full", level);
    mrpt::obs::CObservationComment comment;
    comment.text = "short";
    writeObservation(out, comment);  // stays in the buffer
    EXPECT_THAT(errorOf([&] { out.close(); }), HasSubstr("/dev/full: cannot be written"));
  }
  GzOutput out("/dev/full", 0);
  mrpt::obs::CObservationComment comment;
  comment.text = std::string(2000000, 'x');
  EXPECT_THAT(errorOf([&] { writeObservation(out, comment); }),
              AllOf(HasSubstr("/dev/full: cannot be written"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace lintel::test
