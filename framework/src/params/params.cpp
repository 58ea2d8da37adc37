// SPDX-License-Identifier: Apache-2.0
#include "altiplan/params.hpp"

#include <algorithm>
#include <cmath>

#include "params_text.hpp"

namespace altiplan {

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

FieldRef& FieldRef::was(std::string_view name) {
  fields_->former_.emplace_back(name, spec().name);
  return *this;
}

Fields::Fields(const Value* source, std::string path) : source_(source), path_(std::move(path)) {
  if (source_ != nullptr && !expect_map(*source_, path_)) {
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

void Fields::check(bool condition, std::string_view sentence) {
  if (!condition && source_ != nullptr) {
    broken_rules_.emplace_back(sentence);
  }
}

namespace {

/// As a reader writes it: 1000000 and not 1e+06.
std::string plain_text(double number) {
  const bool is_whole = number == std::round(number) && std::abs(number) < 1e7;
  return is_whole ? std::to_string(std::int64_t(number)) : number_text(number);
}

/// "from 0 to 1 m".
std::string bounds_text(const FieldSpec& spec) {
  const std::string unit = spec.unit.empty() ? "" : " " + spec.unit;
  const bool bounded = std::isfinite(spec.max);
  if (spec.min == spec.max) {
    return plain_text(spec.min) + unit;
  }
  if (std::isfinite(spec.min) && bounded) {
    return std::string(spec.above ? "more than " : "from ") + plain_text(spec.min) +
           (spec.above ? " and at most " : " to ") + plain_text(spec.max) + unit;
  }
  if (bounded) {
    return "at most " + plain_text(spec.max) + unit;
  }
  return (spec.above ? "more than " : "at least ") + plain_text(spec.min) + unit;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::string wrong_word(const std::vector<std::string>& choices, const Value& value) {
  const std::string near = nearest_name(value.text, choices);
  return "expected one of " + joined(choices) + "; found " + value.what() +
         (near.empty() ? "" : " (did you mean '" + near + "'?)");
}

std::string unknown_key(const std::string& key, const std::vector<std::string>& known) {
  const std::string near = nearest_name(key, known);
  if (!near.empty()) {
    return "unknown key; did you mean '" + near + "'?";
  }
  return known.empty() ? "unknown key; no keys are allowed here"
                       : "unknown key; expected one of " + joined(known);
}
}  // namespace

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
    problems_.push_back({number.where, number.key,
                         "expected " + bounds_text(spec) + ", found " + plain_text(number.value)});
  }
  for (const BoundField& field : bound_) {
    const FieldSpec& spec = field.spec;
    const Value* value = spec.name.empty() ? nullptr : source_->find(spec.name);
    if (value == nullptr) {
      continue;
    }
    if (spec.type == FieldType::choice && value->kind == Value::Kind::scalar &&
        std::find(spec.choices.begin(), spec.choices.end(), value->text) == spec.choices.end()) {
      problem(*value, key_of(spec.name), wrong_word(spec.choices, *value));
    }
    if (spec.type == FieldType::list && value->kind == Value::Kind::list &&
        value->items.size() < spec.min_items) {
      problem(*value, key_of(spec.name),
              "expected at least " + std::to_string(spec.min_items) +
                  (spec.min_items == 1 ? " item, found " : " items, found ") +
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
    const auto former = std::find_if(former_.begin(), former_.end(), [&](const auto& renamed) {
      return renamed.first == entry.key;
    });
    problems_.push_back({entry.where, key_of(entry.key),
                         former == former_.end() ? unknown_key(entry.key, known_)
                                                 : "is now '" + former->second + "'"});
  }
  if (problems_.empty()) {
    for (const std::string& rule : broken_rules_) {
      const std::string first = rule.substr(0, rule.find(' '));  // often the key at fault
      const Value* value = source_->find(first);
      problem(value == nullptr ? *source_ : *value, value == nullptr ? path_ : key_of(first), rule);
    }
  }
}
}  // namespace altiplan
