// SPDX-License-Identifier: BSD-3-Clause
// The html export in a real browser: needs the package chromium, which ./check does not install (110 MB to fetch);
// skipped without it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "Files.h"
#include "SampleMap.h"
#include "ViewerPage.h"
#include "lintel/core/ChildProcess.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

const LineMap kRoom = sampleRoom();

std::string browser() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::filesystem::exists(folder + "/chromium")) return folder + "/chromium";
  }
  return "";
}

/// Runs before everything else of a page: keeps what goes wrong. Headless Chromium asks for few frames of its own
/// accord.
const std::string kWatch = R"(<script>
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
window.faults = [];
window.addEventListener('error', (event) => faults.push(String(event.message || event.type)), true);
for (const kind of ['error', 'warn']) console[kind] = (...words) => faults.push(kind + ': ' + words.join(' '));
</script>)";

/// Runs after everything else: does what a user does, and leaves what it found in the page.
const std::string kUser = R"(<script>
(async () => {
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const canvas = document.querySelector('canvas'), info = document.getElementById('info'), found = { hovered: [] };
  const coloured = async () => {
    await frame(); await frame();
    const copy = document.createElement('canvas');
    copy.width = canvas.width; copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const p = context.getImageData(0, 0, copy.width, copy.height).data;
    let count = 0;
    for (let i = 0; i < p.length; i += 4) count += Math.max(p[i], p[i + 1], p[i + 2]) - Math.min(p[i], p[i + 1], p[i + 2]) > 60;
    return count;
  };
  const picture = () => canvas.toDataURL();
  found.withLines = await coloured();
  const boxes = [...document.querySelectorAll('#layers input')];
  found.boxes = boxes.length;
  for (const box of boxes.slice(1)) if (box.checked) box.click();
  found.linesOnly = await coloured();
  boxes[0].click();
  found.withoutLines = await coloured();
  boxes[0].click();
  const groups = [...document.querySelectorAll('#groups input')];
  found.groups = groups.map((box) => box.parentNode.textContent.trim());
  for (const box of groups.slice(1)) box.click();
  found.oneGroup = await coloured();
  for (const box of groups.slice(1)) box.click();
  found.groupsAgain = await coloured();
  const filters = [...document.querySelectorAll('#filters input')];
  found.filters = [];
  for (const filter of filters) {
    const text = () => filter.parentNode.textContent, open = text();
    filter.value = Math.round(filter.max / 2);
    filter.dispatchEvent(new Event('input'));
    const half = await coloured(), middle = text();
    filter.value = filter.max;
    filter.dispatchEvent(new Event('input'));
    const few = await coloured();
    filter.value = 0;
    filter.dispatchEvent(new Event('input'));
    found.filters.push({ open, middle, half, few, again: await coloured() });
  }
  const colour = document.getElementById('colour'), pictures = new Set();
  for (const option of colour.options) {
    colour.value = option.value;
    colour.dispatchEvent(new Event('change'));
    await frame(); await frame();
    pictures.add(picture());
  }
  found.modes = pictures.size;
  for (let x = 0.3; x < 0.7 && found.hovered.length < 2; x += 0.02) {
    const at = { clientX: x * window.innerWidth, clientY: 0.5 * window.innerHeight };
    canvas.dispatchEvent(new MouseEvent('mousemove', at));
    await frame(); await frame();
    if (info.style.display === 'block') found.hovered.push(info.textContent);
  }
  if (boxes.length > 3 && !boxes[3].disabled) {
    boxes[3].click();
    const slider = document.getElementById('slider'), atEnd = await coloured();
    found.clockAtEnd = document.getElementById('clock').textContent;
    slider.value = 0;
    slider.dispatchEvent(new Event('input'));
    found.clockAtBeginning = document.getElementById('clock').textContent;
    found.pathGrows = atEnd > await coloured();
  }
  found.faults = window.faults;
  const result = document.createElement('pre');
  result.id = 'found';
  result.textContent = JSON.stringify(found);
  document.body.append(result);
})();
</script>)";

