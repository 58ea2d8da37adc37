// SPDX-License-Identifier: Apache-2.0
#include "study/figures/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "host/base/svg.hpp"
#include "host/view/series_colors.hpp"
#include "study/figures/text.hpp"

namespace altiplan::study::report {
namespace {

using host::attribute;
using host::kSeriesColors;
constexpr std::array<const char*, 4> kDashes{"", "6 3", "2 2.5", "8 3 2 3"};

constexpr const char* kInk = "#1b2430";
constexpr const char* kQuiet = "#5d6875";
constexpr const char* kHair = "#dde1e6";

struct OutcomeLook {
  const char* color;
  const char* pattern;  ///< path within a square of 8, or "" for plain
};
const OutcomeLook& outcome_look(std::string_view outcome) {
  static const std::map<std::string_view, OutcomeLook> kLooks{
      {"solved", {"#009e73", ""}},
      {"no_route", {"#56b4e9", "M0 4H8"}},
      {"timed_out", {"#e69f00", "M-2 2L2-2M0 8L8 0M6 10L10 6"}},
      {"invalid_problem", {"#8c96a1", "M4 0V8"}},
      {"rejected", {"#cc79a7", "M0 4H8M4 0V8"}},
      {"not_reached", {"#0072b2", "M-2 6L2 10M0 0L8 8M6-2L10 2"}},
      {"collided", {"#7a3b00", "M0 0L8 8M0 8L8 0"}},
      {"cancelled", {"#c3c9d0", ""}},
      {"failed", {"#d55e00", "M0 0L8 8M6-2L10 2M-2 6L2 10M0 4H8"}},
      {"crashed", {"#1b2430", "M0 8L8 0"}},
      {"out_of_memory", {"#5b2a86", "M2 0V8M6 0V8"}},
      {"bad_output", {"#a33c3c", "M0 2H8M0 6H8"}},
      {"refused", {"#3d4a57", "M4 0V8M0 4H8"}}};
  static const OutcomeLook kOther{"#8c96a1", "M0 0L8 8"};
  const auto found = kLooks.find(outcome);
  return found == kLooks.end() ? kOther : found->second;
}

constexpr host::SvgPen kPen{true};

/// The outline of the mark of a series.
std::string mark_path(std::size_t series, double x, double y, double r) {
  const auto at = [&](double dx, double dy) { return kPen.at(x + dx * r, y + dy * r); };
  switch (series % 6) {
    case 1:
      return "M" + at(-0.9, -0.9) + "L" + at(0.9, -0.9) + "L" + at(0.9, 0.9) + "L" + at(-0.9, 0.9) +
             "Z";
    case 2:
      return "M" + at(0, -1.2) + "L" + at(1.1, 0.8) + "L" + at(-1.1, 0.8) + "Z";
    case 3:
      return "M" + at(0, -1.3) + "L" + at(1.3, 0) + "L" + at(0, 1.3) + "L" + at(-1.3, 0) + "Z";
    case 4:
      return "M" + at(0, 1.2) + "L" + at(1.1, -0.8) + "L" + at(-1.1, -0.8) + "Z";
    case 5:
      return "M" + at(-0.4, -1.2) + "L" + at(0.4, -1.2) + "L" + at(0.4, -0.4) + "L" +
             at(1.2, -0.4) + "L" + at(1.2, 0.4) + "L" + at(0.4, 0.4) + "L" + at(0.4, 1.2) + "L" +
             at(-0.4, 1.2) + "L" + at(-0.4, 0.4) + "L" + at(-1.2, 0.4) + "L" + at(-1.2, -0.4) +
             "L" + at(-0.4, -0.4) + "Z";
    default:
      return "M" + at(-1, 0) + "a" + pixels(r) + " " + pixels(r) + " 0 1 0 " + pixels(2 * r) +
             " 0a" + pixels(r) + " " + pixels(r) + " 0 1 0 " + pixels(-2 * r) + " 0Z";
  }
}
}  // namespace

std::string pixels(double value) { return kPen.pixels(value); }

std::string series_line(std::size_t series, double width) {
  const std::size_t color = series % kSeriesColors.size();
  const char* dash = kDashes[series / kSeriesColors.size() % kDashes.size()];
  return attribute("class", "s" + std::to_string(color)) + attribute("fill", "none") +
         attribute("stroke", kSeriesColors[color].light) +
         attribute("stroke-width", pixels(width)) +
         (*dash != '\0' ? attribute("stroke-dasharray", dash) : "");
}

std::string series_fill(std::size_t series) {
  const std::size_t color = series % kSeriesColors.size();
  return attribute("class", "f" + std::to_string(color)) +
         attribute("fill", kSeriesColors[color].light);
}

std::string series_fill_pale(std::size_t series) {
  return series_fill(series) + attribute("fill-opacity", "0.28");
}

std::string ink_line(double width) {
  return attribute("class", "ink_line") + attribute("fill", "none") + attribute("stroke", kInk) +
         attribute("stroke-width", pixels(width));
}

std::string outcome_fill(std::string_view outcome) {
  return attribute("fill", *outcome_look(outcome).pattern == '\0'
                               ? outcome_look(outcome).color
                               : "url(#o_" + slug(outcome) + ")");
}

std::string outcome_patterns(const std::vector<std::string>& outcomes) {
  std::string out = "<defs>\n";
  for (const std::string& outcome : outcomes) {
    const OutcomeLook& look = outcome_look(outcome);
    if (*look.pattern != '\0') {
      out += "<pattern id=\"o_" + slug(outcome) +
             "\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\"><rect width=\"8\" "
             "height=\"8\" fill=\"" +
             look.color + "\"/><path d=\"" + look.pattern +
             "\" stroke=\"#fff\" stroke-width=\"1.3\" stroke-opacity=\"0.75\"/></pattern>\n";
    }
  }
  return out + "</defs>\n";
}

void Canvas::text(double x, double y, std::string_view text, std::string_view kind, Anchor anchor) {
  std::string paint = attribute("class", kind) + attribute("fill", kind == "quiet" ? kQuiet : kInk);
  if (kind == "strong") {
    paint += attribute("font-weight", "600");
  }
  if (anchor != Anchor::start) {
    paint += attribute("text-anchor", anchor == Anchor::end ? "end" : "middle");
  }
  body_ += kPen.text(x, y, html(text), paint);
}

void Canvas::line(double x0, double y0, double x1, double y1, std::string_view kind) {
  const char* color = kind == "hair" ? kHair : kind == "quiet_line" ? kQuiet : kInk;
  body_ += kPen.line(x0, y0, x1, y1,
                     attribute("class", kind) + attribute("stroke", color) +
                         (kind == "reference" ? attribute("stroke-dasharray", "4 3") : ""));
}

void Canvas::rectangle(double x, double y, double width, double height, const std::string& paint,
                       const std::string& tip) {
  body_ += kPen.rectangle(x, y, width, height, paint, html(tip));
}

void Canvas::path(const std::string& d, const std::string& paint) { body_ += kPen.path(d, paint); }

void Canvas::mark(double x, double y, std::size_t series, double size, const std::string& tip) {
  body_ += kPen.path(mark_path(series, x, y, size), series_fill(series), html(tip));
}

void Canvas::point(double x, double y, std::size_t series, std::size_t run,
                   const std::string& tip) {
  body_ += "<path data-open=\"run " + std::to_string(run) + "\" d=\"" +
           mark_path(series, x, y, 2.8) + "\"" + attribute("fill-opacity", "0.75") +
           series_fill(series) + "><title>" + html(tip) + "</title></path>\n";
}

std::string figure_style() {
  std::string out =
      ".figure text{font:12.5px system-ui,\"Segoe UI\",Roboto,\"DejaVu Sans\",sans-serif;"
      "font-variant-numeric:tabular-nums;paint-order:stroke;stroke:var(--fp);"
      "stroke-width:4px;stroke-linejoin:round}\n";
  const auto colors = [](bool dark) {
    std::string rules;
    for (std::size_t at = 0; at < kSeriesColors.size(); ++at) {
      rules += "--c" + std::to_string(at) + ":" +
               (dark ? kSeriesColors[at].dark : kSeriesColors[at].light) + ";";
    }
    return rules + (dark ? "--fi:#e6eaef;--fq:#9aa5b1;--fh:#2f3741;--fp:#14181d"
                         : "--fi:#1b2430;--fq:#5d6875;--fh:#dde1e6;--fp:#ffffff");
  };
  out += "svg.figure{" + colors(false) + "}\n@media (prefers-color-scheme: dark){svg.figure{" +
         colors(true) + "}}\n";
  for (std::size_t at = 0; at < kSeriesColors.size(); ++at) {
    const std::string n = std::to_string(at);
    out += ".figure .s" + n + "{stroke:var(--c" + n + ")}.figure .f" + n + "{fill:var(--c" + n +
           ")}\n";
  }
  return out +
         ".figure .ink,.figure .strong{fill:var(--fi)}.figure .quiet{fill:var(--fq)}\n"
         ".figure .strong{font-weight:600}.figure .paper{fill:var(--fp)}\n"
         ".figure .hair{stroke:var(--fh)}.figure .quiet_line{stroke:var(--fq)}\n"
         ".figure .ink_line,.figure .reference{stroke:var(--fi)}\n"
         ".figure .track{fill:var(--fh);fill-opacity:.6}\n";
}

std::string svg_text(const Figure& figure, bool inlined) {
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 " +
                    kPen.at(figure.width, figure.height) +
                    "\" role=\"img\" font-family=\"system-ui, 'DejaVu Sans', sans-serif\" "
                    "font-size=\"12.5\"";
  if (inlined) {
    out += " aria-label=\"" + html(figure.title) + "\">\n";
  } else {
    out += " width=\"" + pixels(figure.width) + "\" height=\"" + pixels(figure.height) +
           "\">\n<title>" + html(figure.title) + "</title>\n<desc>" + html(figure.caption) +
           "</desc>\n<style>\n" + figure_style() + "</style>\n<rect class=\"paper\" width=\"" +
           pixels(figure.width) + "\" height=\"" + pixels(figure.height) +
           "\" fill=\"#ffffff\"/>\n";
  }
  return out + figure.body + "</svg>\n";
}
}  // namespace altiplan::study::report
