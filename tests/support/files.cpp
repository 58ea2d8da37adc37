// SPDX-License-Identifier: Apache-2.0
#include "support/files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "host/config/yaml.hpp"
#include "host/gate/route_returns.hpp"
#include "host/run/pipeline.hpp"
#include "support/folders.hpp"

namespace altiplan::testing {
namespace fs = std::filesystem;
namespace {

host::Json typed(const Value& value) {
  host::Json json;
  switch (value.kind) {
    case Value::Kind::list:
      json = host::Json::array();
      for (const Value& item : value.items) {
        json.push_back(typed(item));
      }
      return json;
    case Value::Kind::map:
      json = host::Json::object();
      for (const Value::Entry& entry : value.entries) {
        json[entry.key] = typed(entry.value);
      }
      return json;
    case Value::Kind::scalar:
      break;
  }
  if (!value.quoted && (value.text == "true" || value.text == "false")) {
    return value.text == "true";
  }
  const char* end = value.text.data() + value.text.size();
  if (std::int64_t whole = 0;
      !value.quoted && std::from_chars(value.text.data(), end, whole).ptr == end) {
    return whole;
  }
  if (double number = 0;
      !value.quoted && std::from_chars(value.text.data(), end, number).ptr == end) {
    return number;
  }
  return value.text;
}
}  // namespace

TempFolder::TempFolder() {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "_" + test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  path_ = fs::path(::testing::TempDir()) / ("altiplan_" + std::to_string(::getpid()) + "_" + name);
  fs::remove_all(path_);
  fs::create_directories(path_);
}

TempFolder::~TempFolder() { fs::remove_all(path_); }

fs::path TempFolder::write(std::string_view name, std::string_view text) const {
  const fs::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw std::runtime_error("cannot read " + file.string());
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    throw std::invalid_argument("'" + std::string(from) + "' does not stand in: " + text);
  }
  return text.replace(at, from.size(), to);
}

Ran run_file(const fs::path& pipeline, host::Overrides overrides, int threads) {
  overrides.plugin_path.push_back(altiplan::folders::build() / "lib/altiplan/plugins");
  const host::Config config = host::load_config(pipeline, overrides);
  host::RunOptions options;
  options.threads = threads;
  options.judge_returns = host::judge_route_returns;
  const host::RunResult result = host::run(config, options);
  return {host::result_json(config, result), result.exit_code()};
}

host::Json yaml_as_json(const fs::path& file) { return typed(host::load_yaml(file)); }

std::string schema_disagreement(const host::Json& schema,
                                const std::vector<std::pair<bool, host::Json>>& cases) {
  const TempFolder folder;
  host::Json list = host::Json::array();
  for (const auto& [fits, document] : cases) {
    host::Json one = host::Json::object();
    one["fits"] = fits;
    one["file"] = document;
    list.push_back(std::move(one));
  }
  const std::string command = "/usr/bin/python3 " + altiplan::folders::source().string() +
                              "/tests/host/check_schema.py " +
                              folder.write("schema.json", schema.dump(1)).string() + " " +
                              folder.write("cases.json", list.dump(1)).string() + " > " +
                              (folder / "said").string() + " 2>&1";
  const int status = std::system(command.c_str());
  return status == 0 ? "" : "status " + std::to_string(status) + ": " + text_of(folder / "said");
}

bool has_schema_validator() {
  return std::system("/usr/bin/python3 -c 'import jsonschema' 2>/dev/null") == 0;
}
}  // namespace altiplan::testing
