// SPDX-License-Identifier: Apache-2.0
// What the source tree promises: who may include whom, what a plugin's folder holds, what a plugin
// library exports.
#include <gtest/gtest.h>
#include "support/folders.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace structure_test {
namespace fs = std::filesystem;

const fs::path kSource = altiplan::folders::source();

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Files below a folder of the source tree with one of the endings, sorted.
std::vector<fs::path> files(const std::string& folder, const std::vector<std::string>& endings) {
  std::vector<fs::path> found;
  if (!fs::exists(kSource / folder)) {
    return found;
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() &&
        std::any_of(endings.begin(), endings.end(),
                    [&](const std::string& ending) { return ends_with(name, ending); })) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> sources(const std::string& folder) { return files(folder, {".cpp", ".hpp"}); }

bool is_test(const fs::path& file) { return ends_with(file.stem().string(), "_test"); }

std::vector<std::string> includes(const fs::path& file) {
  static const std::regex kInclude(R"re(^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"])re");
  std::vector<std::string> found;
  std::istringstream text(text_of(file));
  for (std::string line; std::getline(text, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) {
      found.push_back(match[1]);
    }
  }
  return found;
}

/// Each include of the files that matches, as "file includes header".
std::vector<std::string> forbidden(const std::vector<fs::path>& from, const std::regex& headers) {
  std::vector<std::string> found;
  for (const fs::path& file : from) {
    for (const std::string& header : includes(file)) {
      if (std::regex_search(header, headers)) {
        found.push_back(fs::relative(file, kSource).string() + " includes " + header);
      }
    }
  }
  return found;
}

std::string list(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

struct PluginFolder {
  fs::path path;
  std::string kind;
  std::string name;
};

std::vector<PluginFolder> plugin_folders() {
  std::vector<PluginFolder> found;
  for (const fs::path& file : files("plugins", {"CMakeLists.txt"})) {
    const fs::path folder = file.parent_path();
    if (folder.parent_path().parent_path() == kSource / "plugins") {
      found.push_back({folder, folder.parent_path().filename(), folder.filename()});
    }
  }
  return found;
}

TEST(Structure, TheApiHasNoTypeOfALibraryButEigen) {
  const std::regex kOthers(
      "^(yaml-cpp|boost|fcl|gdal|ogr|cpl_|nlohmann|CLI|host|link|study|tune|py)");
  EXPECT_GT(sources("framework/include").size(), 20u);
  EXPECT_EQ(list(forbidden(sources("framework/include"), kOthers)), "");
}

TEST(Structure, TheSdkKnowsNeitherTheKitNorTheFormats) {
  std::vector<fs::path> sdk = sources("framework/src");
  const std::vector<fs::path> headers = sources("framework/include");
  sdk.insert(sdk.end(), headers.begin(), headers.end());
  std::erase_if(sdk, [](const fs::path& file) {
    const std::string name = fs::relative(file, kSource).string();
    return name.find("/kit/") != std::string::npos || name.find("/formats/") != std::string::npos;
  });
  EXPECT_GT(sdk.size(), 50u);
  EXPECT_EQ(list(forbidden(sdk, std::regex("(^|/)(kit|formats)/"))), "");
}

TEST(Structure, NeitherTheKitNorTheFormatsKnowTheOther) {
  for (const auto& [part, other] : {std::pair{"kit", "formats"}, std::pair{"formats", "kit"}}) {
    std::vector<fs::path> code = sources("framework/src/" + std::string(part));
    const std::vector<fs::path> headers =
        sources("framework/include/altiplan/" + std::string(part));
    code.insert(code.end(), headers.begin(), headers.end());
    EXPECT_GT(code.size(), 20u);
    EXPECT_EQ(list(forbidden(code, std::regex("(^|/)" + std::string(other) + "/"))), "");
  }
}

TEST(Structure, TheCoreDoesNotKnowTheHost) {
  const std::regex kHost("(^|/)(host|link|study|tune)/|^(yaml-cpp|boost|gdal|CLI)");
  std::vector<fs::path> code = sources("framework/src");
  EXPECT_GT(code.size(), 100u);
  EXPECT_EQ(list(forbidden(code, kHost)), "");
  std::erase_if(code, [](const fs::path& file) {
    return fs::relative(file, kSource).string().starts_with("framework/src/formats/");
  });
  EXPECT_EQ(list(forbidden(code, std::regex("^(nlohmann|pugixml|rapidjson)"))), "");
}

struct Room {
  std::string name;
  std::set<std::string> included;  ///< other rooms
};

/// The lines of rooms.txt, "host/judge: host/base", from which the build links the rooms.
std::vector<Room> rooms() {
  std::vector<Room> all;
  std::istringstream text(text_of(kSource / "framework/rooms.txt"));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line.substr(line.find(':') + 1));
    all.push_back(
        {line.substr(0, line.find(':')), {std::istream_iterator<std::string>(words), {}}});
  }
  return all;
}

