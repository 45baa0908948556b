// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// What a map's groups of parallel lines are called in every form: "vertical", "horizontal 1", …; "group 2" where the
/// map does not say. All are different, short, and made of letters, digits, blanks and - _ . only, so that each form
/// can spell them.
class GroupNames {
 public:
  explicit GroupNames(const LineMap& map);

  /// Of a line's `group`; "no group" for negative ones.
  std::string operator()(int group) const;

 private:
  std::vector<std::string> names_;  ///< by place in LineMap::groups
};

}  // namespace lintel
