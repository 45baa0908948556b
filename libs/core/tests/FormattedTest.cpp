// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/Formatted.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

TEST(Formatted, PutsValuesIntoTheFormat) {
  EXPECT_EQ(formatted("%s: %.2f m, %d %%", "way", 1.234, 50), "way: 1.23 m, 50 %");
}

TEST(Formatted, ATextMayHaveAnyLength) {
  const std::string name(5000, 'x');
  EXPECT_EQ(formatted("<%s>", name.c_str()), "<" + name + ">");
  EXPECT_EQ(formatted("%s", ""), "");
}

}  // namespace
}  // namespace lintel
