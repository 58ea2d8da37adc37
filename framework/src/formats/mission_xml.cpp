// SPDX-License-Identifier: Apache-2.0
#include "xml_parts.hpp"

namespace altiplan::formats {

MissionFile read_kml_or_gpx(const std::string& file, const std::string& text) {
  pugi::xml_document document;
  // Entities of a document type are never expanded; such a file is refused anyway.
  const pugi::xml_parse_result parsed = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_auto);
  const auto at = [&](std::ptrdiff_t offset) {
    return file + ":" +
           std::to_string(line_at(text, std::size_t(std::max<std::ptrdiff_t>(offset, 0)))) + ": ";
  };
  if (!parsed) {
    throw Error(at(parsed.offset) + "is not XML: " + parsed.description());
  }
  merge_texts(document);
  for (const pugi::xml_node& node : document.children()) {
    if (node.type() == pugi::node_doctype) {
      throw Error(at(node.offset_debug()) + "a document type (<!DOCTYPE) is not accepted");
    }
  }
  const pugi::xml_node root = document.document_element();
  if (local_name(root) == "kml") {
    return read_kml(root, file, text);
  }
  if (local_name(root) == "gpx") {
    return read_gpx(root, file, text);
  }
  throw Error(at(root.offset_debug()) + "expected the element kml or gpx, found '" +
              std::string(local_name(root)) + "'");
}
}  // namespace altiplan::formats
