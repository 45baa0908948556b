// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Figure.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/ChildProcess.h"
#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr const char* kNoGnuplot = "plots need gnuplot: install gnuplot-nox";

std::string number(double value) { return formatted("%.7g", value); }

/// A text between double quotes, as gnuplot reads it. What is between backquotes it would run as a command.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    const bool control = static_cast<unsigned char>(c) < 0x20;
    result += control ? ' ' : c == '`' ? '\'' : c;
  }
  return result + "\"";
}

bool finite(const PlotPoint& p) { return std::isfinite(p[0]) && std::isfinite(p[1]); }

std::string row(const PlotPoint& p) { return number(p[0]) + " " + number(p[1]) + "\n"; }

/// A curve's numbers as gnuplot's data block; empty when there is nothing to draw.
std::string dataOf(const Curve& curve) {
  std::string data;
  const auto& points = curve.points;
  if (curve.style == CurveStyle::kBand) {
    for (std::size_t i = 0; i + 1 < points.size(); i += 2)
      if (finite(points[i]) && finite(points[i + 1]))
        data += number(points[i][0]) + " " + number(points[i][1]) + " " + number(points[i + 1][1]) + "\n";
    return data;
  }
  const bool pairs = curve.style == CurveStyle::kSegments;
  bool any = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    any = any || finite(points[i]);
    data += finite(points[i]) ? row(points[i]) : "\n";
    if (pairs && i % 2 == 1) data += "\n";
  }
  return any ? data : "";
}

std::string dataOf(const BoxSeries& series) {
  std::string data;
  for (const Box& box : series.boxes) {
    if (!std::all_of(box.quantiles.begin(), box.quantiles.end(), [](double q) { return std::isfinite(q); })) continue;
    data += number(box.x);
    for (const double q : box.quantiles) data += " " + number(q);
    data += " " + number(box.width) + "\n";
  }
  return data;
}

std::string titleWord(const std::string& title) { return title.empty() ? " notitle" : " title " + quoted(title); }

std::string plotWords(const Curve& curve, const std::string& colour) {
  const std::string lines = " lw " + number(curve.width) + " lc rgb " + quoted(colour) + (curve.dashed ? " dt 2" : "");
  switch (curve.style) {
    case CurveStyle::kDots:
      return " using 1:2 with points pt 7 ps 0.3 lc rgb " + quoted(colour);
    case CurveStyle::kSteps:
      return " using 1:2 with steps" + lines;
    case CurveStyle::kBand:
      return " using 1:2:3 with filledcurves fs transparent solid 0.25 noborder lc rgb " + quoted(colour);
    case CurveStyle::kLine:
    case CurveStyle::kSegments:
      break;
  }
  return " using 1:2 with lines" + lines;
}

/// Collects data blocks and what is plotted of them.
class Script {
 public:
  void add(const std::string& data, const std::string& words) {
    if (data.empty()) return;
    const std::string name = "$d" + std::to_string(count_++);
    blocks_ += name + " << EOD\n" + data + "EOD\n";
    plots_ += (plots_.empty() ? "plot " : ", \\\n  ") + name + words;
  }
  bool empty() const { return count_ == 0; }
  std::string text(const std::string& settings) const { return blocks_ + settings + plots_ + "\n"; }

 private:
  std::string blocks_, plots_;
  int count_ = 0;
};

std::string settingsOf(const Figure& figure) {
  std::string s = "set encoding utf8\nset terminal svg noenhanced fixed rounded size " +
                  std::to_string(figure.width_px) + "," + std::to_string(figure.height_px) +
                  " font \"sans-serif,14\" background \"white\"\n";
  s += "set grid lc rgb \"#dddddd\" lw 0.7\nset border 3 lc rgb \"#666666\"\nset tics nomirror textcolor rgb "
       "\"#222222\"\n";
  s += "set key outside top center horizontal samplen 2\nset style line 1 lw 1.5\n";
  if (!figure.title.empty()) s += "set title " + quoted(figure.title) + "\n";
  s += "set xlabel " + quoted(figure.x_label) + "\nset ylabel " + quoted(figure.y_label) + "\n";
  s += figure.equal_axes ? "" : "set autoscale xfix\n";
  if (figure.equal_axes) s += "set size ratio -1\nset xtics rotate by 45 right\n";
  if (figure.log_y) s += "set logscale y\nset format y \"%g\"\n";
  if (figure.from_zero) s += "set yrange [0:*]\n";
  if (!figure.x_names.empty()) {
    s += "set xrange [-0.6:" + number(static_cast<double>(figure.x_names.size()) - 0.4) + "]\nset xtics (";
    for (std::size_t i = 0; i < figure.x_names.size(); ++i)
      s += (i > 0 ? ", " : "") + quoted(figure.x_names[i]) + " " + std::to_string(i);
    s += ")\n";
  }
  return s;
}

