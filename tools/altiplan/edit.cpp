// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "commands.hpp"
#include "edit_mission.hpp"
#include "host/base/output_file.hpp"
#include "host/base/program.hpp"
#include "host/config/yaml.hpp"
#include "host/edit/session.hpp"
#include "host/mission/mission.hpp"
#include "host/view/scene_parts.hpp"
#include "mission_options.hpp"
#include "serve/serve.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct EditArguments {
  std::vector<std::string> files;
  bool has_browser = true;
  std::optional<std::string> basemap;
  MissionOptions mission;
  host::Overrides overrides;
};

/// A pipeline for a scenario that comes alone, written beside it unless it is there.
fs::path pipeline_for(const fs::path& scenario, const host::Overrides& overrides) {
  const fs::path file = scenario.parent_path() / (scenario.stem().string() + "_pipeline.yaml");
  if (fs::exists(file)) {
    return file;
  }
  const bool is_wing = host::load_scenario(scenario, overrides).scenario.vehicle.wing.has_value();
  const std::string steps =
      is_wing ? "  - plan: hybrid_astar\n" : "  - plan: astar\n  - smooth: prune\n";
  host::write_file(file,
                   "altiplan: 1\nscenario: " + scenario.filename().string() + "\nsteps:\n" + steps);
  std::printf("%s: written, since a scenario alone has no steps\n", file.c_str());
  return file;
}

/// What one file opens.
host::Config opened(const std::string& file, const host::Overrides& overrides,
                    const std::shared_ptr<host::Registry>& registry) {
  if (fs::path(file).extension() == ".json") {
    const host::StoredResult stored = host::read_result(file, overrides);
    return host::load_config(stored.pipeline, stored.overrides, registry);
  }
  const host::FileKind kind = host::kind_of(host::load_yaml(file));
  if (kind != host::FileKind::pipeline && kind != host::FileKind::scenario) {
    throw ConfigError({file, 0, 0, ""}, "", "expected a pipeline, a scenario or a result");
  }
  return host::load_config(
      kind == host::FileKind::pipeline ? fs::path(file) : pipeline_for(file, overrides), overrides,
      registry);
}

/// The pipelines, all of one scenario, and the assignments that they were opened with.
struct Opened {
  std::vector<host::EditedPipeline> pipelines;
  std::vector<host::Assignment> given;
};

Opened open_all(const EditArguments& arguments) {
  Opened all;
  std::shared_ptr<host::Registry> registry;
  for (const std::string& file : arguments.files) {
    host::Config config = opened(file, arguments.overrides, registry);
    registry = config.registry;
    if (!all.pipelines.empty()) {
      const host::Config& first = all.pipelines.front().config;
      if (first.scenario_path != config.scenario_path) {
        throw Error("'" + arguments.files.front() + "' and '" + file +
                    "' are of different scenarios: '" + first.scenario_path.string() + "' and '" +
                    config.scenario_path.string() + "'");
      }
    }
    std::string name = config.pipeline_path.stem();
    for (const host::EditedPipeline& other : all.pipelines) {
      if (other.name == name) {
        name += "_" + std::to_string(all.pipelines.size() + 1);
      }
    }
    for (const std::string& text : config.overrides.set) {
      const host::Assignment one{text, all.pipelines.size()};
      // Those of the scenario are every pipeline's, and the same for all.
      if (one.parts().file == host::FileOfKey::pipeline || all.pipelines.empty()) {
        all.given.push_back(one);
      }
    }
    all.pipelines.push_back({name, std::move(config), all.pipelines.size()});
  }
  return all;
}

