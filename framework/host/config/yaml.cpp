// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml.hpp"

#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <optional>
#include <sstream>

#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"
#include "host/config/json_reader.hpp"
#include "host/config/yaml_reader.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

/// Translates yaml-cpp's message into what the user has to change.
std::string plain_words(const std::string& message) {
  using namespace YAML::ErrorMsg;
  static const std::map<std::string, std::string> kWords = {
      {END_OF_MAP,
       "this does not belong in the map around it: check the indentation, that each key is "
       "followed by ': ', and that each item of a list starts with '- '"},
      {END_OF_MAP_FLOW, "the map that starts with '{' is not closed properly: expected ',' or '}'"},
      {END_OF_SEQ,
       "this does not belong in the list around it: check the indentation, and that each item "
       "starts with '- '"},
      {END_OF_SEQ_FLOW,
       "the list that starts with '[' is not closed properly: expected ',' or ']'"},
      {EOF_IN_SCALAR, "the closing quote is missing"},
      {DOC_IN_SCALAR, "the closing quote is missing before '---' or '...'"},
      {MAP_VALUE,
       "a ':' without a key: quote the text if the ':' is part of it; otherwise check the "
       "indentation, and that a space follows each ':' and each item's '-'"},
      {MAP_KEY, "a key is not allowed here: check the indentation"},
      {BLOCK_ENTRY, "a list item ('- ') is not allowed here: check the indentation"},
      {FLOW_END, "a closing bracket that does not match the opening one"},
      {UNKNOWN_TOKEN, "a character that cannot start a value: quote the text"},
      {UNKNOWN_ANCHOR, "an alias ('*name') without an anchor ('&name') before it"},
      {ALIAS_NOT_FOUND, "a '*' starts an alias: quote the text if the '*' is part of it"},
      {ANCHOR_NOT_FOUND, "a '&' starts an anchor: quote the text if the '&' is part of it"},
      {TAG_WITH_NO_SUFFIX, "tags ('!…') are not supported: remove the tag"},
      {TAB_IN_INDENTATION, "a tab indents this line: indent with spaces"},
  };
  if (message.starts_with(INVALID_ESCAPE)) {
    return "'\\" + message.substr(std::string_view(INVALID_ESCAPE).size()) +
           "' is not an escape in double quotes: write '\\\\', or use single quotes";
  }
  const auto found = kWords.find(message);
  return found != kWords.end() ? found->second : "not well-formed YAML: " + message;
}

/// Records the start of a second document, and stops there.
class Rest final : public YAML::EventHandler {
 public:
  explicit Rest(const YamlSource& source) : source_(source) {}
  void OnDocumentStart(const YAML::Mark& mark) override {
    const bool marked = source_.from(mark).substr(0, 3) == "---";
    throw ConfigError(source_.at(mark), "",
                      marked ? "a second document ('---'): one file holds one document"
                             : "text after the end of the document: check the indentation, and "
                               "that each key is followed by ': '");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  const YamlSource& source_;
};

Value parse(const YamlSource& source, const char* when_empty) {
  scan_characters(source);
  if (std::optional<Value> json = read_if_json(source)) {
    return std::move(*json);
  }
  YamlReader reader(source);
  try {
    std::istringstream stream{std::string(source.text())};
    YAML::Parser parser(stream);
    parser.HandleNextDocument(reader);
    Rest rest(source);
    parser.HandleNextDocument(rest);
  } catch (const YAML::Exception& error) {
    reader.problems().push_back({source.at(error.mark), "", plain_words(error.msg)});
  }
  if (!reader.problems().empty()) {
    throw ConfigError(std::move(reader.problems()));
  }
  if (reader.empty()) {
    throw ConfigError(source.at(YAML::Mark::null_mark()), "", when_empty);
  }
  return reader.tree();
}

std::string read_file(const std::filesystem::path& file) {
  try {
    return formats::read_file(file.string(), kMaxBytes);
  } catch (const formats::InputError& error) {
    if (is_machine_fault(reading_error(file))) {
      throw MachineFault(error.what());
    }
    throw ConfigError({file.string(), 0, 0, ""}, "", error.why());
  }
}
}  // namespace

Value load_yaml(const std::filesystem::path& file) {
  if (const auto ending = file.extension(); ending == ".plan" || ending == ".waypoints") {
    throw ConfigError(
        Location{file.string(), 0, 0, ""}, "",
        "is a mission, expected a YAML file: `altiplan check` judges a mission and mends "
        "it, `altiplan view` shows it, `altiplan upload` loads it into a vehicle");
  }
  return parse_yaml(read_file(file), file.string());
}

Value parse_yaml(std::string_view text, const std::string& name) {
  if (text.size() > kMaxBytes) {
    throw ConfigError({name, 0, 0, ""}, "", "is larger than 16 MiB, the maximum");
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") {
    text.remove_prefix(3);
  }
  return parse(YamlSource(text, name, ""), "the file is empty");
}

Value parse_override(std::string_view text, const std::string& assignment) {
  if (text.find('\n') != text.npos || text.size() > kMaxBytes) {
    throw ConfigError({"", 0, 0, assignment}, "", "expected a value on one line");
  }
  return parse(YamlSource(text, "", assignment), "has no value");
}
}  // namespace altiplan::host
