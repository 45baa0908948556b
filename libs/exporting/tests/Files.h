// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "lintel/testing/TempFolder.h"

namespace lintel {

/// A test with a folder of its own.
class FolderTest : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_ / name; }
  static std::string content(const std::string& path) { return test::bytesOf(path); }

  test::TempFolder folder_;
};

}  // namespace lintel