TEST(Structure, ARoomIncludesTheRoomsThatItsLineNames) {
  const std::regex kInside(R"(^(host|link|study|tune|python|src|\.\.)/)");
  for (const Room& room : rooms()) {
    std::set<std::string> included;
    for (const fs::path& file : sources("framework/" + room.name)) {
      for (const std::string& header : includes(file)) {
        const std::string other = fs::path(header).parent_path();
        if (std::regex_search(header, kInside) && other != room.name) {
          included.insert(other);
        }
      }
    }
    EXPECT_EQ(list({included.begin(), included.end()}),
              list({room.included.begin(), room.included.end()}))
        << room.name;
  }
}

TEST(Structure, ARoomStandsBelowThoseThatIncludeIt) {
  std::set<std::string> below;
  for (const Room& room : rooms()) {
    for (const std::string& other : room.included) {
      EXPECT_TRUE(below.contains(other)) << room.name << " names " << other;
    }
    below.insert(room.name);
  }
}

TEST(Structure, EveryFolderIsARoomThatTheReadmeShows) {
  std::set<std::string> folders;
  for (const char* part : {"framework/host", "framework/link", "framework/study", "framework/tune",
                           "framework/python"}) {
    for (const fs::path& file : sources(part)) {
      folders.insert(fs::relative(file.parent_path(), kSource / "framework").string());
    }
  }
  std::vector<std::string> all;
  for (const Room& room : rooms()) {
    all.push_back(room.name);
  }
  const std::regex kRow("^\\| `((host|link|study|tune|python)[a-z_/]*)` \\|");
  std::vector<std::string> shown;
  std::istringstream page(text_of(kSource / "framework/README.md"));
  for (std::string line; std::getline(page, line);) {
    if (std::smatch row; std::regex_search(line, row, kRow)) {
      shown.push_back(row[1]);
    }
  }
  EXPECT_EQ(list(shown), list(all));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(list({folders.begin(), folders.end()}), list(all));
}

/// An include of a file that lies in another folder.
struct Arrow {
  std::string from;
  std::string to;
  std::string text;
};

std::vector<Arrow> arrows(const std::vector<fs::path>& code) {
  std::vector<Arrow> found;
  for (const fs::path& file : code) {
    for (const std::string& header : includes(file)) {
      auto there =
          std::find(code.begin(), code.end(), (file.parent_path() / header).lexically_normal());
      if (there == code.end()) {
        there = std::find_if(code.begin(), code.end(), [&](const fs::path& other) {
          return ends_with(other.native(), header) && ends_with(other.native(), "/" + header);
        });
      }
      if (there != code.end() && there->parent_path() != file.parent_path()) {
        found.push_back({file.parent_path(), there->parent_path(),
                         fs::relative(file, kSource).string() + " includes " + header});
      }
    }
  }
  return found;
}

using Below = std::map<std::string, std::set<std::string>>;

/// What the folder includes, and what that includes.
void add_all_below(const std::string& folder, const Below& below, std::set<std::string>& all) {
  const auto found = below.find(folder);
  if (found != below.end()) {
    for (const std::string& lower : found->second) {
      if (all.insert(lower).second) {
        add_all_below(lower, below, all);
      }
    }
  }
}

