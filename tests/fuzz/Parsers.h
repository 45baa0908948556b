// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lintel::test {

/// A reader of something that comes from outside, fed with bytes. It may throw std::exception; anything else is a
/// fault.
struct Parser {
  std::string name;
  std::string seed;  ///< file of FaultInputs (tests/faults) that it reads
  void (*parse)(const std::string& bytes);
};

const std::vector<Parser>& parsers();

/// Feeds the parser; exceptions are what damaged input is answered with.
void feed(const Parser& parser, const std::string& bytes);

}  // namespace lintel::test
