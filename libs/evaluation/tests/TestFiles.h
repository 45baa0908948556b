// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "lintel/testing/TempFolder.h"

namespace lintel::test {

/// A test with files in a folder of its own.
class TestFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string path(const std::string& name) const { return folder_ / name; }

 private:
  TempFolder folder_;
};

}  // namespace lintel::test
