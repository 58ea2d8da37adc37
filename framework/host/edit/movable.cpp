// SPDX-License-Identifier: Apache-2.0
#include "host/edit/movable.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include "host/config/yaml_edit.hpp"

namespace altiplan::host {
namespace {

/// Millimetres, and the length of a degree's ten millionth: 1 cm.
constexpr int kMetreDigits = 3;
constexpr int kDegreeDigits = 7;

/// The shortest text of a number rounded to so many digits behind the point.
std::string number_text(double value, int digits) {
  const double unit = std::pow(10, digits);
  char text[64];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, std::round(value * unit) / unit + 0.0);
  return error == std::errc() ? std::string(text, end) : "0";
}

std::optional<double> number_of(const Value* value) {
  if (value == nullptr || value->kind != Value::Kind::scalar) {
    return std::nullopt;
  }
  double number = 0;
  const char* end = value->text.data() + value->text.size();
  const char* begin = value->text.data() + (value->text.starts_with('+') ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

using Numbers = std::vector<double>;

/// The numbers of a list; nothing if it is none, or has anything else.
std::optional<Numbers> numbers_of(const Value* value) {
  if (value == nullptr || value->kind != Value::Kind::list) {
    return std::nullopt;
  }
  Numbers numbers;
  for (const Value& item : value->items) {
    const auto number = number_of(&item);
    if (!number) {
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<std::vector<Numbers>> corners_of(const Value* value) {
  if (value == nullptr || value->kind != Value::Kind::list || value->items.empty()) {
    return std::nullopt;
  }
  std::vector<Numbers> corners;
  for (const Value& item : value->items) {
    const auto corner = numbers_of(&item);
    if (!corner || corner->size() != 2) {
      return std::nullopt;
    }
    corners.push_back(*corner);
  }
  return corners;
}

/// How a place is written.
enum class Form { metres, lonlat };

/// A map's point, or the corners of its outline or box.
struct Written {
  std::string key;
  Form form = Form::metres;
  bool is_list_of_corners = false;
  std::vector<Numbers> points;
};

std::vector<Written> written_in(const Value& map) {
  std::vector<Written> all;
  for (const auto& [key, form] : {std::pair("at_m", Form::metres),
                                  {"at_lonlat", Form::lonlat},
                                  {"min_m", Form::metres},
                                  {"max_m", Form::metres}}) {
    const auto numbers = numbers_of(map.find(key));
    if (numbers && numbers->size() >= 2 && numbers->size() <= 3) {
      all.push_back({key, form, false, {*numbers}});
    }
  }
  for (const auto& [key, form] :
       {std::pair("outline_m", Form::metres), {"outline_lonlat", Form::lonlat}}) {
    if (auto corners = corners_of(map.find(key))) {
      all.push_back({key, form, true, std::move(*corners)});
    }
  }
  return all;
}

std::array<double, 2> to_local(const Numbers& at, Form form, const Frame& frame) {
  return form == Form::metres ? std::array<double, 2>{at[0], at[1]} : frame.to_local(at[0], at[1]);
}

/// The height in the middle of what is written there; none if it has none.
std::optional<double> height_of(const Value& map, const std::vector<Written>& all) {
  double sum = 0;
  int count = 0;
  for (const Written& written : all) {
    for (const Numbers& point : written.points) {
      if (point.size() == 3) {
        sum += point[2];
        ++count;
      }
    }
  }
  for (const char* key : {"floor_m", "ceiling_m"}) {
    if (const auto height = number_of(map.find(key))) {
      sum += *height;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::optional<Vec3> middle_of(const Value& map, const World& world) {
  const std::vector<Written> all = written_in(map);
  Vec3 sum(0, 0, 0);
  int count = 0;
  for (const Written& written : all) {
    if (written.form == Form::lonlat && !world.frame().has_position()) {
      return std::nullopt;
    }
    for (const Numbers& point : written.points) {
      const auto [x, y] = to_local(point, written.form, world.frame());
      sum += Vec3(x, y, 0);
      ++count;
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  Vec3 middle = sum / count;
  const auto height = height_of(map, all);
  const auto ground = world.ground(middle.x(), middle.y());
  middle.z() =
      height ? *height : ground.value_or(0) + number_of(map.find("above_ground_m")).value_or(0);
  return middle;
}

class Movable {
 public:
  Movable(const Value& scenario, const World& world) : scenario_(scenario), world_(world) {}

  Json operator()() {
    add("start", "start", "", "Start", scenario_.find("start"));
    each("via", [&](const std::string& key, const Value& item, std::size_t n) {
      add(key, "via", "", "Via " + std::to_string(n + 1), &item);
    });
    add("goal", "goal", "", "Goal", scenario_.find("goal"));
    each("environment", [&](const std::string& key, const Value& item, std::size_t) {
      add_shape(key, "layer", item, item);
    });
    each("moving", [&](const std::string& key, const Value& item, std::size_t) {
      add_shape(key, "moving", item, item);
    });
    each("events", [&](const std::string& key, const Value& item, std::size_t) {
      if (const Value* added = item.find("add")) {
        add_shape(key + ".add", "event", *added, item);
      }
    });
    return std::move(all_);
  }

 private:
  template <class Use>
  void each(const std::string& list, const Use& use) {
    const Value* values = scenario_.find(list);
    for (std::size_t n = 0; values != nullptr && n < values->items.size(); ++n) {
      use(list + "." + std::to_string(n), values->items[n], n);
    }
  }

  /// `holder` is the map with the plugin's name as a key, `named` the one that may have an id.
  void add_shape(const std::string& key, const char* kind, const Value& holder,
                 const Value& named) {
    const Value* id = named.find("id");
    for (const Value::Entry& entry : holder.entries) {
      if (entry.value.kind == Value::Kind::map) {
        add(key + "." + entry.key, kind, entry.key, id != nullptr ? id->text : entry.key,
            &entry.value);
      }
    }
  }

  void add(const std::string& key, const char* kind, const std::string& plugin,
           const std::string& name, const Value* map) {
    const auto at =
        map != nullptr && map->kind == Value::Kind::map ? middle_of(*map, world_) : std::nullopt;
    if (at) {
      all_.push_back({{"key", key},
                      {"kind", kind},
                      {"plugin", plugin},
                      {"name", name},
                      {"at", {at->x(), at->y(), at->z()}}});
    }
  }

  const Value& scenario_;
  const World& world_;
  Json all_ = Json::array();
};

std::string list_text(const Numbers& numbers, Form form) {
  std::string text;
  for (std::size_t axis = 0; axis < numbers.size(); ++axis) {
    text +=
        (axis > 0 ? ", " : "") +
        number_text(numbers[axis], form == Form::lonlat && axis < 2 ? kDegreeDigits : kMetreDigits);
  }
  return "[" + text + "]";
}

Numbers moved_point(Numbers at, Form form, const Vec3& by, const Frame& frame) {
  const auto [x, y] = to_local(at, form, frame);
  const std::array<double, 2> to{x + by.x(), y + by.y()};
  const auto written = form == Form::metres ? to : frame.to_lonlat(to[0], to[1]);
  at[0] = written[0];
  at[1] = written[1];
  if (at.size() == 3) {
    at[2] += by.z();
  }
  return at;
}

}  // namespace

Json movable(const Value& scenario, const World& world) { return Movable(scenario, world)(); }

std::vector<std::string> moved(const Value& scenario, const std::string& key, const Vec3& by,
                               const Frame& frame) {
  const Value* found = value_at(scenario, key);
  if (found == nullptr || found->kind != Value::Kind::map) {
    throw Error("nothing can be moved at '" + key + "'");
  }
  const Value& map = *found;
  const std::string prefix = "scenario." + key + ".";
  std::vector<std::string> assignments;
  const std::vector<Written> all = written_in(map);
  if (all.empty()) {
    throw Error("'" + key + "' has no place in metres or longitude and latitude that could move");
  }
  bool has_height = false;
  for (const Written& written : all) {
    if (written.form == Form::lonlat && !frame.has_position()) {
      throw Error("'" + key + "' has longitude and latitude in a world without a position");
    }
    std::string text;
    for (const Numbers& point : written.points) {
      has_height = has_height || point.size() == 3;
      text += (text.empty() ? "" : ", ") +
              list_text(moved_point(point, written.form, by, frame), written.form);
    }
    assignments.push_back(prefix + written.key + "=" +
                          (written.is_list_of_corners ? "[" + text + "]" : text));
  }
  for (const char* height : {"above_ground_m", "floor_m", "ceiling_m"}) {
    if (const auto written = number_of(map.find(height)); written && by.z() != 0) {
      has_height = true;
      assignments.push_back(prefix + height + "=" + number_text(*written + by.z(), kMetreDigits));
    }
  }
  if (by.z() != 0 && !has_height) {
    throw Error("'" + key + "' has no height of its own to change");
  }
  return assignments;
}
}  // namespace altiplan::host
