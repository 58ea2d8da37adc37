// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "host/base/utf8.hpp"
#include "host/base/words.hpp"

namespace altiplan::study::report {

// Names of scenarios and messages of plugins may hold any bytes. Everything that goes into a file
// of the report passes through one of these.

using host::counted;
using host::printable;

/// For HTML and SVG, between tags and within quoted attributes.
std::string html(std::string_view text);
/// As `html`, with the line ends.
std::string html_lines(std::string_view text);
std::string latex(std::string_view text);
/// A cell of a Markdown table, shown as it is: nothing in it is markup.
std::string markdown(std::string_view text);
/// A field of RFC 4180; one that a spreadsheet would take for a formula is quoted with a blank
/// before it.
std::string csv(std::string_view text);
/// One word for a POSIX shell.
std::string shell(std::string_view text);
/// A name for a file or an element: letters, digits, '-' and '.'; others become '-'.
std::string slug(std::string_view text);

/// As much as fits in so many characters, with an ellipsis in its middle; for printable text.
std::string shortened(const std::string& text, std::size_t most);
/// Characters of UTF-8.
std::size_t characters(std::string_view text);

/// The shortest text that reads back as this number; "" for NaN.
std::string exact(double value);
/// With so many digits that matter, a dash where it is not finite: "1,234", "0.0123", "1.2e-9".
std::string readable(double value, int digits = 4);
/// As `readable`; what is noise of the arithmetic as what it stands for: a turn of 1e-13 degrees as
/// "0", a radius of 1e15 metres as "straight".
std::string readable_value(std::string_view metric, double value, int digits = 4);
/// 0 for such noise, else the value.
double without_noise(std::string_view metric, double value);
/// Whether it is a radius so great that nothing turns.
bool is_straight(std::string_view metric, double value);
/// "98.2 %".
std::string percent(double share);
/// "1,234".
std::string grouped(std::size_t count);
/// A p-value: "0.013", "< 0.0001".
std::string p_text(double p);
/// "p = 0.013", "p < 0.0001".
std::string p_equals(double p);

/// "plan_time_s" → "Plan time", "steps.route.length_m" → "Length of step route".
std::string metric_title(std::string_view metric);
/// The unit by the end of the name: "s", "m", "°", "MB", …; "" without one.
std::string metric_unit(std::string_view metric);
/// "Plan time, s".
std::string metric_label(std::string_view metric);
/// Whether the value is a measurement that differs from run to run.
bool varies(std::string_view metric);

/// Order in which people read numbered names: hills[seed=2] before hills[seed=10].
bool natural_less(std::string_view a, std::string_view b);
}  // namespace altiplan::study::report
