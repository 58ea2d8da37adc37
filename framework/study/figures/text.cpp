// SPDX-License-Identifier: Apache-2.0
#include "study/figures/text.hpp"

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

namespace altiplan::study::report {
namespace {

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

std::string shortened(const std::string& text, std::size_t max_characters) {
  const std::size_t count = characters(text);
  if (count <= max_characters) {
    return text;
  }
  const auto first_bytes = [&](std::size_t wanted) {
    std::size_t at = 0;
    while (at < text.size() && wanted > 0) {
      at += std::max<std::size_t>(1, host::utf8_length(std::string_view(text).substr(at)));
      --wanted;
    }
    return at;
  };
  const std::size_t head = max_characters / 2;
  const std::size_t tail = max_characters - head - 1;
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
