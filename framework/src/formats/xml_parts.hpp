// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "mission_parts.hpp"
#include "text_file.hpp"

/// \file Common parts of the readers of KML and GPX.
namespace altiplan::formats {

inline constexpr int kMaxXmlDepth = 64;

/// An element's name without its prefix ("kml:Point").
inline std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

inline pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& c) { return local_name(c) == name; });
}

/// The same of one that there may be once. Throws Error if there are more.
inline pugi::xml_node only_child(const pugi::xml_node& node, std::string_view name) {
  const pugi::xml_node found = child(node, name);
  for (pugi::xml_node other = found.next_sibling(); other; other = other.next_sibling()) {
    if (local_name(other) == name) {
      throw Error("expected one element '" + std::string(name) + "', found more");
    }
  }
  return found;
}

inline std::string_view trimmed(std::string_view text) {
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

inline std::string_view text_of(const pugi::xml_node& node, std::string_view name) {
  return trimmed(only_child(node, name).text().get());
}

/// Makes one text of what comments, processing instructions and CDATA leave in parts.
inline void merge_texts(pugi::xml_document& document) {
  struct Merge : pugi::xml_tree_walker {
    static bool is_text(const pugi::xml_node& node) {
      return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
    }
    bool for_each(pugi::xml_node& node) override {
      if (is_text(node) && is_text(node.next_sibling())) {
        std::string text = node.value();
        while (is_text(node.next_sibling())) {
          text += node.next_sibling().value();
          node.parent().remove_child(node.next_sibling());
        }
        node.set_value(text.c_str());
      }
      return true;
    }
  } merge;
  document.traverse(merge);
}

inline double number_of(std::string_view text) {
  double value = 0;
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw Error("expected a number, found '" + std::string(text.substr(0, 40)) + "'");
  }
  return value;
}

/// Passes every element to a reader; the children of an element that it took are skipped.
template <class Reader>
class XmlWalk : public pugi::xml_tree_walker {
 public:
  XmlWalk(Reader& reader, const std::string& file, const std::string& text)
      : reader_(reader), file_(file), text_(text) {}

  bool for_each(pugi::xml_node& node) override {
    const auto line = [&] {
      return std::to_string(
          line_at(text_, std::size_t(std::max<std::ptrdiff_t>(node.offset_debug(), 0))));
    };
    if (depth() > kMaxXmlDepth) {
      throw Error(file_ + ":" + line() + ": elements are nested more than " +
                  std::to_string(kMaxXmlDepth) + " levels deep");
    }
    if (node.type() != pugi::node_element) {
      return true;
    }
    if (depth() > taken_at_) {
      return true;
    }
    taken_at_ = kMaxXmlDepth + 1;
    try {
      if (reader_.take(node)) {
        taken_at_ = depth();
      }
    } catch (const Error& error) {
      throw Error(file_ + ":" + line() + ": " + error.what());
    }
    return true;
  }

 private:
  Reader& reader_;
  const std::string& file_;
  const std::string& text_;
  int taken_at_ = kMaxXmlDepth + 1;
};

template <class Reader>
void read_elements(MissionFile& mission, const pugi::xml_node& root, const std::string& file,
                   const std::string& text) {
  Reader reader(mission);
  XmlWalk<Reader> walk(reader, file, text);
  pugi::xml_node(root).traverse(walk);
  reader.finish();
}
}  // namespace altiplan::formats
