// SPDX-License-Identifier: Apache-2.0
#include "host/view/chromium.hpp"

#include <unistd.h>

#include <cstdlib>
#include <thread>
#include <vector>

#include "altiplan/error.hpp"
#include "host/base/base64.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;
using Clock = Program::Clock;

/// The descriptors at which Chromium reads commands and writes answers.
constexpr int kCommands = 3;
constexpr int kAnswers = 4;

std::vector<std::string> arguments_of(const fs::path& chromium, const fs::path& folder) {
  std::vector<std::string> arguments{
      chromium.string(),
      "--headless",
      "--remote-debugging-pipe",
      // Software rendering: available, and identical, on every machine.
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      // A single process avoids passing frames between processes.
      "--in-process-gpu",
      "--disable-gpu-compositing",
      "--hide-scrollbars",
      "--force-device-scale-factor=1",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-extensions",
      "--disable-quic",
      "--disable-sync",
      "--user-data-dir=" + (folder / "profile").string(),
  };
  if (::geteuid() == 0) {
    arguments.insert(arguments.begin() + 1, "--no-sandbox");  // its sandbox refuses root
  }
  return arguments;
}
}  // namespace

std::optional<fs::path> find_chromium() {
  if (const char* named = std::getenv("ALTIPLAN_CHROMIUM")) {
    return is_program(named) ? std::optional<fs::path>(named) : std::nullopt;
  }
  return find_on_path({"chromium", "chromium-browser", "google-chrome"});
}

ShownPage::ShownPage(const fs::path& chromium, const std::string& page, const std::string& query,
                     int width, int height, std::chrono::milliseconds timeout)
    : name_(chromium.string()),
      program_(arguments_of(chromium, folder_.path()),
               {.wired = {kCommands, kAnswers}, .temporary = folder_.path()}),
      timeout_(timeout) {
  const auto end = Clock::now() + timeout;
  const fs::path file = folder_.path() / "page.html";
  write_file(file, page);
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}})
                 .at("sessionId")
                 .get<std::string>();
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  call("Page.navigate", {{"url", "file://" + file.string() + query}});
  // An error stands on the page: it is drawn as well.
  while (run("Boolean(window.altiplan?.ready || window.altiplan?.errors.length)") != Json(true)) {
    if (Clock::now() >= end) {
      give_up();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void ShownPage::give_up() {
  const bool runs = !program_.ended(Clock::now() + std::chrono::milliseconds(100));
  throw Error("'" + name_ + "' did not render the page" +
              (runs ? " within " + std::to_string(timeout_.count() / 1000) + " s" : ""));
}

Json ShownPage::call(const char* method, Json parameters) {
  Json command{{"id", ++calls_}, {"method", method}, {"params", std::move(parameters)}};
  if (!session_.empty()) {
    command["sessionId"] = session_;
  }
  std::string text = exact_json_text(command);
  text += '\0';
  if (!program_.send(text, Clock::now() + timeout_)) {
    give_up();
  }
  return answer_to(calls_, method);
}

Json ShownPage::answer_to(int id, const char* method) {
  const auto end = Clock::now() + timeout_;
  std::size_t searched = 0;
  while (true) {
    const std::size_t length = unread_.find('\0', searched);
    if (length == std::string::npos) {
      searched = unread_.size();
      if (!program_.receive(unread_, end)) {
        give_up();
      }
      continue;
    }
    const Json message = json_or_discarded(unread_.substr(0, length));
    unread_.erase(0, length + 1);
    searched = 0;
    if (!message.is_object() || message.value("id", 0) != id) {
      continue;  // an event
    }
    if (!message.contains("result")) {
      throw Error("'" + name_ + "' refused " + method);
    }
    return message.at("result");
  }
}

Json ShownPage::run(const std::string& script) {
  const Json answer =
      call("Runtime.evaluate",
           {{"expression", script}, {"awaitPromise", true}, {"returnByValue", true}});
  if (const auto failed = answer.find("exceptionDetails"); failed != answer.end()) {
    const Json thrown = failed->value("exception", Json::object());
    const std::string why = thrown.value("description", failed->value("text", std::string()));
    throw Error("the page failed: " + why.substr(0, why.find('\n')));
  }
  return answer.at("result").value("value", Json());
}

std::string ShownPage::picture(const char* format) {
  constexpr int kQuality = 95;  // of a jpeg
  Json parameters{{"format", format}};
  if (format == std::string_view("jpeg")) {
    parameters["quality"] = kQuality;
  }
  const Json answer = call("Page.captureScreenshot", std::move(parameters));
  const std::vector<std::byte> bytes = from_base64(answer.at("data").get_ref<const std::string&>());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string screenshot(const fs::path& chromium, const std::string& page, const std::string& query,
                       std::chrono::milliseconds timeout) {
  return ShownPage(chromium, page, query, 1600, 1000, timeout).picture("png");
}
}  // namespace altiplan::host
