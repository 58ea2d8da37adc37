// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "host/base/utf8.hpp"
#include "host/base/words.hpp"

namespace altiplan::study::report {

// Names of scenarios and messages of plugins may contain any bytes. All text in a file of the
// report passes through one of these functions.

using host::characters;
using host::counted;
using host::grouped;
using host::printable;
using host::readable;

/// For HTML and SVG, between tags and within quoted attributes.
std::string html(std::string_view text);
/// As `html`, keeps line ends.
std::string html_lines(std::string_view text);
std::string latex(std::string_view text);
/// A cell of a Markdown table, with all markup escaped.
std::string markdown(std::string_view text);
/// A CSV field (RFC 4180); text that a spreadsheet would read as a formula is quoted with a leading
/// blank.
std::string csv(std::string_view text);
/// One word for a POSIX shell.
std::string shell(std::string_view text);
/// A name for a file or an element: letters, digits, '-' and '.'; others become '-'.
std::string slug(std::string_view text);

/// Shortened to that many characters, with an ellipsis in the middle; for printable text.
std::string shortened(const std::string& text, std::size_t max_characters);

/// The shortest text that reads back as this number; "" for NaN.
std::string exact(double value);
/// As `readable`, without rounding noise: a turn of 1e-13 degrees is "0", a radius of 1e15 metres
/// "straight".
std::string readable_value(std::string_view metric, double value, int digits = 4);
/// 0 for rounding noise, otherwise the value.
double without_noise(std::string_view metric, double value);
/// True if the value is a turn radius so large that the route is straight.
bool is_straight(std::string_view metric, double value);
/// "98.2 %".
std::string percent(double share);
/// A p-value: "0.013", "< 0.0001".
std::string p_text(double p);
/// "p = 0.013", "p < 0.0001".
std::string p_equals(double p);

/// "plan_time_s" → "Plan time", "steps.route.length_m" → "Length of step route".
std::string metric_title(std::string_view metric);
/// The unit by the suffix of the name: "s", "m", "°", "MB", …; "" without one.
std::string metric_unit(std::string_view metric);
/// "Plan time, s".
std::string metric_label(std::string_view metric);

/// Natural order of numbered names: hills[seed=2] before hills[seed=10].
bool natural_less(std::string_view a, std::string_view b);
}  // namespace altiplan::study::report
