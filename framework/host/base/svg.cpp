// SPDX-License-Identifier: Apache-2.0
#include "host/base/svg.hpp"

#include <cstdio>

namespace altiplan::host {
namespace {

std::string titled(const std::string& tag, const std::string& attributes,
                   const std::string& title) {
  const std::string open = "<" + tag + attributes;
  return title.empty() ? open + "/>\n" : open + "><title>" + title + "</title></" + tag + ">\n";
}
}  // namespace

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}

std::string SvgPen::pixels(double value) const {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.1f", value);
  std::string out(text, std::size_t(length));
  if (is_trimmed_ && out.ends_with(".0")) {
    out.resize(out.size() - 2);
  }
  return is_trimmed_ && out == "-0" ? "0" : out;
}

std::string SvgPen::path(const std::string& d, const std::string& paint,
                         const std::string& title) const {
  return titled("path", attribute("d", d) + paint, title);
}

std::string SvgPen::rectangle(double x, double y, double width, double height,
                              const std::string& paint, const std::string& title) const {
  return titled("rect",
                attribute("x", pixels(x)) + attribute("y", pixels(y)) +
                    attribute("width", pixels(width)) + attribute("height", pixels(height)) + paint,
                title);
}

std::string SvgPen::circle(double x, double y, double radius, const std::string& paint) const {
  return titled("circle",
                attribute("cx", pixels(x)) + attribute("cy", pixels(y)) +
                    attribute("r", pixels(radius)) + paint,
                "");
}

std::string SvgPen::text(double x, double y, std::string_view text,
                         const std::string& paint) const {
  return "<text" + attribute("x", pixels(x)) + attribute("y", pixels(y)) + paint + ">" +
         std::string(text) + "</text>\n";
}
}  // namespace altiplan::host