TEST(Structure, FoldersDoNotIncludeEachOtherInACircle) {
  std::vector<fs::path> code = sources("framework");
  const std::vector<fs::path> of_tools = sources("tools");
  code.insert(code.end(), of_tools.begin(), of_tools.end());
  const std::vector<Arrow> all = arrows(code);
  EXPECT_GT(all.size(), 500u);
  Below below;
  for (const Arrow& arrow : all) {
    below[arrow.from].insert(arrow.to);
  }
  std::vector<std::string> found;
  for (const Arrow& arrow : all) {
    std::set<std::string> reached;
    add_all_below(arrow.to, below, reached);
    if (reached.count(arrow.from)) {
      found.push_back(arrow.text);
    }
  }
  EXPECT_EQ(list(found), "");
}

TEST(Structure, AFilesNamespaceIsThatOfItsFolder) {
  const std::map<fs::path, std::string> namespaces{
      {"framework/include", "altiplan"},
      {"framework/include/altiplan/kit", "altiplan::kit"},
      {"framework/include/altiplan/formats", "altiplan::formats"},
      {"framework/src", "altiplan"},
      {"framework/src/kit", "altiplan::kit"},
      {"framework/src/formats", "altiplan::formats"},
      {"framework/host", "altiplan::host"},
      {"framework/link", "altiplan::link"},
      {"framework/study", "altiplan::study"},
      {"framework/tune", "altiplan::tune"},
      {"framework/python", "altiplan::python"},
      {"framework/conformance", "altiplan::conformance"},
      {"tools/altiplan", "altiplan::cli"},
      {"tools/serve", "altiplan::serve"},
      {"tools/bench", "altiplan::bench"}};
  const std::regex kOpened(R"(^namespace (altiplan[a-z_:]*) \{)");
  std::vector<std::string> found;
  for (const char* part : {"framework", "tools"}) {
    for (const fs::path& file : sources(part)) {
      fs::path folder = fs::relative(file, kSource).parent_path();
      while (!folder.empty() && !namespaces.count(folder)) {
        folder = folder.parent_path();
      }
      std::istringstream text(text_of(file));
      for (std::string line; std::getline(text, line);) {
        std::smatch opened;
        if (std::regex_search(line, opened, kOpened) &&
            (folder.empty() ||
             (opened[1].str() + "::").rfind(namespaces.at(folder) + "::", 0) != 0)) {
          found.push_back(fs::relative(file, kSource).string() + " opens " + opened[1].str());
        }
      }
    }
  }
  EXPECT_EQ(list(found), "");
}

TEST(Structure, PluginsKnowOnlyTheApiAndTheKit) {
  const std::regex kHost("(^|/)(host|link|study|tune)/|^(yaml-cpp|boost/dll|fcl|CLI)");
  std::vector<fs::path> code = sources("plugins");
  EXPECT_GT(code.size(), 16u);
  EXPECT_EQ(list(forbidden(code, kHost)), "");
  code.erase(std::remove_if(code.begin(), code.end(), is_test), code.end());
  EXPECT_EQ(list(forbidden(code, std::regex("^(support|gtest)/"))), "");
}

TEST(Structure, PluginsDoNotKnowEachOther) {
  std::vector<std::string> found;
  for (const fs::path& file : sources("plugins")) {
    for (const std::string& header : includes(file)) {
      // A file beside this one, a header of the API, or one of a library.
      const bool climbs = header.find("..") != std::string::npos;
      if (climbs || header.rfind("plugins/", 0) == 0 || fs::exists(kSource / "plugins" / header)) {
        found.push_back(fs::relative(file, kSource).string() + " includes " + header);
      }
    }
  }
  EXPECT_EQ(list(found), "");
}

TEST(Structure, OnlyPluginsThatReadGeodataUseGdal) {
  std::set<std::string> folders;
  for (const char* folder : {"framework", "plugins", "tools"}) {
    for (const fs::path& file : sources(folder)) {
      if (!forbidden({file}, std::regex("^(gdal|ogr_|cpl_)")).empty()) {
        folders.insert(fs::relative(file.parent_path(), kSource).string());
      }
    }
  }
  for (const std::string& folder : folders) {
    EXPECT_EQ(folder.rfind("plugins/environment/", 0), 0u) << folder << " includes GDAL";
  }
}

// Its headers take seconds to build, in each file.
TEST(Structure, OneFileOfTheProgramIncludesCli11) {
  for (const fs::path& file : sources("tools/altiplan")) {
    EXPECT_TRUE(file.filename() == "command_line.cpp" ||
                forbidden({file}, std::regex("^CLI/")).empty())
        << file;
  }
}

