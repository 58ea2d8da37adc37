// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "altiplan/frame.hpp"
#include "altiplan/value.hpp"

namespace altiplan {

/// A file named by the user; written relative to the file that names it, after binding absolute or
/// relative to the current folder.
struct Path {
  std::string text;
};

/// A number, or the word `auto` (no value).
struct AutoNumber {
  std::optional<double> value;
};

enum class FieldType {
  boolean,
  integer,
  number,
  auto_number,
  text,
  choice,
  path,
  vec2,
  vec3,
  point,      ///< the keys at_m, at_lonlat, at_cell and above_ground_m
  list,       ///< children[0] is the element
  structure,  ///< children are its fields
  plugin,     ///< one key, a plugin's name, with its parameters as value; `choices[0]` is the kind
  any
};

/// Declaration of a parameter; feeds checks, `describe`, the JSON Schema and the reference.
struct FieldSpec {
  std::string name;
  FieldType type = FieldType::any;
  std::string unit;
  std::string doc;
  bool required = false;
  bool optional = false;  ///< has no value when omitted
  double min = -kInfinity;
  double max = kInfinity;
  bool above = false;  ///< greater than min, not equal
  std::size_t min_items = 0;
  std::vector<std::string> choices;
  std::vector<FieldSpec> children;
  std::string default_json;  ///< "" where there is none
};

/// A field after reading: its declaration, its value as JSON, and the location of that value.
struct BoundField {
  FieldSpec spec;
  std::string value_json;
  std::optional<Location> where;  ///< none: the default
};

class Fields;

/// Qualifiers after `f("name", target)`: unit, bounds, sentence.
class ALTIPLAN_API FieldRef {
 public:
  FieldRef(Fields& fields, std::size_t index) : fields_(&fields), index_(index) {}
  FieldRef& unit(std::string_view unit);
  FieldRef& doc(std::string_view sentence);
  FieldRef& range(double min, double max);  ///< closed; for a list or vector, of each number
  FieldRef& at_least(double min);
  FieldRef& greater_than(double min);
  FieldRef& at_most(double max);
  FieldRef& one_of(std::initializer_list<const char*> words);
  FieldRef& min_items(std::size_t count);
  FieldRef& required();
  FieldRef& was(std::string_view name);  ///< the former key, rejected with a pointer to the present
                                         ///< one

 private:
  FieldSpec& spec();
  Fields* fields_;
  std::size_t index_;
};

/// Visits a parameter struct's fields: `void describe(Fields& f)` lists them once, and the same
/// list feeds parsing, checking, `describe`, the schema, the docs, `--set` and the tuner.
class ALTIPLAN_API Fields {
 public:
  /// With a map, values are read from it; without, the fields are only listed. `path` is the
  /// position of the map in its file ("steps.0.with").
  Fields(const Value* source, std::string path);
  Fields(const Fields&) = delete;
  Fields& operator=(const Fields&) = delete;

  template <class T>
  FieldRef operator()(std::string_view name, T& target) {
    const std::size_t index = open(name, shape(target));
    if (const Value* value = take(name, index)) {
      read(*value, target, key_of(name), index);
    }
    bound_[index].value_json = json(target);
    return {*this, index};
  }

  /// An enumeration and the words for its values.
  template <class E>
  FieldRef operator()(std::string_view name, E& target,
                      std::initializer_list<std::pair<const char*, E>> words) {
    std::string word;
    for (const auto& [text, value] : words) {
      if (value == target) {
        word = text;
      }
    }
    FieldRef ref = (*this)(name, word);
    for (const auto& [text, value] : words) {
      add_choice(text);
      if (word == text) {
        target = value;
      }
    }
    return ref;
  }

  /// The keys at_m, at_lonlat, at_cell and above_ground_m of this map, which form one point.
  FieldRef point(Point& target);

  /// The only undeclared key: the name of a plugin of this kind, with its parameters as value.
  /// Comes last.
  FieldRef plugin(std::string_view kind, std::string& name, Value& parameters);

  /// A condition across fields; evaluated only when every field was read without a problem.
  void check(bool condition, std::string_view sentence);

  /// Ends the visit: checks bounds, unknown and missing keys.
  void finish();

  bool reading() const { return source_ != nullptr; }
  const std::vector<BoundField>& bound() const { return bound_; }
  std::vector<BoundField>& bound() { return bound_; }
  const std::vector<Problem>& problems() const { return problems_; }
  const std::string& path() const { return path_; }

 private:
  friend class FieldRef;
  struct Number {
    std::size_t field;
    double value;
    Location where;
    std::string key;
  };

  std::size_t open(std::string_view name, FieldSpec shape);
  const Value* take(std::string_view name, std::size_t index);
  std::string key_of(std::string_view name) const;
  void add_choice(const char* word);
  void problem(const Value& at, std::string key, std::string message);
  std::optional<double> read_number(const Value& value, const std::string& key);
  void read_point(const Value& value, const char* name, Point& target);

