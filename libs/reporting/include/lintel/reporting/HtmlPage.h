// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lintel/reporting/Figure.h"
#include "lintel/reporting/Table.h"

namespace lintel {

/// `text` with the characters that mean something in HTML replaced.
std::string escaped(std::string_view text);

/// A page in one file: needs no network and runs no script; fits a phone's width and a sheet of paper. What it is given
/// is text; nothing is taken for HTML.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);  ///< begins a section
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void warnings(const std::vector<std::string>& items);  ///< a list that is seen
  void table(const Table& table);
  void preformatted(std::string_view text);
  /// Folded away until it is asked for; on paper left out.
  void folded(std::string_view summary, std::string_view preformatted_text);

  /// A plot. Where none can be drawn, a line says why, once a page for a missing gnuplot.
  void figure(const Figure& figure, std::string_view description);
  /// A picture: the bytes of a PNG file.
  void picture(std::string_view png, std::string_view description);
  /// Figures from here to endGallery() stand side by side where there is room.
  void beginGallery();
  void endGallery();

  /// The whole page.
  std::string text() const;

 private:
  struct PlacedFigure {
    std::size_t place;  ///< in the body
    Figure figure;
    std::string description;
  };
  std::string bodyWithFigures() const;

  std::string title_, body_;
  std::vector<std::string> sections_;
  std::vector<PlacedFigure> figures_;  ///< drawn when the page is asked for, all at once
};

}  // namespace lintel
