// SPDX-License-Identifier: Apache-2.0
#include "host/output/viewer_page.hpp"

// The page is part of the program, so that it need not be looked for: the assembler copies the file
// that ALTIPLAN_VIEWER_PAGE names in between two symbols.
asm(".pushsection .rodata\n"
    "altiplan_viewer_page:\n"
    ".incbin \"" ALTIPLAN_VIEWER_PAGE
    "\"\n"
    "altiplan_viewer_page_end:\n"
    ".byte 0\n"
    ".globl altiplan_viewer_page, altiplan_viewer_page_end\n"
    ".hidden altiplan_viewer_page, altiplan_viewer_page_end\n"
    ".popsection\n");
extern "C" {
extern const char altiplan_viewer_page[];      // NOLINT(readability-identifier-naming)
extern const char altiplan_viewer_page_end[];  // NOLINT(readability-identifier-naming)
}

namespace altiplan::host {

std::string_view viewer_template() {
  return {altiplan_viewer_page, std::size_t(altiplan_viewer_page_end - altiplan_viewer_page)};
}

std::string viewer_page(const Json& scene) {
  const std::string text = scene.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string_view around = viewer_template();
  const std::size_t place = around.find(kScenePlace);
  std::string page;
  page.reserve(around.size() + text.size());
  page += around.substr(0, place);
  for (const char letter : text) {
    // Nothing in a scene can end the script that holds it.
    letter == '<' ? page += "\\u003c" : page += letter;
  }
  page += around.substr(place + kScenePlace.size());
  return page;
}
}  // namespace altiplan::host
