// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lintel::test {

/// What a program run in process said.
struct ProgramRun {
  int exit_code = -1;
  std::string out, err;
};

ProgramRun runVio(const std::vector<std::string>& arguments);
ProgramRun runConverter(const std::vector<std::string>& arguments);

/// share/lintel/config/euroc.yaml of the source tree.
std::string eurocConfig();

std::string bytesOf(const std::filesystem::path& path);

/// A folder of its own that goes with the object.
class WorkFolder {
 public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace lintel::test
