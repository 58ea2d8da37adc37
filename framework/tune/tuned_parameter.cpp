// SPDX-License-Identifier: Apache-2.0
#include "tune/tuned_parameter.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "altiplan/attributed.hpp"
#include "host/config/config_check.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::tune {
namespace {

[[noreturn]] void refuse(const OverEntry& entry, const std::string& message) {
  throw ConfigError(Location{"", 0, 0, "--over " + entry.option}, entry.key, message);
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size() && std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Expands a{b,c}d to its keys; accepts a list of keys without braces too.
std::vector<std::string> keys_of(const std::string& text, const std::string& option) {
  const std::size_t open = text.find('{');
  const std::size_t close = text.find('}');
  std::vector<std::string> keys;
  if (open == std::string::npos && close == std::string::npos) {
    keys = split(text);
  } else if (open < close && close != std::string::npos &&
             text.find('{', open + 1) == std::string::npos &&
             text.find('}', close + 1) == std::string::npos) {
    for (const std::string& part :
         split(std::string_view(text).substr(open + 1, close - open - 1))) {
      keys.push_back(part.empty() ? "" : text.substr(0, open) + part + text.substr(close + 1));
    }
  }
  if (keys.empty() ||
      std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return key.empty(); })) {
    throw Error("--over: expected keys, as steps.0.with.{a,b}, found '" + option + "'");
  }
  return keys;
}

/// LO..HI or log:LO..HI
void read_range(std::string_view text, OverEntry& entry) {
  entry.is_logarithmic = text.starts_with("log:");
  text.remove_prefix(entry.is_logarithmic ? 4 : 0);
  const std::size_t dots = text.find("..");
  const auto low = number_of(text.substr(0, dots));
  const auto high =
      dots == std::string_view::npos ? std::nullopt : number_of(text.substr(dots + 2));
  if (!low || !high || *low > *high) {
    throw Error("--over: expected KEY=LO..HI, KEY=log:LO..HI or KEYS=simplex, found '" +
                entry.option + "'");
  }
  if (entry.is_logarithmic && *low <= 0) {
    throw Error("--over: expected log:LO..HI with LO greater than 0, found '" + entry.option + "'");
  }
  entry.min = *low;
  entry.max = *high;
}

/// The step named by the first words of the key; sets the rest of the key.
const host::StepEntry* step_of(const host::Config& config, std::string_view key,
                               std::string_view& rest) {
  const auto find_in = [&](const std::vector<host::StepEntry>& steps) -> const host::StepEntry* {
    for (const host::StepEntry& step : steps) {
      if (key.starts_with(step.path + ".with.")) {
        rest = key.substr(step.path.size() + 6);
        return &step;
      }
    }
    return nullptr;
  };
  for (const host::StepEntry& step : config.steps) {
    if (const host::StepEntry* other = find_in(step.otherwise)) {
      return other;
    }
  }
  return find_in(config.steps);
}