TEST(Structure, EveryPluginFolderIsWhole) {
  const std::vector<PluginFolder> folders = plugin_folders();
  EXPECT_GE(folders.size(), 8u);
  std::set<std::string> kinds{"environment", "constraint", "planner",   "local_planner",
                              "smoother",    "tuner",      "objective", "task"};
  for (const PluginFolder& folder : folders) {
    SCOPED_TRACE(folder.kind + "/" + folder.name);
    EXPECT_TRUE(kinds.count(folder.kind)) << "not a kind of plugin";
    EXPECT_TRUE(fs::exists(folder.path / (folder.name + ".cpp")));
    EXPECT_TRUE(fs::exists(folder.path / (folder.name + "_test.cpp")));

    const std::string build = text_of(folder.path / "CMakeLists.txt");
    EXPECT_LE(std::count(build.begin(), build.end(), '\n'), 5) << "CMakeLists.txt: at most 5 lines";
    EXPECT_NE(build.find("plugin(" + folder.kind + " " + folder.name + ")"), std::string::npos)
        << build;
    EXPECT_NE(text_of(folder.path / (folder.name + ".cpp")).find("\"" + folder.name + "\""),
              std::string::npos)
        << "the plugin is registered under the folder's name";
  }
}

TEST(Structure, EveryPluginReadmeHasTheSameHeadings) {
  for (const PluginFolder& folder : plugin_folders()) {
    SCOPED_TRACE(folder.kind + "/" + folder.name);
    std::string headings;
    std::istringstream readme(text_of(folder.path / "README.md"));
    bool code = false;
    for (std::string line; std::getline(readme, line);) {
      code ^= line.rfind("```", 0) == 0;
      // The table of pseudo-code and functions is left out where there is nothing to map.
      const bool heading = line.rfind("# ", 0) == 0 || line.rfind("## ", 0) == 0;
      if (!code && heading && line.rfind("## Pseudo-code", 0) != 0) {
        headings += line + "\n";
      }
    }
    EXPECT_EQ(headings,
              "# " + folder.name +
                  "\n## What\n## Guarantees\n## Parameters\n## Example YAML\n## Limits\n");
    EXPECT_NE(text_of(folder.path / "README.md").find("<!-- parameters -->"), std::string::npos);
    EXPECT_NE(text_of(folder.path / "README.md").find("<!-- /parameters -->"), std::string::npos);
  }
}

TEST(Structure, EverySourceFileNamesItsLicence) {
  std::vector<fs::path> all;
  for (const char* folder : {"framework", "plugins", "tests", "tools", "cmake", "docs"}) {
    const std::vector<fs::path> some =
        files(folder, {".cpp", ".hpp", ".cmake", "CMakeLists.txt", ".py", ".sh", ".bash"});
    all.insert(all.end(), some.begin(), some.end());
  }
  for (const char* script : {"tools/docs", "tools/setup", "tools/run", "tools/test", ".ci/run"}) {
    all.push_back(kSource / script);
  }
  for (const fs::path& file : all) {
    const std::string head = text_of(file).substr(0, 200);
    EXPECT_NE(head.find("SPDX-License-Identifier: Apache-2.0"), std::string::npos) << file;
  }
}

/// What a library exports: the names of its defined dynamic symbols.
std::vector<std::string> exports(const fs::path& library) {
  const std::string command = "nm --dynamic --defined-only '" + library.string() + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::vector<std::string> names;
  std::array<char, 4096> line{};
  while (pipe && std::fgets(line.data(), int(line.size()), pipe.get()) != nullptr) {
    std::string text = line.data();
    text.erase(text.find_last_not_of("\n") + 1);
    names.push_back(text.substr(text.rfind(' ') + 1));
  }
  return names;
}

TEST(Structure, APluginLibraryExportsOneSymbol) {
  const fs::path folder = altiplan::folders::build() / "lib/altiplan/plugins";
  std::size_t looked_at = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".so") {
      EXPECT_EQ(exports(entry.path()), std::vector<std::string>{"altiplan_plugins"})
          << entry.path();
      ++looked_at;
    }
  }
  EXPECT_GE(looked_at, 8u);
}
}  // namespace structure_test
