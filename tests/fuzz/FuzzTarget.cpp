// SPDX-License-Identifier: BSD-3-Clause
// For clang's libFuzzer. The name of the program, fuzz_NAME, says which parser is fed: run_fuzzers makes links of all.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "Parsers.h"

namespace {

const lintel::test::Parser* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** argv) {
  const std::string name = std::filesystem::path((*argv)[0]).filename().string().substr(5);
  for (const auto& parser : lintel::test::parsers())
    if (parser.name == name) chosen = &parser;
  if (chosen != nullptr) return 0;
  std::cerr << "fuzz_" << name << ": there is no such parser; link the program as fuzz_NAME, NAME one of:";
  for (const auto& parser : lintel::test::parsers()) std::cerr << " " << parser.name;
  std::cerr << "\n";
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lintel::test::feed(*chosen, {reinterpret_cast<const char*>(data), size});
  return 0;
}
