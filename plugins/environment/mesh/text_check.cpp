// SPDX-License-Identifier: Apache-2.0
#include "text_check.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::mesh {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";

/// A file's lines, split into words.
class Lines {
 public:
  Lines(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  /// The words of the next non-empty line; false at the end.
  bool next(std::vector<std::string_view>& words) {
    words.clear();
    while (words.empty() && begin_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
      line_ = text_.substr(begin_, end - begin_);
      begin_ = end + 1;
      ++number_;
      for (std::size_t at = line_.find_first_not_of(kBlank); at != line_.npos;) {
        const std::size_t stop = std::min(line_.find_first_of(kBlank, at), line_.size());
        words.push_back(line_.substr(at, stop - at));
        at = line_.find_first_not_of(kBlank, stop);
      }
    }
    return !words.empty();
  }
  [[noreturn]] void refuse(const std::string& expected) const {
    std::string found(line_.substr(0, 60));
    for (char& letter : found) {
      letter = letter < ' ' || letter > '~' ? '?' : letter;
    }
    throw ParameterError("file", file_ + ":" + std::to_string(number_) + ": expected " + expected +
                                     ", found '" + found + "'");
  }
  void count(std::int64_t triangles, std::int64_t max_triangles) const {
    if (triangles > max_triangles) {
      throw ParameterError("max_triangles", file_ + ":" + std::to_string(number_) +
                                                ": has more triangles than max_triangles (" +
                                                std::to_string(max_triangles) + ")");
    }
  }

 private:
  const std::string& file_;
  std::string_view text_;
  std::string_view line_;
  std::size_t begin_ = 0;
  int number_ = 0;
};

using Words = std::vector<std::string_view>;

/// A finite number and nothing else; some programs write a leading +.
bool is_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
  }
  float value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && stop == word.data() + word.size() &&
         word.find_first_of("nN") == word.npos;
}

bool are_numbers(const Words& words, std::size_t from) {
  for (std::size_t i = from; i < words.size(); ++i) {
    if (!is_number(words[i])) {
      return false;
    }
  }
  return true;
}

/// Required contents of a facet's lines, after `facet`.
struct Expected {
  const char* text;
  std::size_t words;
  std::size_t numbers;  ///< the last of the words
};
constexpr Expected kFacet[] = {{"facet normal", 5, 3}, {"outer loop", 2, 0}, {"vertex", 4, 3},
                               {"vertex", 4, 3},       {"vertex", 4, 3},     {"endloop", 1, 0},
                               {"endfacet", 1, 0}};

bool is(const Words& words, const Expected& expected) {
  std::string start;
  for (std::size_t i = 0; i + expected.numbers < words.size(); ++i) {
    start += (i > 0 ? " " : "") + std::string(words[i]);
  }
  return words.size() == expected.words && start == expected.text &&
         are_numbers(words, expected.words - expected.numbers);
}

/// Statements that do not affect a solid's surface.
constexpr std::string_view kLooks[] = {"vn", "vt", "o", "g", "s", "l", "p", "usemtl", "mtllib"};

/// The index of a face's corner, before its texture and normal.
std::string_view vertex_of(std::string_view corner) { return corner.substr(0, corner.find('/')); }

bool is_vertex_of(std::string_view word, std::int64_t vertices) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && stop == word.data() + word.size() && number != 0 &&
         number <= vertices && number >= -vertices;
}
}  // namespace

void check_stl_text(const std::string& file, const std::string& text, std::int64_t max_triangles) {
  Lines lines(file, text);
  Words words;
  std::int64_t triangles = 0;
  std::int64_t solids = 0;
  bool is_open = false;
  while (lines.next(words)) {
    if (!is_open) {
      if (words[0] != "solid") {
        lines.refuse("'solid'");
      }
      is_open = true;
      lines.count(++solids, max_triangles);
    } else if (words[0] == "endsolid") {
      is_open = false;
    } else {
      for (const Expected& expected : kFacet) {
        if ((&expected != kFacet && !lines.next(words)) || !is(words, expected)) {
          lines.refuse("'" + std::string(expected.text) + "'" +
                       (expected.numbers > 0 ? " and three numbers" : ""));
        }
      }
      lines.count(++triangles, max_triangles);
    }
  }
  if (is_open) {
    lines.refuse("'endsolid' at the end");
  }
}

std::string obj_without_looks(const std::string& file, const std::string& text,
                              std::int64_t max_triangles) {
  Lines lines(file, text);
  Words words;
  std::string kept;
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  while (lines.next(words)) {
    if (words[0] == "v") {
      if ((words.size() != 4 && words.size() != 7) || !are_numbers(words, 1)) {
        lines.refuse("'v' and three numbers, or six with a colour");
      }
      ++vertices;
    } else if (words[0] == "f") {
      bool is_face = words.size() >= 4 && words.size() <= kMaxCorners + 1;
      for (std::size_t i = 1; is_face && i < words.size(); ++i) {
        is_face = is_vertex_of(vertex_of(words[i]), vertices);
      }
      if (!is_face) {
        lines.refuse("'f' and 3 to " + std::to_string(kMaxCorners) + " of the vertices before it");
      }
      triangles += std::int64_t(words.size()) - 3;
      lines.count(triangles, max_triangles);
    } else if (words[0].starts_with('#') ||
               std::find(std::begin(kLooks), std::end(kLooks), words[0]) != std::end(kLooks)) {
      continue;
    } else {
      lines.refuse("a statement of an OBJ file (v, f, vn, vt, o, g, s, usemtl, …)");
    }
    const std::size_t maximum = words[0] == "v" ? 4 : words.size();
    for (std::size_t i = 0; i < maximum; ++i) {
      kept += vertex_of(words[i]);
      kept += i + 1 < maximum ? ' ' : '\n';
    }
  }
  return kept;
}
}  // namespace altiplan::mesh
