// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "altiplan/params.hpp"
#include "params_text.hpp"

// Declaration, reading and printing of each parameter type.

namespace altiplan {
namespace {

/// The keys of a point, as a map.
std::string point_json(const char* form, const Point& point) {
  std::string text =
      "{" + json_text(form) + ": [" + number_text(point.at[0]) + ", " + number_text(point.at[1]);
  text += (point.has_height ? ", " + number_text(point.at[2]) : "") + "]";
  if (point.above_ground_m) {
    text += ", \"above_ground_m\": " + number_text(*point.above_ground_m);
  }
  return text + "}";
}

FieldSpec make_shape(FieldType type, std::string default_json) {
  FieldSpec spec;
  spec.type = type;
  spec.default_json = std::move(default_json);
  return spec;
}

bool is_unquoted(const Value& value) {
  return value.kind == Value::Kind::scalar && !value.quoted && !value.text.empty();
}

/// Written as a number, but not representable in T.
template <class T>
bool out_of_range(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc::result_out_of_range && end == text.data() + text.size();
}

/// Written as a number of that type.
template <class T>
bool is_number(const Value& value, T& number) {
  return value.kind == Value::Kind::scalar && !value.quoted && is_plain_number(value.text) &&
         parse_whole(value.text, number);
}

/// "two numbers, found …", where they are expected in a list.
std::string expected_list(const char* numbers, const Value& value) {
  return "expected " + std::string(numbers) + " numbers, found " +
         (value.kind == Value::Kind::list ? "a list of " + std::to_string(value.items.size())
                                          : value.what());
}

/// ".inf", "-Infinity", "NaN", as YAML and other programs write them.
bool is_not_finite(std::string_view text) {
  text.remove_prefix(text.front() == '-' || text.front() == '+' ? 1 : 0);
  text.remove_prefix(text.starts_with('.') ? 1 : 0);
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return word == "inf" || word == "infinity" || word == "nan";
}
}  // namespace

std::optional<double> Fields::read_number(const Value& value, const std::string& key) {
  double number = 0;
  if (is_unquoted(value) && out_of_range(value.text, number)) {
    problem(value, key, "the number is too large or too small, found " + value.what());
    return std::nullopt;
  }
  if (is_unquoted(value) && is_not_finite(value.text)) {
    problem(value, key, "expected a finite number, found " + value.what());
    return std::nullopt;
  }
  if (!is_number(value, number)) {
    problem(value, key, "expected a number, found " + value.what());
    return std::nullopt;
  }
  return number;
}

bool Fields::expect_list(const Value& value, const std::string& key) {
  if (value.kind != Value::Kind::list) {
    problem(value, key, "expected a list, found " + value.what());
    return false;
  }
  return true;
}

bool Fields::expect_map(const Value& value, const std::string& key) {
  if (value.kind != Value::Kind::map) {
    const bool word =
        !value.text.empty() && std::isalpha(static_cast<unsigned char>(value.text[0]));
    problem(value, key,
            "expected a map of keys, found " + value.what() +
                (word ? " (a key needs a ':' and a value)" : ""));
    return false;
  }
  return true;
}

FieldSpec Fields::shape(const bool& t) { return make_shape(FieldType::boolean, json(t)); }
FieldSpec Fields::shape(const int& t) {
  FieldSpec spec = make_shape(FieldType::integer, json(t));
  spec.min = std::numeric_limits<int>::min();
  spec.max = std::numeric_limits<int>::max();
  return spec;
}
FieldSpec Fields::shape(const std::int64_t& t) { return make_shape(FieldType::integer, json(t)); }
FieldSpec Fields::shape(const double& t) { return make_shape(FieldType::number, json(t)); }
FieldSpec Fields::shape(const AutoNumber& t) { return make_shape(FieldType::auto_number, json(t)); }
FieldSpec Fields::shape(const std::string& t) { return make_shape(FieldType::text, json(t)); }
FieldSpec Fields::shape(const Path& t) { return make_shape(FieldType::path, json(t)); }
FieldSpec Fields::shape(const std::array<double, 2>& t) {
  return make_shape(FieldType::vec2, json(t));
}
FieldSpec Fields::shape(const Vec3& t) { return make_shape(FieldType::vec3, json(t)); }
FieldSpec Fields::shape(const Value& t) { return make_shape(FieldType::any, json(t)); }

void Fields::read(const Value& value, bool& t, const std::string& key, std::size_t) {
  if (value.kind != Value::Kind::scalar || value.quoted ||
      (value.text != "true" && value.text != "false")) {
    problem(value, key, "expected true or false, found " + value.what());
    return;
  }
  t = value.text == "true";
}

void Fields::read(const Value& value, int& t, const std::string& key, std::size_t field) {
  std::int64_t wide = t;
  read(value, wide, key, field);
  if (wide >= std::numeric_limits<int>::min() && wide <= std::numeric_limits<int>::max()) {
    t = static_cast<int>(wide);
  } else if (!std::isfinite(bound_[field].spec.max)) {  // in a list; else its bounds refuse it
    numbers_.pop_back();
    problem(value, key, "the integer is too large, found " + value.what());
  }
}

void Fields::read(const Value& value, std::int64_t& t, const std::string& key, std::size_t field) {
  std::int64_t number = 0;
  if (is_unquoted(value) && out_of_range(value.text, number)) {
    problem(value, key, "the integer is too large, found " + value.what());
    return;
  }
  if (!is_number(value, number)) {
    problem(value, key, "expected an integer, found " + value.what());
    return;
  }
  t = number;
  numbers_.push_back({field, static_cast<double>(number), value.where, key});
}

void Fields::read(const Value& value, double& t, const std::string& key, std::size_t field) {
  if (const auto number = read_number(value, key)) {
    t = *number;
    numbers_.push_back({field, *number, value.where, key});
  }
}

void Fields::read(const Value& value, AutoNumber& t, const std::string& key, std::size_t field) {
  if (value.kind == Value::Kind::scalar && !value.quoted && value.text == "auto") {
    t.value.reset();
    return;
  }
  double number = 0;
  if (!is_number(value, number) || !std::isfinite(number)) {
    problem(value, key, "expected a number or auto, found " + value.what());
    return;
  }
  t.value = number;
  numbers_.push_back({field, number, value.where, key});
}

void Fields::read(const Value& value, std::string& t, const std::string& key, std::size_t) {
  if (value.kind != Value::Kind::scalar) {
    problem(value, key, "expected text, found " + value.what());
    return;
  }
  t = value.text;
}

void Fields::read(const Value& value, Path& t, const std::string& key, std::size_t field) {
  std::string text;
  read(value, text, key, field);
  if (text.empty()) {
    if (value.kind == Value::Kind::scalar) {
      problem(value, key, "expected the path of a file, found nothing");
    }
    return;
  }
  const std::filesystem::path path(text);
  t.text = path.is_absolute() ? path.lexically_normal().string()
                              : (std::filesystem::path(value.where.file).parent_path() / path)
                                    .lexically_normal()
                                    .string();
}

void Fields::read(const Value& value, std::array<double, 2>& t, const std::string& key,
                  std::size_t field) {
  if (value.kind != Value::Kind::list || value.items.size() != 2) {
    problem(value, key, expected_list("two", value));
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    read(value.items[i], t[i], key + "." + std::to_string(i), field);
  }
}

namespace {

/// "; did you mean [50, 50, 50]?" for one length in place of three.
std::string thrice(const Value& value) {
  const std::string& text = value.text;
  double number = 0;
  const bool is_length = value.kind != Value::Kind::list && parse_whole(text, number) &&
                         number > 0 && std::isfinite(number);
  return is_length ? "; did you mean [" + text + ", " + text + ", " + text + "]?" : "";
}
}  // namespace

void Fields::read(const Value& value, Vec3& t, const std::string& key, std::size_t field) {
  if (value.kind != Value::Kind::list || value.items.size() != 3) {
    problem(value, key, expected_list("three", value) + thrice(value));
    return;
  }
  for (int i = 0; i < 3; ++i) {
    read(value.items[std::size_t(i)], t[i], key + "." + std::to_string(i), field);
  }
}

void Fields::read(const Value& value, Value& t, const std::string&, std::size_t) { t = value; }

std::string Fields::json(const bool& t) { return t ? "true" : "false"; }
std::string Fields::json(const int& t) { return std::to_string(t); }
std::string Fields::json(const std::int64_t& t) { return std::to_string(t); }
std::string Fields::json(const double& t) { return number_text(t); }
std::string Fields::json(const AutoNumber& t) {
  return t.value ? number_text(*t.value) : "\"auto\"";
}
std::string Fields::json(const std::string& t) { return json_text(t); }
std::string Fields::json(const Path& t) { return json_text(t.text); }
std::string Fields::json(const std::array<double, 2>& t) {
  return "[" + number_text(t[0]) + ", " + number_text(t[1]) + "]";
}
std::string Fields::json(const Vec3& t) {
  return "[" + number_text(t.x()) + ", " + number_text(t.y()) + ", " + number_text(t.z()) + "]";
}
std::string Fields::json(const Value& t) {
  std::string text;
  switch (t.kind) {
    case Value::Kind::scalar: {
      double number = 0;
      const bool as_is = !t.quoted && (t.text == "true" || t.text == "false" ||
                                       (is_plain_number(t.text) && parse_whole(t.text, number)));
      return as_is ? (t.text == "true" || t.text == "false" ? t.text : number_text(number))
                   : json_text(t.text);
    }
    case Value::Kind::list:
      for (const Value& item : t.items) {
        text += (text.empty() ? "" : ", ") + json(item);
      }
      return "[" + text + "]";
    case Value::Kind::map:
      break;
  }
  for (const Value::Entry& entry : t.entries) {
    text += (text.empty() ? "" : ", ") + json_text(entry.key) + ": " + json(entry.value);
  }
  return "{" + text + "}";
}

std::string Fields::json_object(const std::vector<BoundField>& fields) {
  std::string text;
  for (const BoundField& field : fields) {
    const std::string& value = field.value_json;
    if (value.empty() || value == "null") {
      continue;
    }
    text += text.empty() ? "" : ", ";
    // A point or a plugin is keys of this map, already in its own braces.
    text += field.spec.name.empty() ? value.substr(1, value.size() - 2)
                                    : json_text(field.spec.name) + ": " + value;
  }
  return "{" + text + "}";
}

namespace {
constexpr std::pair<const char*, Point::Form> kPointForms[] = {{"at_m", Point::Form::metres},
                                                               {"at_lonlat", Point::Form::lonlat},
                                                               {"at_cell", Point::Form::cell}};
}  // namespace

void Fields::read_point(const Value& value, const char* name, Point& target) {
  if (value.kind != Value::Kind::list || value.items.size() < 2 || value.items.size() > 3) {
    problem(
        value, key_of(name),
        "expected two or three numbers, found " + value.what() +
            (value.kind == Value::Kind::list ? " of " + std::to_string(value.items.size()) : ""));
    return;
  }
  target.has_height = value.items.size() == 3;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    if (const auto number = read_number(value.items[i], key_of(name) + "." + std::to_string(i))) {
      target.at[i] = *number;
    }
  }
  if (target.form == Point::Form::lonlat &&
      (std::abs(target.at[0]) > 180 || std::abs(target.at[1]) > 90)) {
    problem(value, key_of(name),
            std::string("expected longitude in [-180, 180], then latitude in [-90, 90]") +
                (std::abs(target.at[1]) <= 180 && std::abs(target.at[0]) <= 90
                     ? ": are these two swapped?"
                     : ""));
  }
}