serve::ServeFunction* serve_function() {
  void* library = ::dlopen(serve::kServeLibrary, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library != nullptr ? ::dlsym(library, serve::kServeSymbol) : nullptr;
  if (symbol == nullptr) {
    throw Error(std::string("the page's server cannot be loaded: ") + ::dlerror());
  }
  return reinterpret_cast<serve::ServeFunction*>(symbol);
}

/// Shows the address in the user's browser, if there is one.
void open_browser(const std::string& address) {
  const bool has_screen =
      std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  const auto opener = host::find_on_path({"xdg-open"});
  if (!has_screen || !opener || ::fork() != 0) {
    return;
  }
  ::setsid();
  std::array<const char*, 3> command{opener->c_str(), address.c_str(), nullptr};
  ::execv(command[0], const_cast<char* const*>(command.data()));
  ::_exit(1);
}

/// Serves the session's page until it is closed.
template <class Session>
void serve_until_closed(Session& session, bool has_browser) {
  serve::Server server;
  server.answer = [&](const host::PageRequest& request) { return session.answer(request); };
  server.begun = [&](const std::string& address) {
    std::printf("%s\n", address.c_str());
    std::fflush(stdout);
    if (has_browser) {
      open_browser(address);
    }
  };
  (*serve_function())(server);
}

/// The process that serves the page of pipelines.
[[noreturn]] void serve_page(const Opened& opened, const Frame& frame, const fs::path& folder,
                             int socket, bool has_browser, host::Basemap* basemap) {
  // It must not outlive the one that plans.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  int code = kDone;
  try {
    host::PlanLine line(socket);
    host::EditSession session(opened.pipelines, opened.given, frame, folder, line, basemap);
    serve_until_closed(session, has_browser);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "altiplan: %s\n", error.what());
    code = kInternal;
  }
  ::_exit(code);
}

int edit(const EditArguments& arguments) {
  const auto basemap =
      arguments.basemap ? std::make_unique<host::Basemap>(*arguments.basemap) : nullptr;
  if (!arguments.mission.plan.plan.empty()) {
    MissionEditor editor(arguments.mission.plan, arguments.overrides, basemap.get());
    serve_until_closed(editor, arguments.has_browser);
    return kDone;
  }
  const Opened opened = open_all(arguments);
  // Plugins are loaded and their files read once, for all that is forked from here.
  const host::Mission mission = host::build_mission(opened.pipelines.front().config, 1);
  if (basemap) {
    // Refuses images of elsewhere.
    const Box box = host::scene_box(mission, {});
    host::Json seen{{"box", {host::rounded(box.min), host::rounded(box.max)}}};
    basemap->add_to(seen, mission.truth.frame());
  }
  const host::TemporaryFolder folder;
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) {
    throw Error(std::string("no socket: ") + std::strerror(errno));
  }
  const pid_t server = ::fork();
  if (server < 0) {
    throw Error(std::string("no process: ") + std::strerror(errno));
  }
  if (server == 0) {
    ::close(sockets[0]);
    serve_page(opened, mission.truth.frame(), folder.path(), sockets[1], arguments.has_browser,
               basemap.get());
  }
  ::close(sockets[1]);
  const host::Unfinished ended([server] { ::kill(server, SIGKILL); });
  host::plan_at(sockets[0], opened.pipelines);
  ::close(sockets[0]);
  int status = 0;
  ::waitpid(server, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : kInternal;
}
}  // namespace

void add_edit(App& app, Action& action) {
  const auto prepare = [](EditArguments& arguments) {
    for (const std::string& file : arguments.files) {
      if (!is_mission(arguments.mission, file)) {
        continue;
      }
      if (arguments.files.size() > 1) {
        throw UsageError{"a mission is edited alone"};
      }
      arguments.mission.plan = checked_plan(arguments.mission, file);
    }
  };
  auto [command, arguments] = add_command<EditArguments>(
      app, action, "edit",
      "edit a scenario in the browser, planned again while you drag, or a mission's items, judged "
      "again",
      edit, prepare);
  command
      .add_option("files", arguments.files,
                  "pipelines of one scenario, a scenario (YAML) or a result (JSON); or a mission "
                  "(.plan, .waypoints)")
      ->required();
  command.add_flag("!--no-browser", arguments.has_browser,
                   "print the page's address only, open no browser");
  add_basemap(command, arguments.basemap);
  add_overrides(command, arguments.overrides);
  add_mission_options(command, arguments.mission);
  set_example(command, "altiplan edit configs/pipelines/ridge_crossing.yaml");
}
}  // namespace altiplan::cli
