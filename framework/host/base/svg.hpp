// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace altiplan::host {

/// An attribute of an element: ` name="value"`, the value as it is.
std::string attribute(std::string_view name, std::string_view value);

/// Writes SVG elements, one a line. Lengths are rounded to tenths of a pixel; paints are
/// attributes, each after a blank; `title` is what a pointer over the element shows. Texts are
/// escaped already.
class SvgPen {
 public:
  /// Trimmed: "12" and not "12.0".
  constexpr explicit SvgPen(bool is_trimmed) : is_trimmed_(is_trimmed) {}

  std::string pixels(double value) const;
  /// "12.0 3.4"
  std::string at(double x, double y) const { return pixels(x) + " " + pixels(y); }
  /// A corner of a path, its first if that is empty.
  std::string corner(const std::string& path, double x, double y) const {
    return (path.empty() ? "M" : "L") + at(x, y);
  }

  std::string path(const std::string& d, const std::string& paint,
                   const std::string& title = "") const;
  std::string line(double x0, double y0, double x1, double y1, const std::string& paint) const {
    return path("M" + at(x0, y0) + "L" + at(x1, y1), paint);
  }
  std::string rectangle(double x, double y, double width, double height, const std::string& paint,
                        const std::string& title = "") const;
  std::string circle(double x, double y, double radius, const std::string& paint) const;
  std::string text(double x, double y, std::string_view text, const std::string& paint) const;

 private:
  bool is_trimmed_;
};
}  // namespace altiplan::host