FieldRef Fields::point(Point& target) {
  const std::size_t index = open("", make_shape(FieldType::point, ""));
  known_.pop_back();
  for (const char* key : {"at_m", "at_lonlat", "at_cell", "above_ground_m"}) {
    known_.emplace_back(key);
  }
  const auto show = [&] {
    for (const auto& [name, form] : kPointForms) {
      if (target.form == form) {
        bound_[index].value_json = point_json(name, target);
      }
    }
  };
  if (source_ == nullptr) {
    show();
    return {*this, index};
  }
  for (const auto& [name, form] : kPointForms) {
    const Value* value = source_->find(name);
    if (value == nullptr) {
      continue;
    }
    if (target.form != Point::Form::none) {
      problem(*value, key_of(name), "a point needs only one of at_m, at_lonlat and at_cell");
      continue;
    }
    bound_[index].where = value->where;
    target.form = form;
    read_point(*value, name, target);
  }
  if (const Value* value = source_->find("above_ground_m")) {
    target.above_ground_m = read_number(*value, key_of("above_ground_m"));
    if (target.has_height) {
      problem(*value, key_of("above_ground_m"),
              "the point already has a height: give its third coordinate or above_ground_m");
    }
  }
  if (target.form == Point::Form::none) {
    missing_.push_back(index);
  }
  show();
  return {*this, index};
}

