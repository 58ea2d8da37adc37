// SPDX-License-Identifier: Apache-2.0
#include "study/drawing/text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>
#include <vector>

namespace altiplan::study::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// Length of the character of UTF-8 that stands at the front, 0 where none does.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) {
    return 1;
  }
  const std::size_t length = lead >= 0xF5   ? 0
                             : lead >= 0xF0 ? 4
                             : lead >= 0xE0 ? 3
                             : lead >= 0xC2 ? 2
                                            : 0;
  if (length == 0 || text.size() < length) {
    return 0;
  }
  std::uint32_t code = lead & (0xFFu >> (length + 1));
  for (std::size_t at = 1; at < length; ++at) {
    if ((byte(at) & 0xC0) != 0x80) {
      return 0;
    }
    code = code << 6 | (byte(at) & 0x3Fu);
  }
  const bool too_long = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool no_character = (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF;
  return too_long || no_character ? 0 : length;
}

/// Line and paragraph separators, C1 controls, and what turns the direction of writing.
bool hidden_control(std::string_view character) {
  if (character.size() == 2 && character[0] == '\xC2') {
    return static_cast<unsigned char>(character[1]) < 0xA0;
  }
  if (character.size() == 3 && character.substr(0, 2) == "\xE2\x80") {
    const auto last = static_cast<unsigned char>(character[2]);
    return last >= 0xA8 && last <= 0xAE;
  }
  return character.size() == 3 && character.substr(0, 2) == "\xE2\x81" &&
         static_cast<unsigned char>(character[2]) >= 0xA6 &&
         static_cast<unsigned char>(character[2]) <= 0xA9;
}

bool is_number(std::string_view text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

std::string replaced(std::string_view text,
                     const std::vector<std::pair<char, std::string_view>>& pairs) {
  std::string out;
  for (const char letter : text) {
    const auto found = std::find_if(pairs.begin(), pairs.end(),
                                    [&](const auto& pair) { return pair.first == letter; });
    found == pairs.end() ? out += letter : out += found->second;
  }
  return out;
}

const std::vector<std::pair<char, std::string_view>> kHtml{
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};

const std::vector<std::pair<char, std::string_view>> kLatex{{'\\', "\\textbackslash{}"},
                                                            {'{', "\\{"},
                                                            {'}', "\\}"},
                                                            {'_', "\\_"},
                                                            {'%', "\\%"},
                                                            {'&', "\\&"},
                                                            {'$', "\\$"},
                                                            {'#', "\\#"},
                                                            {'~', "\\textasciitilde{}"},
                                                            {'^', "\\textasciicircum{}"},
                                                            {'<', "\\textless{}"},
                                                            {'>', "\\textgreater{}"},
                                                            {'|', "\\textbar{}"},
                                                            {'"', "\\textquotedbl{}"},
                                                            {'\'', "\\textquotesingle{}"},
                                                            {'`', "\\textasciigrave{}"},
                                                            {'[', "{[}"},
                                                            {']', "{]}"}};
}  // namespace

std::string printable(std::string_view bytes, bool keep_lines) {
  std::string out;
  out.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::size_t length = character_length(bytes);
    const std::string_view character = bytes.substr(0, std::max<std::size_t>(length, 1));
    const auto letter = static_cast<unsigned char>(character[0]);
    if (length == 0) {
      out += kReplacement;
    } else if (letter < ' ' || letter == 0x7F) {
      out += keep_lines && (letter == '\n' || letter == '\t') ? character[0] : ' ';
    } else if (hidden_control(character)) {
      out += ' ';
    } else {
      out += character;
    }
    bytes.remove_prefix(character.size());
  }
  return out;
}

std::string html(std::string_view text) { return replaced(printable(text), kHtml); }

std::string html_lines(std::string_view text) { return replaced(printable(text, true), kHtml); }

std::string latex(std::string_view text) { return replaced(printable(text), kLatex); }

std::string markdown(std::string_view text) {
  std::string out;
  for (const char letter : replaced(printable(text), {{'&', "&amp;"}, {'<', "&lt;"}})) {
    if (std::string_view("\\`*_[]{}|~$#!>@").find(letter) != std::string_view::npos) {
      out += '\\';
    }
    out += letter;
  }
  return out;
}

std::string csv(std::string_view text) {
  std::string clean = printable(text);
  if (!clean.empty() && std::string_view("=+-@").find(clean[0]) != std::string_view::npos &&
      !is_number(clean)) {
    clean.insert(0, " ");
  }
  if (clean.find_first_of(",\"") == std::string::npos && !clean.starts_with(' ')) {
    return clean;
  }
  return "\"" + replaced(clean, {{'"', "\"\""}}) + "\"";
}

std::string shell(std::string_view text) {
  const std::string clean = printable(text);
  const bool plain = !clean.empty() && std::all_of(clean.begin(), clean.end(), [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9') ||
           std::string_view("-_./=:,+@").find(letter) != std::string_view::npos;
  });
  return plain ? clean : "'" + replaced(clean, {{'\'', "'\\''"}}) + "'";
}

std::string slug(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    const bool kept = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                      (letter >= '0' && letter <= '9') || letter == '.' || letter == '_';
    if (kept || (!out.empty() && out.back() != '-')) {
      out += kept ? letter : '-';
    }
  }
  while (out.ends_with('-') || out.ends_with('.')) {
    out.pop_back();
  }
  out.erase(0, std::min(out.size(), out.find_first_not_of(".-")));
  return out.empty() ? "unnamed" : out.substr(0, 80);
}

std::size_t characters(std::string_view text) {
  return std::size_t(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string shortened(const std::string& text, std::size_t most) {
  const std::size_t count = characters(text);
  if (count <= most) {
    return text;
  }
  const auto first_bytes = [&](std::size_t wanted) {
    std::size_t at = 0;
    while (at < text.size() && wanted > 0) {
      at += std::max<std::size_t>(1, character_length(std::string_view(text).substr(at)));
      --wanted;
    }
    return at;
  };
  const std::size_t head = most / 2;
  const std::size_t tail = most - head - 1;
  return text.substr(0, first_bytes(head)) + "…" + text.substr(first_bytes(count - tail));
}

bool natural_less(std::string_view a, std::string_view b) {
  const auto digit = [](char letter) { return letter >= '0' && letter <= '9'; };
  const auto number = [&](std::string_view text, std::size_t from) {
    std::size_t end = from;
    while (end < text.size() && digit(text[end])) {
      ++end;
    }
    const std::size_t first = std::min(text.find_first_not_of('0', from), end);
    return std::pair(text.substr(first, end - first), end);
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const auto [left, left_end] = number(a, i);
      const auto [right, right_end] = number(b, j);
      if (left.size() != right.size()) {
        return left.size() < right.size();
      }
      if (left != right) {
        return left < right;
      }
      i = left_end;
      j = right_end;
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i;
      ++j;
    }
  }
  return (a.size() - i) != (b.size() - j) ? a.size() - i < b.size() - j : a < b;
}
}  // namespace altiplan::study::report