/// The number within a list of the file: cell_m.0.
const Value* part_of(const Value& list, std::string_view path) {
  const Value* at = &list;
  while (!path.empty() && at != nullptr) {
    const std::size_t end = std::min(path.find('.'), path.size());
    const std::string_view word = path.substr(0, end);
    if (at->kind == Value::Kind::list) {
      std::size_t index = 0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
      const bool is_index = error == std::errc() && stop == word.data() + word.size() &&
                            std::to_string(index) == word;  // "01" would be another key
      at = is_index && index < at->items.size() ? &at->items[index] : nullptr;
    } else {
      at = at->find(word);
    }
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return at;
}

void expect_fitting(const OverEntry& entry, const FieldSpec& spec) {
  if (spec.type == FieldType::integer && entry.group >= 0) {
    refuse(entry, "takes whole numbers, which cannot be weights that sum to 1");
  }
  const bool below = spec.above ? entry.min <= spec.min : entry.min < spec.min;
  if (below || entry.max > spec.max) {
    const auto text = [](double number) { return host::exact_json_text(number); };
    const std::string low =
        std::isfinite(spec.min) ? (spec.above ? "more than " : "at least ") + text(spec.min) : "";
    const std::string high = std::isfinite(spec.max) ? "at most " + text(spec.max) : "";
    refuse(entry, "has the range " + text(entry.min) + " to " + text(entry.max) +
                      ", but the parameter must be " + low +
                      (low.empty() || high.empty() ? "" : " and ") + high);
  }
  constexpr double kMaxWhole = 1e15;
  if (spec.type == FieldType::integer && (std::ceil(entry.min) > std::floor(entry.max) ||
                                          entry.min < -kMaxWhole || entry.max > kMaxWhole)) {
    refuse(entry, "takes whole numbers, of which the range has none or too many: " +
                      host::exact_json_text(entry.min) + " to " + host::exact_json_text(entry.max));
  }
}

bool is_number(FieldType type) {
  return type == FieldType::number || type == FieldType::integer || type == FieldType::auto_number;
}

/// The declaration of the number named by the rest of a key, `name` or `name.0`.
FieldSpec spec_of(const BoundField& field, const host::StepEntry& step, std::string_view inner,
                  const OverEntry& entry, TunedParameter& found) {
  FieldSpec spec = field.spec;
  found.as_it_is = field.value_json;
  if (inner.empty()) {
    if (!is_number(spec.type)) {
      refuse(entry,
             "is not a number" +
                 std::string(spec.type == FieldType::vec2 || spec.type == FieldType::vec3 ||
                                     spec.type == FieldType::list
                                 ? ": its numbers are tuned one by one, as " + entry.key + ".0"
                                 : ", which alone can be tuned"));
    }
    return spec;
  }
  const bool is_vector = spec.type == FieldType::vec2 || spec.type == FieldType::vec3;
  const bool is_list = spec.type == FieldType::list && is_number(spec.children.at(0).type);
  if (!is_vector && !is_list) {
    refuse(entry, "'" + spec.name + "' is not a list of numbers");
  }
  const Value* written = step.with.find(spec.name);
  const Value* part = written == nullptr ? nullptr : part_of(*written, inner);
  if (written == nullptr) {
    refuse(entry, "write the list '" + spec.name +
                      "' in the pipeline: no number of an omitted list can be set");
  }
  if (part == nullptr || part->kind != Value::Kind::scalar) {
    refuse(entry, "'" + std::string(inner) + "' is not an index of this list, counted from 0");
  }
  found.as_it_is = part->text;
  spec.type = is_list ? spec.children[0].type : FieldType::number;
  return spec;
}

TunedParameter find_parameter(const host::Config& config, const OverEntry& entry) {
  std::string_view rest;
  const host::StepEntry* step = step_of(config, entry.key, rest);
  if (step == nullptr || step->plugin == host::kFollowRoute) {
    std::vector<std::string> steps;
    for (const host::StepEntry& known : config.steps) {
      steps.push_back(known.path + ".with");
    }
    refuse(entry, "does not name a parameter of a step: expected " + steps.front() +
                      ".NAME, by the steps' numbers from 0" +
                      (steps.size() > 1 ? " to " + std::to_string(steps.size() - 1) : ""));
  }
  const std::string kind = host::kind_of_step(*config.registry, *step);
  const ParamReport report =
      attributed([&] { return "describing the " + kind + " '" + step->plugin + "'"; },
                 [&] {
                   return plugin(*config.registry, kind, step->plugin)
                       .describe(&step->with, step->path + ".with");
                 });
  const std::size_t dot = rest.find('.');
  const std::string name(rest.substr(0, dot));
  std::vector<std::string> names;
  for (const BoundField& field : report.fields) {
    names.push_back(field.spec.name);
    if (field.spec.name == name) {
      TunedParameter found{entry, false, ""};
      const std::string_view inner = dot == rest.npos ? std::string_view() : rest.substr(dot + 1);
      const FieldSpec spec = spec_of(field, *step, inner, entry, found);
      found.is_whole = spec.type == FieldType::integer;
      expect_fitting(entry, spec);
      return found;
    }
  }
  refuse(entry, "'" + step->plugin + "' has no parameter '" + name + "'" +
                    host::did_you_mean(name, names));
}
}  // namespace

std::vector<OverEntry> read_over(const std::vector<std::string>& options) {
  std::vector<OverEntry> entries;
  std::set<std::string> known;
  int groups = 0;
  for (const std::string& option : options) {
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw Error("--over: expected KEY=LO..HI, KEY=log:LO..HI or KEYS=simplex, found '" + option +
                  "'");
    }
    const std::vector<std::string> keys = keys_of(option.substr(0, equals), option);
    const bool is_simplex = option.substr(equals + 1) == "simplex";
    if (is_simplex && keys.size() < 2) {
      throw Error("--over: expected two or more weights of a simplex, found '" + option + "'");
    }
    for (const std::string& key : keys) {
      OverEntry entry{option, key};
      if (is_simplex) {
        entry.group = groups;
      } else {
        read_range(std::string_view(option).substr(equals + 1), entry);
      }
      if (!known.insert(key).second) {
        throw Error("--over: '" + key + "' is given twice");
      }
      entries.push_back(std::move(entry));
    }
    groups += is_simplex;
  }
  return entries;
}

std::string TunedParameter::shown() const {
  const host::Json value = host::json_or_discarded(as_it_is);
  return value.is_string() ? value.get<std::string>() : as_it_is;
}

Dimension TunedParameter::dimension() const {
  double min = over.min;
  double max = over.max;
  if (is_whole) {
    min = std::ceil(min) - 0.5;
    max = std::floor(max) + 0.5;
  }
  if (over.is_logarithmic) {
    min = std::log(min);
    max = std::log(max);
  }
  return {over.key, min, max, over.group};
}

std::string TunedParameter::value(double number) const {
  const double raw = over.is_logarithmic ? std::exp(number) : number;
  if (is_whole) {
    const double whole = std::clamp(std::round(raw), std::ceil(over.min), std::floor(over.max));
    return std::to_string(std::int64_t(whole));
  }
  return host::exact_json_text(std::clamp(raw, over.min, over.max));
}

std::vector<TunedParameter> find_parameters(const host::Config& config,
                                            const std::vector<OverEntry>& entries) {
  std::vector<TunedParameter> found;
  for (const OverEntry& entry : entries) {
    found.push_back(find_parameter(config, entry));
  }
  return found;
}
}  // namespace altiplan::tune
