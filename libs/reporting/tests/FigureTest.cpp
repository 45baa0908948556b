// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Figure.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "lintel/core/ChildProcess.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class FigureDrawing : public ::testing::Test {
 protected:
  void SetUp() override {
    if (runChild({{"gnuplot", "--version"}, "", "", {}}).exit_code != 0) GTEST_SKIP() << "gnuplot is absent";
  }
};

Figure everyKind() {
  Figure figure{"a title", "time [s]", "what \"it\" is_called"};
  Curve line{"line_with_underscore", {}}, band{"band", {}, CurveStyle::kBand}, segments{"", {}, CurveStyle::kSegments};
  for (int i = 0; i < 50; ++i) {
    line.points.push_back({0.1 * i, std::sin(0.2 * i)});
    band.points.push_back({0.1 * i, 1});
    band.points.push_back({0.1 * i, -1});
  }
  line.points[20][1] = std::numeric_limits<double>::quiet_NaN();
  segments.points = {{0, 0}, {1, 1}, {2, 0}, {3, 1}};
  figure.curves = {line, band, segments, {"dots", {{1, 0}, {2, 0.5}}, CurveStyle::kDots}};
  figure.boxes = {{"boxes", {{1, 0.3, {0, 0.2, 0.4, 0.5, 0.9}}}}};
  return figure;
}

TEST_F(FigureDrawing, NamesAreNoCommands) {
  const test::TempFolder folder;
  const std::string file = folder / "made";
  Figure figure = everyKind();
  for (const std::string& name : {"`touch " + file + "`", "\"; system('touch " + file + "') #",
                                  "\n!touch " + file + "\n", "\\\"; !touch " + file}) {
    figure.title = figure.x_label = figure.curves[0].title = figure.boxes[0].title = name;
    svgOf(figure);
    EXPECT_EQ(folder.entries(), 0) << name;
  }
}

TEST_F(FigureDrawing, EveryKindOfCurveIsDrawn) {
  const std::string svg = svgOf(everyKind());
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  for (const char* text : {"a title", "line_with_underscore", "band", "dots", "boxes", "is_called"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST_F(FigureDrawing, TheSameFigureGivesTheSameBytes) { EXPECT_EQ(svgOf(everyKind()), svgOf(everyKind())); }

TEST_F(FigureDrawing, NumbersThatAreNoneInterruptALine) {
  Figure figure{"", "x", "y"};
  figure.curves = {{"c", {{0, 0}, {1, std::numeric_limits<double>::infinity()}, {2, 1}, {3, 0}}}};
  EXPECT_THAT(svgOf(figure), Not(HasSubstr("inf")));
}

TEST(Figure, WithoutAnythingToDrawItSaysSo) {
  Figure figure{"", "x", "y"};
  EXPECT_THROW(svgOf(figure), PlotError);
  figure.curves = {{"nothing", {{NAN, 1}}}};
  EXPECT_THROW(svgOf(figure), PlotError);
}

TEST(Figure, ThinningKeepsTheEnds) {
  std::vector<PlotPoint> points;
  for (int i = 0; i <= 10000; ++i) points.push_back({double(i), 0});
  const auto few = thinned(points, 100);
  EXPECT_EQ(few.size(), 100u);
  EXPECT_EQ(few.front()[0], 0);
  EXPECT_EQ(few.back()[0], 10000);
  EXPECT_EQ(thinned(few).size(), 100u);
}

}  // namespace
}  // namespace lintel
