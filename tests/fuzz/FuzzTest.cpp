// SPDX-License-Identifier: BSD-3-Clause
// The parsers on whole inputs and on deterministic mutations of them: what a short run of the fuzzers would do. With
// LINTEL_FUZZ_SEEDS=FOLDER the inputs are written there, as a corpus for tests/fuzz/run_fuzzers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "FaultTable.h"
#include "Parsers.h"
#include "lintel/sensing/EurocToRawlog.h"
#include "lintel/testing/TempFolder.h"

namespace lintel::test {
namespace {

namespace fs = std::filesystem;

/// MRPT zeroes what a damaged rawlog says to be large, which takes its time.
int mutationsFor(const Parser& parser) { return parser.name == "rawlog" ? 10 : 40; }

/// Some changes of bytes, pieces and length.
std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t i = 0; i <= below(4); ++i) {
    const std::size_t at = below(bytes.size()), length = 1 + below(16);
    switch (random() % 5) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 3:
        for (std::size_t k = at; k < std::min(bytes.size(), at + 4); ++k) bytes[k] = '\xff';
        break;
      default:
        if (random() % 4 == 0) bytes.resize(at);
    }
  }
  return bytes;
}

class FuzzTest : public testing::TestWithParam<Parser> {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    const FaultInputs inputs(folder_->path());
    const fs::path whole = folder_->path() / "whole";
    EurocToRawlogParams params;
    params.embed = true;
    params.compress_level = 0;
    eurocToRawlog((whole / "folder").string(), (whole / "plain.rawlog").string(), params);
    const auto image = fs::directory_iterator(whole / "folder/mav0/cam0/data")->path();
    fs::copy(image, whole / "image.png");
  }
  static void TearDownTestSuite() { delete folder_; }

  static inline TempFolder* folder_ = nullptr;
};

TEST_P(FuzzTest, SurvivesMutations) {
  const std::string seed = bytesOf(folder_->path() / "whole" / GetParam().seed);
  ASSERT_FALSE(seed.empty()) << GetParam().seed;
  if (const char* corpus = std::getenv("LINTEL_FUZZ_SEEDS")) {
    fs::create_directories(fs::path(corpus) / GetParam().name);
    std::ofstream(fs::path(corpus) / GetParam().name / "whole", std::ios::binary) << seed;
    return;
  }
  EXPECT_NO_THROW(GetParam().parse(seed)) << "the whole input is read";
  std::mt19937 random(1);
  for (int i = 0; i < mutationsFor(GetParam()); ++i) feed(GetParam(), mutated(seed, random));
}

INSTANTIATE_TEST_SUITE_P(Parsers, FuzzTest, testing::ValuesIn(parsers()),
                         [](const auto& parser) { return parser.param.name; });

}  // namespace
}  // namespace lintel::test
