// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "altiplan/error.hpp"
#include "report.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kEntry =
    "Plugin entry: a kind, a name in snake_case, a sentence, one factory";
constexpr const char* kDescribe = "Plugin parameters: describe never throws";
constexpr const char* kNamed = "Plugin parameters: names in snake_case, each with a sentence";
constexpr const char* kDefaults = "Plugin parameters: defaults lie within their own bounds";
constexpr const char* kRefuses =
    "Plugin parameters: unknown keys and values out of bounds are reported";
constexpr const char* kMakes =
    "Plugin entry: creates any number of objects, and throws nothing but the framework's Error";

bool is_snake_case(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name[0] >= 'a' && name[0] <= 'z' && name.back() != '_' &&
         name.find("__") == std::string::npos && std::all_of(name.begin(), name.end(), allowed);
}

Value scalar(std::string text) {
  Value value;
  value.text = std::move(text);
  value.where.file = "conformance";
  return value;
}

Value map_of(const std::string& key, Value inner) {
  Value value;
  value.kind = Value::Kind::map;
  value.where = inner.where;
  value.entries.push_back({key, inner.where, std::move(inner)});
  return value;
}

Value list_of(std::vector<Value> items) {
  Value value;
  value.kind = Value::Kind::list;
  value.where.file = "conformance";
  value.items = std::move(items);
  return value;
}

bool is_number(FieldType type) {
  return type == FieldType::integer || type == FieldType::number || type == FieldType::auto_number;
}

std::size_t numbers_in(FieldType type) {
  return type == FieldType::vec2 ? 2 : type == FieldType::vec3 ? 3 : 0;
}

/// The numbers of a JSON text outside of strings.
std::vector<double> numbers_of(const std::string& json) {
  std::vector<double> all;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size();) {
    double number = 0;
    quoted ^= json[i] == '"';
    const auto [end, error] = std::from_chars(json.data() + i, json.data() + json.size(), number);
    if (!quoted && error == std::errc() && (json[i] == '-' || std::isdigit(json[i]))) {
      all.push_back(number);
      i = std::size_t(end - json.data());
    } else {
      ++i;
    }
  }
  return all;
}

bool within(double value, const FieldSpec& spec) {
  return (spec.above ? value > spec.min : value >= spec.min) && value <= spec.max;
}

using Wrap = std::function<Value(Value)>;

/// Visits the declaration, including the fields of structures and of lists of them. `wrap` puts a
/// field's value where the plugin reads it.
void walk(const std::vector<FieldSpec>& specs, const Wrap& wrap,
          const std::function<void(const FieldSpec&, const Wrap&)>& visit) {
  for (const FieldSpec& spec : specs) {
    if (spec.name.empty()) {  // a point's keys; a plugin's
      continue;
    }
    const Wrap inner = [wrap, name = spec.name](Value value) {
      return wrap(map_of(name, std::move(value)));
    };
    visit(spec, inner);
    if (spec.type == FieldType::structure) {
      walk(spec.children, inner, visit);
    } else if (spec.type == FieldType::list && !spec.children.empty() &&
               spec.children[0].type == FieldType::structure) {
      walk(
          spec.children[0].children,
          [inner](Value value) { return inner(list_of({std::move(value)})); }, visit);
    }
  }
}

std::vector<FieldSpec> declared(const PluginEntry& entry) {
  std::vector<FieldSpec> specs;
  for (const BoundField& field : entry.describe(nullptr, "").fields) {
    specs.push_back(field.spec);
  }
  return specs;
}

void whole_entry(const PluginEntry& entry, Report& report) {
  const std::string kind = entry.kind == nullptr ? "" : entry.kind;
  const std::vector<std::pair<std::string, bool>> makers{
      {"environment", entry.environment != nullptr},
      {"constraint", entry.constraint != nullptr},
      {"planner", entry.planner != nullptr},
      {"local_planner", entry.local_planner != nullptr},
      {"smoother", entry.smoother != nullptr},
      {"tuner", entry.tuner != nullptr},
      {"objective", entry.objective != nullptr},
      {"task", entry.task != nullptr}};
  for (const auto& [of, set] : makers) {
    report.expect(set == (of == kind), kEntry, [&, of = of, set = set] {
      return "of kind '" + kind + "', the factory of " + of + (set ? " is set" : " is not set");
    });
  }
  const bool known = std::any_of(makers.begin(), makers.end(),
                                 [&](const auto& maker) { return maker.first == kind; });
  report.expect(known, kEntry, [&] { return "there is no kind '" + kind + "'"; });
  const std::string name = entry.name == nullptr ? "" : entry.name;
  report.expect(is_snake_case(name), kEntry, [&] { return "the name is '" + name + "'"; });
  report.expect(entry.sentence != nullptr && entry.sentence[0] != '\0', kEntry,
                [] { return "there is no sentence"; });
  const std::string sentence = entry.sentence == nullptr ? "" : entry.sentence;
  report.expect(std::none_of(sentence.begin(), sentence.end(),
                             [](unsigned char c) { return c < ' ' || c == 0x7F; }),
                kEntry, [] { return "the sentence holds a control character"; });
}

