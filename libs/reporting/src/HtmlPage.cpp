// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/HtmlPage.h"

#include "lintel/core/Base64.h"

namespace lintel {

namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; }
body { margin: 0 auto; max-width: 62rem; padding: 1rem; color: #1a1d21; background: #fff; font: 16px/1.5 sans-serif; }
h1 { font-size: 1.5rem; margin: .2rem 0 .6rem; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; border-bottom: 1px solid #ccd; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
nav a { margin-right: .9rem; white-space: nowrap; }
a { color: #005a9c; }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: .2rem 0; color: #444; }
th, td { padding: .2rem .6rem; border-bottom: 1px solid #dde; text-align: right; white-space: nowrap; }
thead th { white-space: normal; vertical-align: bottom; max-width: 8rem; }
th:first-child { text-align: left; }
td.fault { color: #a02000; }
.note { font-size: .85rem; color: #444; margin: .2rem 0; }
ul.warnings { border-left: 4px solid #d55e00; background: #fff6ee; margin: .6rem 0; padding: .5rem 1rem .5rem 2rem; }
figure { margin: .8rem 0; break-inside: avoid; }
figure img { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .85rem; color: #444; }
.gallery { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: .4rem 1rem; }
pre { overflow-x: auto; background: #f5f6f8; padding: .6rem; font-size: .8rem; }
@media screen and (min-width: 64rem) { .wide { margin-right: calc(32rem - 50vw); } }
@media (max-width: 40rem) { th, td { white-space: normal; padding: .2rem .35rem; } }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } nav, details { display: none; } .wide { overflow: visible; }
  h2, h3 { break-after: avoid; } tr { break-inside: avoid; } }
)";

/// What a data: address may not hold as it is.
std::string percentEncoded(std::string_view text) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte > 0x7e || c == '%' || c == '#' || c == '"' || c == '<' || c == '>' || c == '&') {
      result += '%';
      result += kHex[byte >> 4];
      result += kHex[byte & 15];
    } else {
      result += c;
    }
  }
  return result;
}

std::string imageFigure(const std::string& source, std::string_view description) {
  const std::string text = escaped(description);
  return "<figure><img src=\"" + source + "\" alt=\"" + text + "\"><figcaption>" + text + "</figcaption></figure>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void HtmlPage::heading(std::string_view text) {
  sections_.emplace_back(text);
  body_ += "<h2 id=\"s" + std::to_string(sections_.size()) + "\">" + escaped(text) + "</h2>\n";
}

void HtmlPage::subheading(std::string_view text) { body_ += "<h3>" + escaped(text) + "</h3>\n"; }

void HtmlPage::paragraph(std::string_view text) { body_ += "<p>" + escaped(text) + "</p>\n"; }

void HtmlPage::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + escaped(item) + "</li>\n";
  body_ += "</ul>\n";
}

void HtmlPage::warnings(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul class=\"warnings\">\n";
  for (const std::string& item : items) body_ += "<li>" + escaped(item) + "</li>\n";
  body_ += "</ul>\n";
}

void HtmlPage::table(const Table& table) { body_ += htmlOf(table); }

void HtmlPage::preformatted(std::string_view text) { body_ += "<pre>" + escaped(text) + "</pre>\n"; }

void HtmlPage::folded(std::string_view summary, std::string_view text) {
  body_ += "<details><summary>" + escaped(summary) + "</summary><pre>" + escaped(text) + "</pre></details>\n";
}

void HtmlPage::figure(const Figure& figure, std::string_view description) {
  figures_.push_back({body_.size(), figure, std::string(description)});
}

/// The body with its figures, which are drawn together.
std::string HtmlPage::bodyWithFigures() const {
  std::vector<Figure> figures;
  for (const PlacedFigure& placed : figures_) figures.push_back(placed.figure);
  const std::vector<DrawnFigure> drawn = svgsOf(figures);
  std::string body;
  std::size_t done = 0;
  bool plots_missing = false;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const PlacedFigure& placed = figures_[i];
    body.append(body_, done, placed.place - done);
    done = placed.place;
    if (drawn[i].fault.empty())
      body += imageFigure("data:image/svg+xml," + percentEncoded(drawn[i].svg), placed.description);
    else if (!plots_missing)
      body +=
          "<p class=\"note\">No picture (" + escaped(placed.description) + "): " + escaped(drawn[i].fault) + "</p>\n";
    plots_missing = plots_missing || drawn[i].fault.find("install") != std::string::npos;
  }
  return body.append(body_, done, std::string::npos);
}

void HtmlPage::picture(std::string_view png, std::string_view description) {
  body_ += imageFigure("data:image/png;base64," + base64(png), description);
}

void HtmlPage::beginGallery() { body_ += "<div class=\"gallery\">\n"; }
void HtmlPage::endGallery() { body_ += "</div>\n"; }

std::string HtmlPage::text() const {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>" +
      escaped(title_) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + escaped(title_) + "</h1>\n";
  if (sections_.size() > 1) {
    page += "<nav>";
    for (std::size_t i = 0; i < sections_.size(); ++i)
      page += "<a href=\"#s" + std::to_string(i + 1) + "\">" + escaped(sections_[i]) + "</a> ";
    page += "</nav>\n";
  }
  return page + bodyWithFigures() + "</body>\n</html>\n";
}

}  // namespace lintel
