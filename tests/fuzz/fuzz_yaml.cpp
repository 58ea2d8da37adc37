// SPDX-License-Identifier: Apache-2.0
// A text as a pipeline, a scenario, whichever its keys say, and a --set value: read, and held
// against the descriptions of the plugins that it names.
#include <algorithm>

#include "altiplan/error.hpp"
#include "fuzz/memory_file.hpp"
#include "host/config/config.hpp"
#include "host/config/yaml.hpp"

namespace {
using namespace altiplan;

constexpr const char* kScenario =
    "altiplan: 1\nenvironment: [{sphere: {at_m: [50, 50, 50], radius_m: 10}}]\n"
    "volume: {max_m: [100, 100, 100]}\nstart: {at_m: [1, 1, 1]}\ngoal: {at_m: [99, 99, 99]}\n";

/// Whether a text of the document could lead out of the folder: such an input would test whatever
/// lies on this machine.
bool leads_elsewhere(const Value& value) {
  return value.text.find('/') != value.text.npos || value.text.find("..") != value.text.npos ||
         std::any_of(value.items.begin(), value.items.end(), leads_elsewhere) ||
         std::any_of(value.entries.begin(), value.entries.end(),
                     [](const Value::Entry& entry) { return leads_elsewhere(entry.value); });
}

void read(std::string_view text) {
  static const fuzz::MemoryFolder kFolder;
  const Value tree = host::parse_yaml(text, "fuzz.yaml");
  if (leads_elsewhere(tree)) {
    return;
  }
  const std::filesystem::path file = kFolder.write("fuzz.yaml", text);
  host::Overrides overrides;
  if (host::kind_of(tree) == host::FileKind::scenario) {
    host::explain(host::load_scenario(file, overrides));
  } else {
    overrides.scenario = kFolder.write("scenario.yaml", kScenario);
    host::explain(host::load_config(file, overrides));
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  try {
    host::parse_override(text, "--set fuzz");
  } catch (const ConfigError&) {
  }
  try {
    read(text);
  } catch (const Error&) {
  }
  return 0;
}
