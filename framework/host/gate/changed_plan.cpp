// SPDX-License-Identifier: Apache-2.0
#include "host/gate/changed_plan.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "altiplan/error.hpp"
#include "host/base/json.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr int kDegrees = 7;  // decimals: a centimetre, as autopilots store them
constexpr int kMetres = 3;

/// Where values stand in a text that is JSON, so that all else stays as it is.
class JsonText {
 public:
  struct Part {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  explicit JsonText(const std::string& text) : text_(text) {}

  std::string_view operator[](const Part& part) const {
    return std::string_view(text_).substr(part.begin, part.end - part.begin);
  }
  /// The value of that key or, of a list, of that number; none if there is none.
  std::optional<Part> in(const Part& whole, const std::string& key) const {
    const bool is_list = text_[whole.begin] == '[';
    std::size_t nth = 0;
    for (std::size_t at = next(whole.begin + 1); at + 1 < whole.end; ++nth) {
      bool is_it = is_list && std::to_string(nth) == key;
      if (!is_list) {
        const Part name{at, end_of(at)};
        is_it = (*this)[name] == "\"" + key + "\"";
        at = next(next(name.end) + 1);  // behind the colon
      }
      const Part value{at, end_of(at)};
      if (is_it) {
        return value;
      }
      at = next(next(value.end) + 1);  // behind the comma
    }
    return std::nullopt;
  }
  /// The value at "mission.items.3". Throws Error if there is none.
  Part at(const std::string& place) const {
    std::optional<Part> part = Part{std::min(text_.find('{'), text_.size()), text_.size()};
    for (std::string keys = place + "."; part && !keys.empty(); keys.erase(0, keys.find('.') + 1)) {
      part = in(*part, keys.substr(0, keys.find('.')));
    }
    if (!part) {
      throw Error("there is no '" + place + "' to change");
    }
    return *part;
  }

 private:
  std::size_t next(std::size_t at) const {
    return std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
  }
  /// Of the value that begins there.
  std::size_t end_of(std::size_t at) const {
    constexpr std::string_view kBehind = ",:]} \t\r\n";
    std::size_t depth = 0;
    do {
      if (text_[at] == '"') {
        for (++at; text_[at] != '"'; ++at) {
          at += text_[at] == '\\' ? 1 : 0;
        }
      }
      depth += text_[at] == '{' || text_[at] == '[' ? 1 : 0;
      depth -= text_[at] == '}' || text_[at] == ']' ? 1 : 0;
      ++at;
    } while (at < text_.size() && (depth > 0 || kBehind.find(text_[at]) == kBehind.npos));
    return at;
  }

  const std::string& text_;
};

/// A ground station's word for heights above home.
constexpr const char* kRelativeMode = "1";

std::string changed_json(const std::string& text, const PlanChanges& changes) {
  const JsonText json(text);
  std::vector<std::pair<JsonText::Part, std::string>> parts;
  const auto raise = [&](const std::optional<JsonText::Part>& part, double by_m) {
    const std::string_view old = part ? json[*part] : "null";
    double metres = 0;
    const auto read = std::from_chars(old.data(), old.data() + old.size(), metres);
    if (by_m != 0 && read.ec == std::errc()) {
      parts.emplace_back(*part, rounded_text(metres + by_m, kMetres));
    }
  };
  if (changes.home_raised_by_m != 0) {
    raise(json.at("mission.plannedHomePosition.2"), changes.home_raised_by_m);
  }
  for (const auto& [n, rise] : changes.rally) {
    raise(json.at("rallyPoints.points." + std::to_string(n) + ".2"), rise);
  }
  for (const ChangedItem& change : changes.items) {
    const JsonText::Part item = json.at(change.place);
    const bool old_form = json.in(item, "coordinate").has_value();
    const std::string list = change.place + (old_form ? ".coordinate." : ".params.");
    const int first = old_form ? 0 : 4;
    if (change.frame) {
      parts.emplace_back(json.at(change.place + ".frame"), std::to_string(*change.frame));
      if (const auto mode = json.in(item, "AltitudeMode")) {
        parts.emplace_back(*mode, kRelativeMode);
      }
    }
    if (change.lonlat) {
      for (const int axis : {0, 1}) {
        parts.emplace_back(json.at(list + std::to_string(first + axis)),
                           rounded_text(change.lonlat->at(std::size_t(1 - axis)), kDegrees));
      }
    }
    raise(json.at(list + std::to_string(first + 2)), change.raised_by_m);
    for (const char* key : {"Altitude", "AMSLAltAboveTerrain"}) {  // the ground station's own
      raise(json.in(item, key), change.raised_by_m);
    }
  }
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return a.first.begin > b.first.begin; });
  std::string changed = text;
  for (const auto& [part, number] : parts) {
    changed.replace(part.begin, part.end - part.begin, number);
  }
  return changed;
}

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// Columns of a line replaced: 3, the frame, and 9 to 11, latitude, longitude and altitude.
std::string changed_line(const std::string& line, const ChangedItem& change) {
  std::string result;
  std::size_t at = 0;
  for (int column = 0; at < line.size(); ++column) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t\r", at), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string word = line.substr(begin, end - begin);
    double altitude = 0;
    std::from_chars(word.data(), word.data() + word.size(), altitude);
    result += line.substr(at, begin - at);
    const bool is_moved = change.lonlat && (column == 8 || column == 9);
    const bool is_raised = column == 10 && change.raised_by_m != 0;
    result += is_moved                      ? number(change.lonlat->at(column == 8 ? 1 : 0), 7)
              : is_raised                   ? number(altitude + change.raised_by_m, 3)
              : column == 2 && change.frame ? std::to_string(*change.frame)
                                            : word;
    at = end;
  }
  return result;
}

