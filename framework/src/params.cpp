// SPDX-License-Identifier: Apache-2.0
#include "altiplan/params.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace altiplan {
namespace {

template <class T>
bool parse_whole(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "010" and "-01" read as another number elsewhere; YAML's "+1" is not for from_chars.
bool is_plain_number(std::string_view text) {
  if (!text.empty() && text[0] == '-') {
    text.remove_prefix(1);
  }
  return !text.empty() &&
         ((text[0] >= '1' && text[0] <= '9') || text[0] == '.' ||
          (text[0] == '0' && (text.size() == 1 || text[1] < '0' || text[1] > '9')));
}

std::string number_text(double number) {
  if (!std::isfinite(number)) {
    return "null";
  }
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, result.ptr};
}

std::string json_text(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += "\\u00";
      out += kHex[c >> 4];
      out += kHex[c & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

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
}  // namespace

FieldSpec& FieldRef::spec() { return fields_->bound_[index_].spec; }
FieldRef& FieldRef::unit(std::string_view unit) {
  spec().unit = unit;
  return *this;
}
FieldRef& FieldRef::doc(std::string_view sentence) {
  spec().doc = sentence;
  return *this;
}
FieldRef& FieldRef::range(double min, double max) {
  spec().min = min;
  spec().max = max;
  return *this;
}
FieldRef& FieldRef::at_least(double min) {
  spec().min = min;
  return *this;
}
FieldRef& FieldRef::greater_than(double min) {
  spec().min = min;
  spec().above = true;
  return *this;
}
FieldRef& FieldRef::at_most(double max) {
  spec().max = max;
  return *this;
}
FieldRef& FieldRef::one_of(std::initializer_list<const char*> words) {
  spec().type = FieldType::choice;
  spec().choices.assign(words.begin(), words.end());
  return *this;
}
FieldRef& FieldRef::min_items(std::size_t count) {
  spec().min_items = count;
  return *this;
}
FieldRef& FieldRef::required() {
  spec().required = true;
  spec().default_json.clear();
  return *this;
}

Fields::Fields(const Value* source, std::string path) : source_(source), path_(std::move(path)) {
  if (source_ != nullptr && source_->kind != Value::Kind::map) {
    problem(*source_, path_, "expected a map of keys, found " + source_->what());
    source_ = nullptr;
  }
}

std::size_t Fields::open(std::string_view name, FieldSpec shape) {
  shape.name = name;
  known_.emplace_back(name);
  bound_.push_back({std::move(shape), "", std::nullopt});
  return bound_.size() - 1;
}

const Value* Fields::take(std::string_view name, std::size_t index) {
  if (source_ == nullptr) {
    return nullptr;
  }
  const Value* value = source_->find(name);
  if (value == nullptr) {
    missing_.push_back(index);
  } else {
    bound_[index].where = value->where;
  }
  return value;
}

std::string Fields::key_of(std::string_view name) const {
  return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

void Fields::add_choice(const char* word) {
  FieldSpec& spec = bound_.back().spec;
  spec.type = FieldType::choice;
  spec.choices.emplace_back(word);
}

void Fields::problem(const Value& at, std::string key, std::string message) {
  problems_.push_back({at.where, std::move(key), std::move(message)});
}

std::optional<double> Fields::read_number(const Value& value, const std::string& key) {
  double number = 0;
  if (value.kind != Value::Kind::scalar || value.quoted || !is_plain_number(value.text) ||
      !parse_whole(value.text, number)) {
    problem(value, key, "expected a number, found " + value.what());
    return std::nullopt;
  }
  if (!std::isfinite(number)) {
    problem(value, key, "expected a finite number, found " + value.what());
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
    problem(value, key, "expected a map of keys, found " + value.what());
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
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) {
    problem(value, key, "the integer is too large");
    return;
  }
  t = static_cast<int>(wide);
}

void Fields::read(const Value& value, std::int64_t& t, const std::string& key, std::size_t field) {
  std::int64_t number = 0;
  if (value.kind != Value::Kind::scalar || value.quoted || !is_plain_number(value.text) ||
      !parse_whole(value.text, number)) {
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
  if (value.kind != Value::Kind::scalar || value.quoted || !is_plain_number(value.text) ||
      !parse_whole(value.text, number) || !std::isfinite(number)) {
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
    problem(value, key,
            "expected two numbers, found " +
                (value.kind == Value::Kind::list ? "a list of " + std::to_string(value.items.size())
                                                 : value.what()));
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    read(value.items[i], t[i], key + "." + std::to_string(i), field);
  }
}

void Fields::read(const Value& value, Vec3& t, const std::string& key, std::size_t field) {
  if (value.kind != Value::Kind::list || value.items.size() != 3) {
    problem(value, key,
            "expected three numbers, found " +
                (value.kind == Value::Kind::list ? "a list of " + std::to_string(value.items.size())
                                                 : value.what()));
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
    // A point or a plugin is keys of this map, already in braces of their own.
    text += field.spec.name.empty() ? value.substr(1, value.size() - 2)
                                    : json_text(field.spec.name) + ": " + value;
  }
  return "{" + text + "}";
}

FieldRef Fields::point(Point& target) {
  static constexpr std::pair<const char*, Point::Form> kForms[] = {
      {"at_m", Point::Form::metres},
      {"at_lonlat", Point::Form::lonlat},
      {"at_cell", Point::Form::cell}};
  const std::size_t index = open("", make_shape(FieldType::point, ""));
  known_.pop_back();
  for (const char* key : {"at_m", "at_lonlat", "at_cell", "above_ground_m"}) {
    known_.emplace_back(key);
  }
  const auto show = [&] {
    for (const auto& [name, form] : kForms) {
      if (target.form == form) {
        bound_[index].value_json = point_json(name, target);
      }
    }
  };
  if (source_ == nullptr) {
    show();
    return {*this, index};
  }
  for (const auto& [name, form] : kForms) {
    const Value* value = source_->find(name);
    if (value == nullptr) {
      continue;
    }
    if (target.form != Point::Form::none) {
      problem(*value, key_of(name), "a point is given in one way: at_m, at_lonlat or at_cell");
      continue;
    }
    bound_[index].where = value->where;
    if (value->kind != Value::Kind::list || value->items.size() < 2 || value->items.size() > 3) {
      problem(*value, key_of(name), "expected two or three numbers, found " + value->what());
      continue;
    }
    target.form = form;
    target.has_height = value->items.size() == 3;
    for (std::size_t i = 0; i < value->items.size(); ++i) {
      const std::string key = key_of(name) + "." + std::to_string(i);
      if (const auto number = read_number(value->items[i], key)) {
        target.at[i] = *number;
      }
    }
    if (form == Point::Form::lonlat &&
        (std::abs(target.at[0]) > 180 || std::abs(target.at[1]) > 90)) {
      problem(*value, key_of(name),
              "expected longitude in [-180, 180], then latitude in [-90, 90]");
    }
  }
  if (const Value* value = source_->find("above_ground_m")) {
    target.above_ground_m = read_number(*value, key_of("above_ground_m"));
    if (target.has_height) {
      problem(*value, key_of("above_ground_m"),
              "the point has a height already: give its third coordinate or above_ground_m");
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
      problems_.push_back({entry.where, key_of(entry.key),
                           "unknown key beside '" + found->key +
                               "': expected one name of a plugin" + " (" + std::string(kind) +
                               ") over its parameters"});
    } else {
      found = &entry;
    }
    known_.push_back(entry.key);
  }
  if (found == nullptr) {
    problem(*source_, path_,
            "expected the name of a plugin (" + std::string(kind) + ") over its parameters");
    return {*this, index};
  }
  name = found->key;
  parameters = found->value;
  bound_[index].where = found->where;
  bound_[index].value_json = "{" + json_text(name) + ": " + json(parameters) + "}";
  return {*this, index};
}

void Fields::check(bool condition, std::string_view sentence) {
  if (!condition && source_ != nullptr) {
    broken_rules_.emplace_back(sentence);
  }
}

void Fields::finish() {
  if (source_ == nullptr) {
    return;
  }
  for (const Number& number : numbers_) {
    const FieldSpec& spec = bound_[number.field].spec;
    const bool low = spec.above ? number.value <= spec.min : number.value < spec.min;
    if (!low && number.value <= spec.max) {
      continue;
    }
    const std::string unit = spec.unit.empty() ? "" : " " + spec.unit;
    const bool bounded = std::isfinite(spec.max);
    std::string expected;
    if (std::isfinite(spec.min) && bounded) {
      expected = std::string(spec.above ? "more than " : "from ") + number_text(spec.min) +
                 (spec.above ? " and at most " : " to ") + number_text(spec.max);
    } else if (bounded) {
      expected = "at most " + number_text(spec.max);
    } else {
      expected = (spec.above ? "more than " : "at least ") + number_text(spec.min);
    }
    problems_.push_back({number.where, number.key,
                         "expected " + expected + unit + ", found " + number_text(number.value)});
  }
  for (const BoundField& field : bound_) {
    const FieldSpec& spec = field.spec;
    const Value* value = spec.name.empty() ? nullptr : source_->find(spec.name);
    if (value == nullptr) {
      continue;
    }
    if (spec.type == FieldType::choice && value->kind == Value::Kind::scalar &&
        std::find(spec.choices.begin(), spec.choices.end(), value->text) == spec.choices.end()) {
      std::string expected;
      for (const std::string& choice : spec.choices) {
        expected += (expected.empty() ? "" : ", ") + choice;
      }
      const std::string near = nearest_name(value->text, spec.choices);
      problem(*value, key_of(spec.name),
              "expected one of " + expected + "; found " + value->what() +
                  (near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
    if (spec.type == FieldType::list && value->kind == Value::Kind::list &&
        value->items.size() < spec.min_items) {
      problem(*value, key_of(spec.name),
              "expected at least " + std::to_string(spec.min_items) + " items, found " +
                  std::to_string(value->items.size()));
    }
  }
  for (const std::size_t index : missing_) {
    const FieldSpec& spec = bound_[index].spec;
    if (!spec.required) {
      continue;
    }
    const std::string what = spec.type == FieldType::point ? "a point (at_m, at_lonlat or at_cell)"
                                                           : "the key '" + spec.name + "'";
    problem(*source_, path_, what + " is missing" + (spec.doc.empty() ? "" : ": " + spec.doc));
  }
  for (const Value::Entry& entry : source_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) {
      continue;
    }
    const std::string near = nearest_name(entry.key, known_);
    std::string message = "unknown key";
    if (!near.empty()) {
      message += "; did you mean '" + near + "'?";
    } else if (known_.empty()) {
      message += "; there are no keys here";
    } else {
      message += "; expected one of ";
      for (std::size_t i = 0; i < known_.size(); ++i) {
        message += (i == 0 ? "" : ", ") + known_[i];
      }
    }
    problems_.push_back({entry.where, key_of(entry.key), message});
  }
  if (problems_.empty()) {
    for (const std::string& rule : broken_rules_) {
      problem(*source_, path_, rule);
    }
  }
}
}  // namespace altiplan