  // Declaration, reading and writing of each type.
  static FieldSpec shape(const bool& t);
  static FieldSpec shape(const int& t);
  static FieldSpec shape(const std::int64_t& t);
  static FieldSpec shape(const double& t);
  static FieldSpec shape(const AutoNumber& t);
  static FieldSpec shape(const std::string& t);
  static FieldSpec shape(const Path& t);
  static FieldSpec shape(const std::array<double, 2>& t);
  static FieldSpec shape(const Vec3& t);
  static FieldSpec shape(const Value& t);
  void read(const Value& value, bool& t, const std::string& key, std::size_t field);
  void read(const Value& value, int& t, const std::string& key, std::size_t field);
  void read(const Value& value, std::int64_t& t, const std::string& key, std::size_t field);
  void read(const Value& value, double& t, const std::string& key, std::size_t field);
  void read(const Value& value, AutoNumber& t, const std::string& key, std::size_t field);
  void read(const Value& value, std::string& t, const std::string& key, std::size_t field);
  void read(const Value& value, Path& t, const std::string& key, std::size_t field);
  void read(const Value& value, std::array<double, 2>& t, const std::string& key,
            std::size_t field);
  void read(const Value& value, Vec3& t, const std::string& key, std::size_t field);
  void read(const Value& value, Value& t, const std::string& key, std::size_t field);
  static std::string json(const bool& t);
  static std::string json(const int& t);
  static std::string json(const std::int64_t& t);
  static std::string json(const double& t);
  static std::string json(const AutoNumber& t);
  static std::string json(const std::string& t);
  static std::string json(const Path& t);
  static std::string json(const std::array<double, 2>& t);
  static std::string json(const Vec3& t);
  static std::string json(const Value& t);
  static std::string json_object(const std::vector<BoundField>& fields);
  bool expect_list(const Value& value, const std::string& key);
  bool expect_map(const Value& value, const std::string& key);

  /// An initial value; Eigen leaves its vectors uninitialised.
  template <class T>
  static T blank() {
    if constexpr (std::is_same_v<T, Vec3>) {
      return Vec3::Zero();
    } else {
      return T{};
    }
  }

  template <class T>
  static FieldSpec shape(const std::optional<T>&) {
    FieldSpec spec = shape(blank<T>());
    spec.optional = true;
    spec.default_json.clear();
    return spec;
  }
  template <class T>
  void read(const Value& value, std::optional<T>& t, const std::string& key, std::size_t field) {
    t = blank<T>();
    read(value, *t, key, field);
  }
  template <class T>
  static std::string json(const std::optional<T>& t) {
    return t ? json(*t) : "null";
  }

  template <class T>
  static FieldSpec shape(const std::vector<T>& t) {
    FieldSpec spec;
    spec.type = FieldType::list;
    spec.children.push_back(shape(blank<T>()));
    spec.default_json = json(t);
    return spec;
  }
  template <class T>
  void read(const Value& value, std::vector<T>& t, const std::string& key, std::size_t field) {
    if (!expect_list(value, key)) {
      return;
    }
    t.assign(value.items.size(), blank<T>());
    for (std::size_t i = 0; i < t.size(); ++i) {
      read(value.items[i], t[i], key + "." + std::to_string(i), field);
    }
  }
  template <class T>
  static std::string json(const std::vector<T>& t) {
    std::string text = "[";
    for (const T& item : t) {
      text += (text.size() > 1 ? ", " : "") + json(item);
    }
    return text + "]";
  }

  // A struct with its own `describe`.
  template <class T>
  static FieldSpec shape(const T& t) requires requires(T s, Fields& f) {
    s.describe(f);
  }
  {
    T copy = t;
    Fields fields(nullptr, "");
    copy.describe(fields);
    FieldSpec spec;
    spec.type = FieldType::structure;
    for (const BoundField& field : fields.bound_) {
      spec.children.push_back(field.spec);
    }
    spec.default_json = json_object(fields.bound_);
    return spec;
  }
  template <class T>
  void read(const Value& value, T& t, const std::string& key, std::size_t) requires
      requires(T s, Fields& f) {
    s.describe(f);
  }
  {
    if (!expect_map(value, key)) {
      return;
    }
    Fields fields(&value, key);
    t.describe(fields);
    fields.finish();
    problems_.insert(problems_.end(), fields.problems_.begin(), fields.problems_.end());
  }
  template <class T>
  static std::string json(const T& t) requires requires(T s, Fields& f) {
    s.describe(f);
  }
  {
    T copy = t;
    Fields fields(nullptr, "");
    copy.describe(fields);
    return json_object(fields.bound_);
  }

  const Value* source_;
  std::string path_;
  std::vector<BoundField> bound_;
  std::vector<std::string> known_;
  std::vector<std::pair<std::string, std::string>> former_;  ///< former keys and their replacements
  std::vector<std::size_t> missing_;
  std::vector<Number> numbers_;
  std::vector<Problem> problems_;
  std::vector<std::string> broken_rules_;
};

/// Result of reading a parameter struct: every field, and the problems found.
struct ParamReport {
  std::vector<BoundField> fields;
  std::vector<Problem> problems;
};

/// Reads `params` from a map (or keeps the defaults, without one).
template <class P>
ParamReport bind(P& params, const Value* source, std::string path = "") {
  Fields fields(source, std::move(path));
  params.describe(fields);
  fields.finish();
  return {std::move(fields.bound()), fields.problems()};
}
}  // namespace altiplan