/// gnuplot repeats the command and points at a place before it says what is wrong: "line N: reason".
std::string reasonIn(const std::string& text) {
  const std::size_t from = text.rfind("line ");
  return from == std::string::npos ? text.substr(0, 200) : text.substr(from, text.find('\n', from) - from);
}

/// What gnuplot reads to draw the figure; empty when there is nothing to draw.
std::string scriptOf(const Figure& figure) {
  Script script;
  std::size_t place = 0;
  for (const Curve& curve : figure.curves) {
    const std::string colour = curve.colour.empty() ? plotColour(place++) : curve.colour;
    script.add(dataOf(curve), plotWords(curve, colour) + titleWord(curve.title));
  }
  for (const BoxSeries& series : figure.boxes) {
    const std::string colour = quoted(series.colour.empty() ? plotColour(place++) : series.colour),
                      data = dataOf(series);
    script.add(data, " using 1:3:2:6:5:7 with candlesticks fs transparent solid 0.3 lw 1.2 lc rgb " + colour +
                         titleWord(series.title) + " whiskerbars 0.5");
    script.add(data, " using 1:4:4:4:4:7 with candlesticks lw 2.5 lc rgb " + colour + " notitle");  // the median
  }
  return script.empty() ? "" : script.text(settingsOf(figure));
}

/// By a name of its input: what it calls "-" it reads byte by byte.
ChildResult runGnuplot(const std::string& script) {
  return runChild({{"gnuplot", "-d", "/dev/stdin"}, script, "", {"LC_ALL=C.UTF-8"}});
}

std::vector<std::string> picturesIn(const std::string& output) {
  std::vector<std::string> pictures;
  for (std::size_t begin = output.find("<svg"); begin != std::string::npos; begin = output.find("<svg", begin)) {
    const std::size_t end = output.find("</svg>", begin);
    if (end == std::string::npos) break;
    pictures.push_back(output.substr(begin, end + 6 - begin) + "\n");
    begin = end;
  }
  return pictures;
}

/// The pictures of a script; none where gnuplot is missing or stopped half way.
std::vector<std::string> draw(const std::string& script) {
  const ChildResult result = runGnuplot(script);
  return result.exit_code == 0 ? picturesIn(result.output) : std::vector<std::string>();
}

DrawnFigure drawAlone(const Figure& figure) {
  const ChildResult result = runGnuplot(scriptOf(figure));
  if (result.exit_code == 127) return {"", kNoGnuplot};
  const std::vector<std::string> pictures = picturesIn(result.output);
  if (result.exit_code == 0 && pictures.size() == 1) return {pictures.front(), ""};
  return {"", "gnuplot could not draw '" + figure.title + "': " + reasonIn(result.errors)};
}

}  // namespace

std::string plotColour(std::size_t index) {
  constexpr std::array<const char*, 8> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#7f7f00", "#444444"};
  return kColours[index % kColours.size()];
}

std::string svgOf(const Figure& figure) {
  const DrawnFigure drawn = svgsOf({figure}).front();
  if (!drawn.fault.empty()) throw PlotError(drawn.fault);
  return drawn.svg;
}

std::vector<DrawnFigure> svgsOf(const std::vector<Figure>& figures) {
  std::vector<DrawnFigure> drawn(figures.size());
  std::string all;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::string script = scriptOf(figures[i]);
    if (script.empty()) drawn[i].fault = "nothing to draw";
    if (script.empty()) continue;
    all += script + "reset session\n";
    asked.push_back(i);
  }
  if (asked.empty()) return drawn;
  const std::vector<std::string> pictures = draw(all);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    DrawnFigure& result = drawn[asked[k]];
    if (pictures.size() == asked.size())
      result.svg = pictures[k];
    else  // gnuplot stops at an error: find out where
      result = drawAlone(figures[asked[k]]);
  }
  return drawn;
}

std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points, std::size_t count) {
  if (points.size() <= count || count < 2) return points;
  std::vector<PlotPoint> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(points[i * (points.size() - 1) / (count - 1)]);
  return result;
}

}  // namespace lintel
