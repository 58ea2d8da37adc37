// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "study/figures/tables.hpp"

namespace altiplan::study::report {

/// A figure of the report. Colours are attributes of the elements, for programs without style
/// sheets; classes override them where there is one (light and dark).
struct Figure {
  std::string name;     ///< stem of its files
  std::string title;    ///< what it shows
  std::string caption;  ///< number of runs and meaning of the marks
  double width = 0;
  double height = 0;
  std::string body;  ///< SVG elements
  Grid numbers;      ///< the data drawn
};

/// Width of all figures, in units that are pixels on a small screen.
constexpr double kFigureWidth = 420;

enum class Anchor { start, middle, end };

/// Appends SVG elements; text is escaped.
class Canvas {
 public:
  /// `kind` is a class of the style sheet: "ink", "quiet", "strong".
  void text(double x, double y, std::string_view text, std::string_view kind = "ink",
            Anchor anchor = Anchor::start);
  void line(double x0, double y0, double x1, double y1, std::string_view kind);
  void rectangle(double x, double y, double width, double height, const std::string& paint,
                 const std::string& tip = "");
  void path(const std::string& d, const std::string& paint);
  /// A mark in the shape of the series, filled if `solid`.
  void mark(double x, double y, std::size_t series, double size, const std::string& tip = "");
  /// A point that opens the run when it is clicked.
  void point(double x, double y, std::size_t series, std::size_t run, const std::string& tip);
  void raw(const std::string& elements) { body_ += elements; }
  std::string take() { return std::move(body_); }

 private:
  std::string body_;
};

/// One decimal, enough for a screen.
std::string pixels(double value);

// Paints: attributes of an element. Series have colours of host::kSeriesColors, then the same
// dashed, and marks.
std::string series_line(std::size_t series, double width = 1.8);
std::string series_fill(std::size_t series);
std::string series_fill_pale(std::size_t series);
std::string ink_line(double width);
/// Colour and pattern of an outcome; the figure must contain `outcome_patterns`.
std::string outcome_fill(std::string_view outcome);
std::string outcome_patterns(const std::vector<std::string>& outcomes);

/// Maps numbers to coordinates, linearly or logarithmically.
class Axis {
 public:
  /// Logarithmic if all are positive and span more than a factor of 30.
  static Axis around(const std::vector<double>& values, double from, double to);
  Axis(double low, double high, bool logarithmic, double from, double to);

  double operator()(double value) const;
  bool logarithmic() const { return logarithmic_; }
  double low() const { return low_; }
  double high() const { return high_; }

  struct Tick {
    double value = 0;
    std::string label;  ///< "" if it does not fit
  };
  std::vector<Tick> ticks() const;          ///< of a horizontal axis
  std::vector<Tick> ticks_upwards() const;  ///< of a vertical one

 private:
  std::vector<Tick> all_ticks() const { return logarithmic_ ? logarithmic_ticks() : even_ticks(); }
  std::vector<Tick> even_ticks() const;
  std::vector<Tick> logarithmic_ticks() const;
  double low_;
  double high_;
  bool logarithmic_;
  double from_;
  double to_;
};

/// A horizontal axis with grid lines up through the plot, its numbers and its label: from y down to
/// the baseline of the label 37, and so much for all.
constexpr double kAxisHeight = 41;
void draw_bottom(Canvas& canvas, const Axis& axis, double top, double y, const std::string& label);
/// A vertical axis with grid lines across the plot, and its label above.
void draw_left(Canvas& canvas, const Axis& axis, double left, double right, double top,
               const std::string& label);
/// A line through points, interrupted at non-finite ones.
void draw_curve(Canvas& canvas, const std::vector<double>& x, const std::vector<double>& y,
                const Axis& along, const Axis& up, const std::string& paint);
/// A key entry for the line of a series; returns the y of the next entry.
double draw_key(Canvas& canvas, double x, double y, std::size_t series, std::string_view words);
/// Shares from 0 to 100 % as a vertical axis.
void draw_shares(Canvas& canvas, double left, double right, double top, double bottom);
/// "Length, m (logarithmic)".
std::string axis_label(const std::string& label, const Axis& axis);

/// The style sheet of figures, light and dark, each rule under `scope`.
std::string figure_style();
/// A separate file, or (`inlined`) an element of a page that contains figure_style().
std::string svg_text(const Figure& figure, bool inlined);
}  // namespace altiplan::study::report
