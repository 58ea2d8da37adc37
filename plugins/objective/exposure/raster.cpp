// SPDX-License-Identifier: Apache-2.0
#include "raster.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"

namespace exposure {
namespace {
using altiplan::Error;

constexpr std::uintmax_t kMaxBytes = 2'000'000'000;

/// The words of a text, with their lines.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// "" at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) {
      line_ += text_[at_++] == '\n' ? 1 : 0;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) {
      ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }
  std::string_view peek() {
    const auto [at, line] = std::pair(at_, line_);
    const std::string_view word = next();
    at_ = at;
    line_ = line;
    return word;
  }
  double number(const std::string& what) {
    const std::string_view word = next();
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) {
      throw Error("line " + std::to_string(line_) + ": expected " + what + ", found " +
                  (word.empty() ? "the end of the file" : altiplan::excerpt(word)));
    }
    return value;
  }
  int line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The keys before the values, in small letters.
class Header {
 public:
  explicit Header(Words& words) {
    while (!words.peek().empty() &&
           std::isalpha(static_cast<unsigned char>(words.peek()[0])) != 0) {
      std::string key(words.next());
      std::transform(key.begin(), key.end(), key.begin(),
                     [](unsigned char c) { return char(std::tolower(c)); });
      if (key == "nan") {
        throw Error("line " + std::to_string(words.line()) +
                    ": nan stands where a key is expected");
      }
      keys_[key] = words.number("a number after " + key);
    }
  }
  std::optional<double> find(const std::string& key) const {
    const auto found = keys_.find(key);
    return found == keys_.end() ? std::nullopt : std::optional(found->second);
  }
  double at(const std::string& key) const {
    const auto value = find(key);
    if (!value) {
      throw Error("the header has no " + key + ": expected an ESRI ASCII grid");
    }
    return *value;
  }
  int count(const std::string& key) const {
    const double value = at(key);
    if (!(value >= 2 && value <= 1e6 && value == std::floor(value))) {
      throw Error(key + " is " + std::to_string(value) +
                  ", expected a whole number from 2 to 1,000,000");
    }
    return int(value);
  }

 private:
  std::map<std::string, double> keys_;
};
}  // namespace

Raster read_text_grid(const std::string& file) {
  std::string text;
  try {
    text = altiplan::formats::read_file(file, kMaxBytes);
  } catch (const altiplan::formats::InputError& error) {
    throw Error(error.why());
  }
  Words words(text);
  const Header header(words);
  Raster raster;
  raster.columns = header.count("ncols");
  raster.rows = header.count("nrows");
  const std::size_t cells = std::size_t(raster.columns) * std::size_t(raster.rows);
  if (cells > kMaxCells) {
    throw Error("has " + std::to_string(cells) + " cells, expected at most " +
                std::to_string(kMaxCells));
  }
  raster.step = {header.find("dx") ? header.at("dx") : header.at("cellsize"),
                 header.find("dy") ? header.at("dy") : header.at("cellsize")};
  if (!(raster.step[0] > 0 && raster.step[1] > 0)) {
    throw Error("cellsize is not positive");
  }
  for (const std::size_t axis : {0U, 1U}) {
    const std::string name = axis == 0 ? "x" : "y";
    const auto centre = header.find(name + "llcenter");
    raster.south_west[axis] =
        centre ? *centre : header.at(name + "llcorner") + raster.step[axis] / 2;
  }
  const float none = float(header.find("nodata_value").value_or(NAN));
  raster.values.resize(cells);
  for (int row = raster.rows - 1; row >= 0; --row) {  // the first line is the northernmost
    for (int column = 0; column < raster.columns; ++column) {
      const float value = float(words.number("the value of a cell"));
      raster.values[std::size_t(row) * std::size_t(raster.columns) + std::size_t(column)] =
          value == none ? NAN : value;
    }
  }
  if (!words.next().empty()) {
    throw Error("line " + std::to_string(words.line()) + ": more values than ncols times nrows");
  }
  return raster;
}

void expect_costs(const Raster& raster) {
  bool some = false;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    const float value = raster.values[i];
    if (value < 0 || std::isinf(value)) {
      const std::size_t columns = std::size_t(raster.columns);
      throw Error("the value of column " + std::to_string(i % columns) + ", row " +
                  std::to_string(std::size_t(raster.rows) - 1 - i / columns) +
                  " (from the north) is " + std::to_string(value) +
                  ", expected a finite number of at least 0");
    }
    some = some || value >= 0;
  }
  if (!some) {
    throw Error("has no value at all");
  }
}
}  // namespace exposure
