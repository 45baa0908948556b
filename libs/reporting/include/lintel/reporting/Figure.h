// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace lintel {

/// A point of a plot. A point that is not finite interrupts a line.
using PlotPoint = std::array<double, 2>;

enum class CurveStyle {
  kLine,
  kDots,
  kSteps,
  kSegments,  ///< every two points are a line of their own
  kBand,      ///< filled between two curves: points are upper and lower by turns
};

struct Curve {
  std::string title;  ///< in the key; empty: not in it
  std::vector<PlotPoint> points;
  CurveStyle style = CurveStyle::kLine;
  std::string colour{};  ///< "\#rrggbb"; empty: by its place among the curves
  double width = 1.5;
  bool dashed = false;
};

/// A box of a box plot: 5 %, 25 %, 50 %, 75 %, 95 %.
struct Box {
  double x = 0, width = 0.2;
  std::array<double, 5> quantiles{};
};

struct BoxSeries {
  std::string title;
  std::vector<Box> boxes;
  std::string colour{};  ///< empty: by its place
};

/// What a plot shows. The same figure gives the same picture, byte for byte.
struct Figure {
  std::string title, x_label, y_label;
  std::vector<Curve> curves{};
  std::vector<BoxSeries> boxes{};
  std::vector<std::string> x_names{};  ///< instead of numbers at x = 0, 1, 2, …
  bool equal_axes = false;             ///< a metre is as long across as up
  bool log_y = false, from_zero = false;
  int width_px = 720, height_px = 360;
};

/// A plot cannot be drawn: one line with what to do.
class PlotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Colours that differ for colour-blind eyes, too [Okabe2008]; repeated after eight.
std::string plotColour(std::size_t index);

/// The figure as an SVG picture, drawn by gnuplot. Throws PlotError where gnuplot is missing or refuses.
std::string svgOf(const Figure& figure);

/// A figure as a picture, or one line why there is none.
struct DrawnFigure {
  std::string svg, fault;
};

/// The same for several at once, much cheaper than one by one: starting gnuplot takes longer than most plots.
std::vector<DrawnFigure> svgsOf(const std::vector<Figure>& figures);

/// At most `count` of the points, evenly spread, both ends kept: a plot of 100000 points shows no more than 2000.
std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points, std::size_t count = 2000);

}  // namespace lintel