std::string changed_lines(const std::string& text, const PlanChanges& changes) {
  std::string result;
  std::size_t at = 0;
  int filled = 0;  // of the lines: the second is home's
  for (int n = 1; at < text.size(); ++n) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    filled += line.find_first_not_of(" \t\r") == std::string::npos ? 0 : 1;
    if (filled == 2 && changes.home_raised_by_m != 0) {
      line = changed_line(line, {"", {}, changes.home_raised_by_m, {}});
      filled = 3;
    }
    for (const ChangedItem& change : changes.items) {
      if (change.place == "line " + std::to_string(n)) {
        line = changed_line(line, change);
      }
    }
    result += line + (end < text.size() ? "\n" : "");
    at = end + 1;
  }
  return result;
}
}  // namespace

std::string changed_plan(const std::string& text, formats::MissionFile::Format format,
                         const PlanChanges& changes) {
  switch (format) {
    case formats::MissionFile::Format::qgc_plan:
      return changed_json(text, changes);
    case formats::MissionFile::Format::waypoints:
      return changed_lines(text, changes);
    default:
      throw Error("expected a .plan or .waypoints file: in other formats no item can be changed");
  }
}

std::string with_added_markers(std::string text, const std::vector<AddedMarker>& markers) {
  constexpr std::string_view kNumber = "\"doJumpId\"";
  for (const AddedMarker& marker : markers) {
    std::size_t begin = JsonText(text).at(marker.before).begin;
    const std::size_t line = text.rfind('\n', begin) + 1;
    const std::string indent =
        line > 0 ? text.substr(line - 1, text.find_first_not_of(" \t", line) - line + 1) : "";
    int number = 0;
    for (std::size_t at = text.find(kNumber, begin); at != text.npos;
         at = text.find(kNumber, at + 1)) {
      const std::size_t digits = text.find_first_of("0123456789", at);
      const std::size_t end = text.find_first_not_of("0123456789", digits);
      const int old = std::stoi(text.substr(digits, end - digits));
      number = number == 0 ? old : number;
      text.replace(digits, end - digits, std::to_string(old + 1));
    }
    text.insert(begin, R"({"type": "SimpleItem", "autoContinue": true, "command": )" +
                           std::to_string(marker.command) + R"(, "doJumpId": )" +
                           std::to_string(number) +
                           R"(, "frame": 2, "params": [0, 0, 0, 0, 0, 0, 0]},)" + indent);
  }
  return text;
}

std::string with_rally_points(const std::string& text,
                              const std::vector<formats::MissionPoint>& points) {
  const JsonText json(text);
  const JsonText::Part part = json.at("rallyPoints");
  Json rally = parse_json(json[part]);
  rally["version"] = 2;
  rally["points"] = Json::array();
  for (const formats::MissionPoint& point : points) {
    rally["points"].push_back({point.lat, point.lon, point.altitude_m});
  }
  // Indented as its own line is.
  const std::size_t line = text.rfind('\n', part.begin) + 1;
  const std::size_t indent = text.find_first_not_of(" \t", line) - line;
  std::string words = json_text(rally, line > 0 ? int(std::max<std::size_t>(indent, 1)) : -1);
  for (std::size_t at = words.find('\n'); at != words.npos; at = words.find('\n', at + 1)) {
    words.insert(at + 1, text, line, indent);
  }
  return text.substr(0, part.begin) + words + text.substr(part.end);
}
}  // namespace altiplan::host
