// SPDX-License-Identifier: Apache-2.0
#include "study/report/page_assets.hpp"

// The assembler embeds each file between two symbols, as for the viewer's page.
asm(".pushsection .rodata\n"
    "altiplan_report_style:\n"
    ".incbin \"" ALTIPLAN_REPORT_ASSETS
    "/report.css\"\n"
    "altiplan_report_style_end:\n"
    "altiplan_report_script:\n"
    ".incbin \"" ALTIPLAN_REPORT_ASSETS
    "/report.js\"\n"
    "altiplan_report_script_end:\n"
    ".byte 0\n"
    ".globl altiplan_report_style, altiplan_report_style_end\n"
    ".globl altiplan_report_script, altiplan_report_script_end\n"
    ".hidden altiplan_report_style, altiplan_report_style_end\n"
    ".hidden altiplan_report_script, altiplan_report_script_end\n"
    ".popsection\n");
extern "C" {
extern const char altiplan_report_style[];       // NOLINT(readability-identifier-naming)
extern const char altiplan_report_style_end[];   // NOLINT(readability-identifier-naming)
extern const char altiplan_report_script[];      // NOLINT(readability-identifier-naming)
extern const char altiplan_report_script_end[];  // NOLINT(readability-identifier-naming)
}

namespace altiplan::study::report {

std::string_view page_style() {
  return {altiplan_report_style, std::size_t(altiplan_report_style_end - altiplan_report_style)};
}

std::string_view page_script() {
  return {altiplan_report_script, std::size_t(altiplan_report_script_end - altiplan_report_script)};
}
}  // namespace altiplan::study::report