FieldRef Fields::plugin(std::string_view kind, std::string& name, Value& parameters) {
  FieldSpec spec = make_shape(FieldType::plugin, "");
  spec.choices.emplace_back(kind);
  const std::size_t index = open("", std::move(spec));
  known_.pop_back();
  if (source_ == nullptr) {
    if (!name.empty()) {
      bound_[index].value_json = "{" + json_text(name) + ": " + json(parameters) + "}";
    }
    return {*this, index};
  }
  const Value::Entry* found = nullptr;
  for (const Value::Entry& entry : source_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) {
      continue;
    }
    if (found != nullptr) {
      const std::string near = nearest_name(entry.key, known_);
      problems_.push_back({entry.where, key_of(entry.key),
                           near == found->key
                               ? "the " + std::string(kind) + " of this entry is '" + near +
                                     "': write '" + near + "' for '" + entry.key + "'"
                               : "unknown key beside '" + found->key +
                                     (near.empty() ? "': expected one " + std::string(kind) +
                                                         " plugin, as NAME: {…}"
                                                   : "'; did you mean '" + near + "'?")});
    } else {
      found = &entry;
    }
    known_.push_back(entry.key);
  }
  if (found == nullptr) {
    problem(*source_, path_, "expected one " + std::string(kind) + " plugin, as NAME: {…}");
    return {*this, index};
  }
  name = found->key;
  parameters = found->value;
  bound_[index].where = found->where;
  bound_[index].value_json = "{" + json_text(name) + ": " + json(parameters) + "}";
  return {*this, index};
}
}  // namespace altiplan
