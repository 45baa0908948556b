// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lintel::test {

/// Words of a line; `\s \n \r \t \0 \\` and `\xHH` stand for bytes, `\e` for nothing.
std::vector<std::string> wordsOf(const std::string& line);

/// Does to the files below `root` what one edit of a fault says: a verb, a file, and the verb's arguments (README.md).
/// `@5` in a file's name is the image of frame 5. Throws std::runtime_error when it cannot be done.
void applyEdit(const std::filesystem::path& root, const std::string& edit);

/// The same of an edit that begins with `obs`: it changes the observations of a rawlog.
void applyRawlogEdit(const std::string& rawlog, const std::vector<std::string>& words);

/// The same of one that begins with `map`: takes records out of a map, or puts numbers into it, and writes it anew.
void applyMapEdit(const std::string& map, const std::vector<std::string>& words);

/// All edits of a fault, separated by `;`.
void applyEdits(const std::filesystem::path& root, const std::string& edits);

}  // namespace lintel::test
