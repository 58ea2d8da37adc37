// SPDX-License-Identifier: Apache-2.0
#include "host/view/viewer_page.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host/base/base64.hpp"

// The page is embedded in the program, so that it need not be located: the assembler copies the
// file named by ALTIPLAN_VIEWER_PAGE between two symbols.
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

namespace {

/// Shorter lists are not worth packing.
constexpr std::size_t kLongList = 64;
constexpr double kPerUnit = 1000;
constexpr double kMaxUnits = 0x1p45;

/// True if the value is a whole number of thousandths, or null.
bool is_packable(const Json& value) {
  if (value.is_null()) {
    return true;
  }
  if (!value.is_number()) {
    return false;
  }
  const auto number = value.get<double>();
  const double units = std::round(number * kPerUnit);
  return std::abs(units) < kMaxUnits && units / kPerUnit == number;
}

/// Whole numbers, seven bits per byte.
class Tokens {
 public:
  void add(std::uint64_t token) {
    if (token == last_) {
      ++repeats_;
      return;
    }
    end_run();
    last_ = token;
    write(token);
  }
  std::vector<std::byte> bytes() {
    end_run();
    return std::move(bytes_);
  }

 private:
  void end_run() {
    if (repeats_ > 2) {
      write(1);
      write(repeats_);
      repeats_ = 0;
    }
    for (; repeats_ > 0; --repeats_) {
      write(last_);
    }
  }
  void write(std::uint64_t token) {
    for (; token >= 128; token >>= 7) {
      bytes_.push_back(std::byte((token & 127) | 128));
    }
    bytes_.push_back(std::byte(token));
  }

  std::vector<std::byte> bytes_;
  std::uint64_t last_ = 1;  // which no number equals
  std::uint64_t repeats_ = 0;
};

/// Consecutive thousandths, each as its difference from a prediction: equal to the last one (order
/// 1), or continuing its change (order 2). 0 is null, 1 and a count repeat the last one that often,
/// 2 and above are the differences 0, -1, 1, -2, …
std::vector<std::byte> differences(const Json& list, std::size_t per, int order) {
  Tokens tokens;
  for (std::size_t axis = 0; axis < std::max<std::size_t>(per, 1); ++axis) {
    std::int64_t last = 0;
    std::int64_t step = 0;
    for (const Json& item : list) {
      const Json& value = per == 0 ? item : item[axis];
      if (value.is_null()) {
        tokens.add(0);
        continue;
      }
      const auto units = std::int64_t(std::round(value.get<double>() * kPerUnit));
      const std::int64_t off = units - last - step;
      tokens.add(off < 0 ? 2 * std::uint64_t(-off) + 1 : 2 * std::uint64_t(off) + 2);
      step = order == 2 ? units - last : 0;
      last = units;
    }
  }
  return tokens.bytes();
}

/// Number of coordinates per item of a list of points, 0 for a list of numbers; nothing if it is
/// neither, or short, or has values that are not whole thousandths.
std::optional<std::size_t> numbers_per_item(const Json& list) {
  if (list.size() < kLongList) {
    return std::nullopt;
  }
  const std::size_t per = list[0].is_array() ? list[0].size() : 0;
  for (const Json& item : list) {
    const bool fits = item.is_array() ? per > 0 && item.size() == per &&
                                            std::all_of(item.begin(), item.end(), is_packable)
                                      : per == 0 && is_packable(item);
    if (!fits) {
      return std::nullopt;
    }
  }
  return per;
}

/// The scene with its long lists of numbers packed for tools/viewer/src/packed.js.
Json packed(const Json& json) {
  if (json.is_object()) {
    Json result = Json::object();
    for (const auto& [key, value] : json.items()) {
      result[key] = packed(value);
    }
    return result;
  }
  if (!json.is_array()) {
    return json;
  }
  if (const auto per = numbers_per_item(json)) {
    std::vector<std::byte> bytes = differences(json, *per, 1);
    const std::vector<std::byte> second = differences(json, *per, 2);
    const int order = second.size() < bytes.size() ? 2 : 1;
    return {{"packed", base64(order == 2 ? second : bytes)},
            {"count", json.size()},
            {"per", *per},
            {"order", order}};
  }
  Json result = Json::array();
  for (const Json& item : json) {
    result.push_back(packed(item));
  }
  return result;
}
}  // namespace

std::string_view viewer_template() {
  return {altiplan_viewer_page, std::size_t(altiplan_viewer_page_end - altiplan_viewer_page)};
}

std::string viewer_page(const Json& scene) {
  const std::string text = json_text(packed(scene));
  const std::string_view around = viewer_template();
  const std::size_t place = around.find(kScenePlace);
  std::string page;
  page.reserve(around.size() + text.size());
  page += around.substr(0, place);
  for (const char letter : text) {
    // Escaped, so that nothing in a scene can end the script element around it.
    letter == '<' ? page += "\\u003c" : page += letter;
  }
  page += around.substr(place + kScenePlace.size());
  return page;
}
}  // namespace altiplan::host