void declaration(const PluginEntry& entry, Report& report) {
  report.expect(entry.describe(nullptr, "").problems.empty(), kDescribe,
                [] { return "without a map of parameters there are problems"; });
  const auto as_is = [](Value value) { return value; };
  walk(declared(entry), as_is, [&](const FieldSpec& spec, const Wrap&) {
    report.expect(is_snake_case(spec.name) && !spec.doc.empty(), kNamed, [&] {
      return "'" + spec.name + "'" + (spec.doc.empty() ? " has no sentence" : "");
    });
    const bool numeric = is_number(spec.type) || numbers_in(spec.type) > 0;
    report.expect(!numeric || spec.min <= spec.max, kDefaults,
                  [&] { return "'" + spec.name + "': no value lies within its bounds"; });
    for (const double value : numeric ? numbers_of(spec.default_json) : std::vector<double>{}) {
      report.expect(within(value, spec), kDefaults, [&] {
        return "'" + spec.name + "' is " + text(value) + " by default, its bounds are " +
               text(spec.min) + (spec.above ? " (not itself)" : "") + " to " + text(spec.max);
      });
    }
    report.expect(spec.type != FieldType::choice || !spec.choices.empty(), kDefaults,
                  [&] { return "'" + spec.name + "' has no word to choose"; });
  });
}

/// True if describing the parameters reports a problem that names the key.
bool reported(const PluginEntry& entry, const Value& parameters, const std::string& key) {
  const ParamReport report = entry.describe(&parameters, "with");
  return std::any_of(report.problems.begin(), report.problems.end(), [&](const Problem& problem) {
    return (problem.key + " " + problem.message).find(key) != std::string::npos;
  });
}

void refuses(const PluginEntry& entry, Report& report) {
  const auto must = [&](const Value& parameters, const std::string& key, const std::string& what) {
    report.expect(reported(entry, parameters, key), kRefuses,
                  [&] { return "no problem is reported for " + what; });
  };
  must(map_of("no_such_key", scalar("1")), "no_such_key", "the unknown key 'no_such_key'");
  must(scalar("text"), "expected a map", "a text in place of the map");
  const auto as_is = [](Value value) { return value; };
  walk(declared(entry), as_is, [&](const FieldSpec& spec, const Wrap& wrap) {
    const std::size_t axes = numbers_in(spec.type);
    const bool list_of_numbers = spec.type == FieldType::list && is_number(spec.children[0].type);
    const auto give = [&](const std::string& number) {
      std::vector<Value> items(list_of_numbers ? 1 : axes, scalar(number));
      const Value value = items.empty() ? scalar(number) : list_of(std::move(items));
      must(wrap(value), spec.name, "'" + spec.name + "' with the value " + number);
    };
    if (is_number(spec.type) || axes > 0 || list_of_numbers) {
      give("a_word");
      give("nan");
      if (std::isfinite(spec.min)) {
        give(spec.above ? text(spec.min) : std::to_string(std::int64_t(std::floor(spec.min)) - 1));
      }
      if (std::isfinite(spec.max)) {
        give(std::to_string(std::int64_t(std::ceil(spec.max)) + 1));
      }
    }
    if (spec.type == FieldType::choice || spec.type == FieldType::boolean) {
      must(wrap(scalar("no_such_word")), spec.name, "'" + spec.name + "' with no_such_word");
    }
  });
}

void makes(const PluginEntry& entry, Report& report) {
  const World empty;
  Site site;
  site.before = &empty;
  site.volume = {{0, 0, 0}, {1000, 1000, 1000}};
  const auto make = [&](const Value* parameters) {
    return (entry.environment != nullptr && entry.environment(parameters, site) != nullptr) ||
           (entry.constraint != nullptr && entry.constraint(parameters, site) != nullptr) ||
           (entry.planner != nullptr && entry.planner(parameters) != nullptr) ||
           (entry.local_planner != nullptr && entry.local_planner(parameters) != nullptr) ||
           (entry.smoother != nullptr && entry.smoother(parameters) != nullptr) ||
           (entry.tuner != nullptr && entry.tuner(parameters) != nullptr) ||
           (entry.objective != nullptr && entry.objective(parameters, site) != nullptr) ||
           (entry.task != nullptr && entry.task(parameters, site) != nullptr);
  };
  const Value wrong = map_of("no_such_key", scalar("1"));
  try {
    (void)make(&wrong);
    report.add(kMakes, "an object is created from parameters with an unknown key");
  } catch (const Error&) {
  }
  const Value none = [] {
    Value map;
    map.kind = Value::Kind::map;
    return map;
  }();
  if (!entry.describe(&none, "").problems.empty()) {
    return;  // something is required
  }
  try {
    for (int i = 0; i < 2; ++i) {
      report.expect(make(nullptr) && make(&none), kMakes,
                    [] { return "nothing is created from the default parameters"; });
    }
  } catch (const Error& error) {
    // A layer may need another before it, an objective or a constraint what the scenario tells of
    // the vehicle; one that needs none is made from the parameters that describe accepts.
    const bool may_need =
        entry.environment != nullptr || entry.objective != nullptr || entry.constraint != nullptr;
    report.expect(may_need, kMakes, [&] {
      return std::string("describe accepts the default parameters, the factory does not: ") +
             error.what();
    });
  }
}
}  // namespace

Cases plugin_cases(const PluginEntry& entry) {
  const auto made = [&](const char* name, const char* thrown,
                        void (*body)(const PluginEntry&, Report&)) {
    return make_case(name, thrown, [entry, body](Report& report) { body(entry, report); });
  };
  return {made("entry_is_whole", kEntry, whole_entry),
          made("parameters_are_declared_well", kDescribe, declaration),
          made("wrong_parameters_are_refused", kDescribe, refuses),
          made("objects_are_made", kMakes, makes)};
}
}  // namespace altiplan::conformance