class ViewerPage : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    if (browser().empty()) GTEST_SKIP() << "no chromium in PATH: install the package chromium to test the page in it";
    if (!std::filesystem::exists(kThreeFolder)) GTEST_SKIP() << "libjs-three is not installed";
  }

  /// Opens the page without a display or a graphics card; software draws. Home is the test's folder.
  ChildResult open(const std::string& page, const std::string& what) const {
    std::vector<std::string> command{browser(),
                                     "--headless=new",
                                     "--use-angle=swiftshader",
                                     "--enable-unsafe-swiftshader",
                                     "--window-size=800,600",
                                     "--hide-scrollbars",
                                     "--virtual-time-budget=20000",
                                     "--enable-logging=stderr",
                                     "--user-data-dir=" + in("profile"),
                                     what,
                                     "file://" + page};
    if (::geteuid() == 0) command.insert(command.begin() + 1, "--no-sandbox");  // its sandbox refuses root
    return runChild({command, "", "", {"HOME=" + folder_.path().string()}});
  }

  /// The page as a user works through it.
  nlohmann::json tried(const LineMap& map) const {
    exportMap(map, in("map.html"));
    std::string page = content(in("map.html"));
    page.insert(page.find("<head>") + 6, kWatch);
    page.insert(page.rfind("</body>"), kUser);
    std::ofstream(in("tried.html")) << page;
    const std::string dom = open(in("tried.html"), "--dump-dom").output, mark = "<pre id=\"found\">";
    const std::size_t at = dom.find(mark);
    if (at == std::string::npos) return nullptr;
    std::string text = dom.substr(at + mark.size(), dom.find("</pre>", at) - at - mark.size());
    return nlohmann::json::parse(text);
  }
};

TEST_F(ViewerPage, ShowsColouredLinesWithoutAWordOnTheConsole) {
  ExportParams params;
  params.colour = LineColour::kGroup;
  params.layers = {MapLayer::kLines};
  exportMap(kRoom, in("map.html"), params);
  const ChildResult result = open(in("map.html"), "--screenshot=" + in("shot.png"));
  EXPECT_THAT(result.errors, ::testing::Not(::testing::HasSubstr("CONSOLE")));
  const cv::Mat shot = cv::imread(in("shot.png"));
  ASSERT_FALSE(shot.empty()) << result.errors;
  int red = 0, green = 0, blue = 0;  // groups 0, 1, 2
  for (int y = 0; y < shot.rows; ++y) {
    for (int x = shot.cols / 3; x < shot.cols; ++x) {  // beside the panel
      const cv::Vec3b& p = shot.at<cv::Vec3b>(y, x);
      red += p[2] > 150 && p[1]<90, green += p[1]> 120 && p[2]<90, blue += p[0]> 150 && p[2] < 90;
    }
  }
  EXPECT_GT(std::min({red, green, blue}), 300) << red << " " << green << " " << blue;
}

TEST_F(ViewerPage, LayersColoursHoverAndTimeWork) {
  const auto found = tried(kRoom);
  ASSERT_FALSE(found.is_null());
  EXPECT_EQ(found["faults"].size(), 0u) << found["faults"];
  EXPECT_EQ(found["boxes"], 5);
  EXPECT_GT(found["withLines"], found["linesOnly"]);
  EXPECT_GT(found["linesOnly"], 1000);
  EXPECT_EQ(found["withoutLines"], 0);
  EXPECT_EQ(found["groups"][0].get<std::string>().rfind("no group (", 0), 0u) << found["groups"];
  EXPECT_LT(found["oneGroup"], found["linesOnly"]);
  EXPECT_EQ(found["groupsAgain"], found["linesOnly"]);
  ASSERT_EQ(found["filters"].size(), 2u);
  EXPECT_EQ(found["filters"][0]["open"], "sigma up to 0.033 m");
  EXPECT_EQ(found["filters"][1]["open"], "seen in 2 keyframes at least");
  for (const auto& filter : found["filters"]) {
    EXPECT_NE(filter["middle"], filter["open"]);
    EXPECT_LT(filter["half"], found["linesOnly"]);
    EXPECT_LT(filter["few"], filter["half"]);
    EXPECT_GT(filter["few"], 0);
    EXPECT_EQ(filter["again"], found["linesOnly"]);
  }
  EXPECT_EQ(found["modes"], 4);
  ASSERT_FALSE(found["hovered"].empty());
  EXPECT_THAT(found["hovered"][0].get<std::string>(),
              ::testing::MatchesRegex("line [0-9]+\nlength [0-9.]+ m\nobservations [0-9]+\nseen (.|\n)*"));
  EXPECT_EQ(found["clockAtEnd"], "9.95 s");
  EXPECT_EQ(found["clockAtBeginning"], "0.00 s");
  EXPECT_TRUE(found["pathGrows"]);
}

TEST_F(ViewerPage, AnEmptyMapAndASingleLineAreNoFault) {
  for (const int lines : {0, 1}) {
    LineMap map;
    if (lines == 1) addLine(map, {0, 0, 0}, {0, 0, 1}, -1);
    const auto found = tried(map);
    ASSERT_FALSE(found.is_null()) << lines;
    EXPECT_EQ(found["faults"].size(), 0u) << found["faults"];
  }
}

}  // namespace
}  // namespace lintel
