// SPDX-License-Identifier: BSD-3-Clause
// Figures and pages of whole programs: against an instrument that others wrote, against single runs, in a browser.
#include "Pipeline.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The numbers behind a word in mapcheck's output.
std::vector<double> numbersAfter(const std::string& text, const std::string& word) {
  std::vector<double> numbers;
  std::string line = text.substr(std::min(text.find("\n" + word), text.size() - 1) + 1);
  line = line.substr(0, line.find('\n'));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool begins = std::isdigit(static_cast<unsigned char>(line[i])) && line[i - 1] == ' ';
    if (!begins) continue;
    numbers.push_back(std::stod(line.substr(i)));
  }
  return numbers;
}

TEST_F(Pipeline, FiguresOfTheMapAgreeWithAnIndependentInstrument) {
  const char* mapcheck = std::getenv("LINTEL_MAPCHECK");
  if (mapcheck == nullptr || !fs::exists(mapcheck)) GTEST_SKIP() << "mapcheck is absent (LINTEL_MAPCHECK)";
  ASSERT_EQ(run("lintel-map", shellWord(folder_ / "out/map.lintel") + " -o " + shellWord(folder_ / "check.csv")), 0);
  // the trajectory that the map belongs to
  const fs::path refined = folder_ / "out/trajectory_refined.tum";
  const fs::path trajectory = fs::exists(refined) ? refined : folder_ / "out/trajectory.tum";
  const std::string command = shellWord(mapcheck) + " " + shellWord(recording()) + " " + shellWord(trajectory) + " " +
                              shellWord(folder_ / "check.csv") + " > " + shellWord(folder_ / "mapcheck.out");
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string reference = "\n" + bytesOf(folder_ / "mapcheck.out");
  const auto figures = evaluate("out")["lines"];
  for (const auto& [word, key] :
       {std::pair{"surface_precision", "surface_precision"}, {"edge_precision", "precision"}, {"recall", "recall"}}) {
    const auto expected = numbersAfter(reference, word);
    ASSERT_GE(expected.size(), 3u) << word;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(figures[key][i], expected[i], 0.01 * expected[i] + 0.0005) << word;
  }
  const auto direction = numbersAfter(reference, "direction_error");
  ASSERT_GE(direction.size(), 3u);
  constexpr double kDegrees = 57.29577951308232;
  EXPECT_NEAR(kDegrees * figures["all_matched"]["direction_median_rad"].get<double>(), direction[0],
              0.01 * direction[0] + 0.005);
  EXPECT_NEAR(kDegrees * figures["all_matched"]["direction_p90_rad"].get<double>(), direction[1],
              0.01 * direction[1] + 0.005);
  EXPECT_NEAR(figures["all_matched"]["distance_median_m"], direction[2], 0.01 * direction[2] + 0.0005);
  EXPECT_NEAR(figures["duplicates"], numbersAfter(reference, "duplicates")[0], 0.015);
}

TEST_F(Pipeline, ABenchGivesWhatSingleRunsGive) {
  std::ofstream(folder_ / "suite.yaml") << "recordings: [recording]\nconfig: " << environment("LINTEL_CONFIG")
                                        << "\nconfigurations: [{name: same}, {name: points, set: "
                                           "[features=points]}]\n";
  fs::remove_all(folder_ / "bench");
  ASSERT_EQ(run("lintel-bench", shellWord(folder_ / "suite.yaml") + " -o " + shellWord(folder_ / "bench") +
                                    " --recordings " + shellWord(folder_)),
            0)
      << bytesOf(folder_ / "lintel-bench.err");
  const fs::path same = folder_ / "bench/runs/recording/same/from0";
  for (const char* file : {"trajectory.tum", "map.lintel"})
    EXPECT_TRUE(bytesOf(same / file) == bytesOf(folder_ / "out" / file)) << file;
  const auto results = nlohmann::json::parse(bytesOf(folder_ / "bench/results.json"));
  const auto in_bench = results["runs"]["recording/same/from0"]["evaluation"]["lines"];
  EXPECT_EQ(in_bench, evaluate("out")["lines"]);
  EXPECT_THAT(bytesOf(folder_ / "bench/tables/accuracy.txt"), HasSubstr("recording"));
}

TEST_F(Pipeline, PagesOpenInABrowserWithoutAWord) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "no chromium in PATH";
  ASSERT_EQ(run("lintel-eval", "--quiet --trajectory " + shellWord(folder_ / "out/trajectory.tum") + " --groundtruth " +
                                   shellWord(recording()) + " --report " + shellWord(folder_ / "evaluation.html")),
            0);
  for (const fs::path& page :
       {folder_ / "out/report.html", folder_ / "bench/report.html", folder_ / "evaluation.html"}) {
    if (!fs::exists(page)) continue;  // a test that was filtered out makes it
    const std::string text = bytesOf(page);
    for (const char* address : {"src=\"http", "href=\"http"}) EXPECT_THAT(text, Not(HasSubstr(address))) << page;
    const fs::path dom = folder_ / "page.dom", log = folder_ / "page.log";
    const std::string command =
        "chromium --headless=new --no-sandbox --disable-gpu --enable-logging=stderr --user-data-dir=" +
        shellWord(folder_ / "profile") + " --dump-dom " + shellWord("file://" + page.string()) + " > " +
        shellWord(dom) + " 2> " + shellWord(log);
    ASSERT_EQ(std::system(command.c_str()), 0) << bytesOf(log);
    EXPECT_THAT(bytesOf(log), Not(HasSubstr("CONSOLE"))) << page;
    EXPECT_THAT(bytesOf(dom), HasSubstr("<figure>")) << page;
  }
}

}  // namespace
}  // namespace lintel
