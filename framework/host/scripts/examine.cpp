// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/sha256.hpp"
#include "host/base/words.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kOffer = "@altiplan.";
constexpr std::string_view kKinds[] = {"environment", "constraint", "planner", "smoother",
                                       "objective"};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A decorator that begins a line.
struct Offer {
  std::string kind;
  std::size_t at;  ///< of its arguments
};

std::vector<Offer> offers_in(const std::string& text) {
  std::vector<Offer> found;
  for (std::size_t at = text.find(kOffer); at != text.npos; at = text.find(kOffer, at + 1)) {
    const std::string_view rest = std::string_view(text).substr(at + kOffer.size());
    for (const std::string_view kind : kKinds) {
      if ((at == 0 || text[at - 1] == '\n') && rest.starts_with(std::string(kind) + "(")) {
        found.push_back({std::string(kind), at + kOffer.size() + kind.size() + 1});
      }
    }
  }
  return found;
}

void skip_blanks(const std::string& text, std::size_t& at) {
  while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) {
    ++at;
  }
}

/// A text in quotes, or several in a row, as Python joins them; none if there is none.
std::optional<std::string> literal(const std::string& text, std::size_t& at) {
  std::optional<std::string> found;
  for (skip_blanks(text, at); at < text.size() && (text[at] == '"' || text[at] == '\'');
       skip_blanks(text, at)) {
    const std::size_t end = text.find(text[at], at + 1);
    const std::string one = end == text.npos ? "" : text.substr(at + 1, end - at - 1);
    if (end == text.npos || one.find_first_of("\n\\") != one.npos) {
      return std::nullopt;
    }
    found = found.value_or("") + one;
    at = end + 1;
  }
  return found;
}

/// Throws PluginError for a decorator without a name and a sentence.
Manifest manifest_of(const Offer& offer, const std::string& text, const fs::path& file) {
  std::size_t at = offer.at;
  const std::string place =
      "line " +
      std::to_string(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n') + 1);
  const std::optional<std::string> name = literal(text, at);
  const bool parted = at < text.size() && text[at] == ',';
  const std::optional<std::string> sentence = literal(text, ++at);
  if (!name || !parted || !sentence) {
    throw PluginError(place + ": expected @altiplan." + offer.kind +
                      "(\"name\", \"what it does\", Params), " +
                      "name and sentence as plain texts");
  }
  if (!is_snake_case(*name) || name->size() >= sizeof(Manifest::name)) {
    throw PluginError(place + ": offers a " + offer.kind + " named " + excerpt(*name) +
                      ", expected lower-case letters, digits and '_'");
  }
  if (sentence->empty() || sentence->size() >= sizeof(Manifest::sentence)) {
    throw PluginError(place + ": the sentence of '" + *name + "' has " +
                      std::to_string(sentence->size()) + " bytes, expected 1 to " +
                      std::to_string(sizeof(Manifest::sentence) - 1));
  }
  Manifest manifest = make_manifest("", "", "");
  offer.kind.copy(manifest.kind, sizeof manifest.kind - 1);
  std::copy(name->begin(), name->end(), manifest.name);
  std::copy(sentence->begin(), sentence->end(), manifest.sentence);
  std::memset(manifest.compiler, 0, sizeof manifest.compiler);
  std::memcpy(manifest.compiler, "Python", 6);
  std::memset(manifest.file, 0, sizeof manifest.file);
  file.filename().string().copy(manifest.file, sizeof manifest.file - 1);
  manifest.checksum = checksum_of(manifest);
  return manifest;
}
}  // namespace

bool is_script(const fs::path& file) { return file.extension() == ".py"; }

bool offers_scripts(const fs::path& file) {
  return is_script(file) && fs::is_regular_file(status_of(file)) &&
         !offers_in(text_of(file)).empty();
}

Library examine_script(const fs::path& file) {
  Library library;
  library.file = file;
  if (const int error = reading_error(file); error != 0) {
    library.refused = std::string("cannot be read: ") + std::strerror(error);
    library.is_machine_fault = is_machine_fault(error);
    return library;
  }
  const std::string text = text_of(file);
  library.build = library.checksum = sha256_of(text);
  try {
    for (const Offer& offer : offers_in(text)) {
      library.plugins.push_back(manifest_of(offer, text, file));
    }
    if (library.plugins.empty()) {
      throw PluginError(
          "offers nothing: expected a line that begins with @altiplan.planner(\"name\", … or "
          "likewise with smoother, environment or constraint, in UTF-8");
    }
  } catch (const PluginError& error) {
    library.refused = error.what();
  }
  return library;
}
}  // namespace altiplan::host
