// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace altiplan::study::report {

/// assets/report.css and assets/report.js, embedded in the program.
std::string_view page_style();
std::string_view page_script();
}  // namespace altiplan::study::report
