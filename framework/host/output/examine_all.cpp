// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "altiplan/error.hpp"
#include "host/config/shapes.hpp"
#include "host/output/describe.hpp"

namespace altiplan::host {
namespace {

using Json = nlohmann::ordered_json;

constexpr unsigned kPatienceSeconds = 20;
constexpr const char* kWell = "well";

/// In the child: loads the library and asks each plugin for its parameters.
[[noreturn]] void try_library(Registry& registry, const Library& library, int report) {
  std::string text = kWell;
  try {
    for (const Manifest& plugin : library.plugins) {
      registry.get(plugin.kind, plugin.name).describe(nullptr, "");
    }
  } catch (const std::exception& error) {
    text = error.what();
  } catch (...) {
    text = "throws something that is not a std::exception";
  }
  const ssize_t written = ::write(report, text.data(), text.size());
  ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
}

/// Why the library cannot be used; "" where it can.
std::string trial(Registry& registry, const Library& library) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(std::string("no pipe for examining a library: ") + std::strerror(errno));
  }
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw Error(std::string("no process for examining a library: ") + std::strerror(errno));
  }
  if (child == 0) {
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(kPatienceSeconds);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // results alone stand on stdout
    try_library(registry, library, ends[1]);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[1024];
  ssize_t got = 0;
  while ((got = ::read(ends[0], buffer, sizeof buffer)) > 0 || (got < 0 && errno == EINTR)) {
    text.append(buffer, got > 0 ? static_cast<std::size_t>(got) : 0);
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
    return "did not load within " + std::to_string(kPatienceSeconds) + " s";
  }
  if (WIFSIGNALED(status)) {
    return std::string("loading it ends the process: ") + ::strsignal(WTERMSIG(status));
  }
  if (text.empty()) {
    return "loading it ends the process with exit code " + std::to_string(WEXITSTATUS(status));
  }
  return text == kWell ? "" : text;
}
}  // namespace

std::vector<Library> examine_all(Registry& registry) {
  std::vector<Library> libraries = registry.libraries();
  for (Library& library : libraries) {
    if (library.refused.empty()) {
      library.refused = trial(registry, library);
    }
  }
  return libraries;
}

std::string plugins_text(const Registry& registry, const std::vector<Library>& libraries) {
  std::string text;
  const auto line = [&](const std::string& kind, const std::string& name,
                        const std::string& sentence) {
    const std::string head = kind + " " + name;
    text += head + std::string(head.size() < 32 ? 32 - head.size() : 1, ' ') + sentence + "\n";
  };
  for (const PluginEntry& entry : built_in_environments()) {
    line(entry.kind, entry.name, std::string(entry.sentence) + " (built in)");
  }
  std::string refused;
  for (const Library& library : libraries) {
    if (!library.refused.empty()) {
      refused += "refused: " + library.file.string() + ": " + library.refused + "\n";
      continue;
    }
    for (const Manifest& plugin : library.plugins) {
      line(plugin.kind, plugin.name, plugin.sentence);
    }
  }
  text += refused;
  for (const LibraryCopy& copy : registry.copies()) {
    text += "passed over: " + copy.file.string() + ": the same build as " + copy.used.string() +
            ", which comes first\n";
  }
  for (const std::filesystem::path& folder : registry.folders()) {
    text += "searched: " + folder.string() +
            (std::filesystem::is_directory(folder) ? "" : " (no such folder)") + "\n";
  }
  return text;
}

Json plugins_json(const Registry& registry, const std::vector<Library>& libraries) {
  Json json = {{"folders", Json::array()},
               {"built_in", Json::array()},
               {"libraries", Json::array()},
               {"copies", Json::array()}};
  for (const std::filesystem::path& folder : registry.folders()) {
    json["folders"].push_back(folder.string());
  }
  for (const PluginEntry& entry : built_in_environments()) {
    json["built_in"].push_back(
        {{"kind", entry.kind}, {"name", entry.name}, {"sentence", entry.sentence}});
  }
  for (const Library& library : libraries) {
    Json plugins = Json::array();
    for (const Manifest& plugin : library.plugins) {
      plugins.push_back(
          {{"kind", plugin.kind},
           {"name", plugin.name},
           {"sentence", plugin.sentence},
           {"api", std::to_string(plugin.api_major) + "." + std::to_string(plugin.api_minor)},
           {"compiler", plugin.compiler},
           {"optimised", plugin.optimised != 0}});
    }
    json["libraries"].push_back(
        {{"file", library.file.string()},
         {"build", library.build},
         {"plugins", std::move(plugins)},
         {"refused", library.refused.empty() ? Json() : Json(library.refused)}});
  }
  for (const LibraryCopy& copy : registry.copies()) {
    json["copies"].push_back({{"file", copy.file.string()}, {"used", copy.used.string()}});
  }
  return json;
}
}  // namespace altiplan::host
