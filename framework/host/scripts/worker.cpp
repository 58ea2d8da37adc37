// SPDX-License-Identifier: Apache-2.0
#include "host/scripts/worker.hpp"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <unistd.h>

#include "altiplan/error.hpp"
#include "host/base/install_root.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

constexpr int kDescriptor = 3;  ///< at which _worker.py talks
constexpr auto kMessageTimeout = std::chrono::seconds(20);
constexpr std::size_t kMaxHead = 1 << 28;
constexpr std::size_t kMaxNumbers = 1 << 27;  ///< both as _worker.py has them

fs::path interpreter() {
  if (const char* named = std::getenv("ALTIPLAN_PYTHON"); named != nullptr && *named != '\0') {
    const fs::path file(named);
    const auto found = file.has_parent_path() ? std::optional(file) : find_on_path({named});
    if (!found || !is_program(*found)) {
      throw PluginError("ALTIPLAN_PYTHON is '" + file.string() + "', which is no program");
    }
    return *found;
  }
  const auto found = find_on_path({"python3"});
  if (!found) {
    throw PluginError("no python3 is on the PATH, which runs plugins written in Python");
  }
  return *found;
}

std::vector<std::string> command_of(const fs::path& file) {
  const fs::path worker = install_root() / "lib/python3/dist-packages/altiplan/_worker.py";
  if (!is_there(worker)) {
    throw PluginError("plugins written in Python need the package altiplan: " + worker.string() +
                      " is missing");
  }
  // -B: no files are written beside the planner's.
  return {interpreter().string(), "-B", worker.string(), fs::absolute(file).string()};
}

/// How the process ended, as a negative signal or an exit code.
std::string ending(int how) {
  if (how < 0) {
    const char* name = ::sigabbrev_np(-how);
    return "crashed (SIG" + std::string(name != nullptr ? name : std::to_string(-how)) + ")";
  }
  return "ended its process with exit code " + std::to_string(how);
}

[[noreturn]] void fail_as_told(const Json& head) {
  const std::string how = head.value("how", "");
  const std::string place = head.value("place", "");
  std::string text = (how == "exit" ? "" : "threw: ") + head.value("failed", "");
  text += place.empty() ? "" : " (" + place + ")";
  throw PluginError(text, how == "exit"     ? Reason::process_ended
                          : how == "memory" ? Reason::out_of_memory
                                            : Reason::threw);
}
}  // namespace

ScriptWorker::ScriptWorker(const fs::path& file)
    : file_(file), program_(command_of(file), {{kDescriptor}, ""}) {
  const Clock::time_point until = Clock::now() + kMessageTimeout;
  const std::optional<ScriptMessage> hello = receive(until);
  if (!hello || !hello->head.contains("process")) {
    throw PluginError("its process says nothing: is " + interpreter().string() + " Python 3.9?");
  }
  process_ = hello->head.at("process").get<int>();
  plugins_ = answer_to({{"load", true}}).head.at("plugins");
}

ScriptWorker::~ScriptWorker() {
  // The end of the connection ends the process in order; the group is killed in any case.
  program_.finish_sending();
  const Clock::time_point until = Clock::now() + std::chrono::seconds(1);
  for (std::string rest; program_.receive(rest, until);) {
    rest.clear();
  }
  program_.ended(until);
}

void ScriptWorker::send(const Json& head, std::span<const double> numbers) {
  const std::string text = exact_json_text(head);
  const std::array<std::uint32_t, 2> lengths = {std::uint32_t(text.size()),
                                                std::uint32_t(numbers.size())};
  std::string bytes(sizeof lengths + text.size() + numbers.size_bytes(), '\0');
  std::memcpy(bytes.data(), lengths.data(), sizeof lengths);
  text.copy(bytes.data() + sizeof lengths, text.size());
  if (!numbers.empty()) {
    std::memcpy(bytes.data() + sizeof lengths + text.size(), numbers.data(), numbers.size_bytes());
  }
  if (!program_.send(bytes, Clock::now() + kMessageTimeout)) {
    (void)receive(Clock::now());  // may tell why
    fail_as_ended();
  }
}

std::optional<ScriptMessage> ScriptWorker::taken() {
  std::array<std::uint32_t, 2> lengths{};
  if (received_.size() < sizeof lengths) {
    return std::nullopt;
  }
  std::memcpy(lengths.data(), received_.data(), sizeof lengths);
  const auto no_message = [] {
    return PluginError("writes to the descriptor at which this program talks to it",
                       Reason::process_changed);
  };
  if (lengths[0] > kMaxHead || lengths[1] > kMaxNumbers) {
    throw no_message();
  }
  const std::size_t numbers = std::size_t(lengths[1]) * sizeof(double);
  const std::size_t end = sizeof lengths + lengths[0] + numbers;
  if (received_.size() < end) {
    return std::nullopt;
  }
  ScriptMessage message;
  message.head = json_or_discarded({received_.data() + sizeof lengths, lengths[0]});
  if (!message.head.is_object()) {
    throw no_message();
  }
  message.numbers.resize(lengths[1]);
  if (numbers > 0) {
    std::memcpy(message.numbers.data(), received_.data() + end - numbers, numbers);
  }
  received_.erase(0, end);
  return message;
}

std::optional<ScriptMessage> ScriptWorker::receive(Clock::time_point until) {
  while (true) {
    if (std::optional<ScriptMessage> message = taken()) {
      if (message->head.contains("failed")) {
        fail_as_told(message->head);
      }
      if (message->head.contains("ended")) {
        throw PluginError(ending(message->head.at("ended").get<int>()), Reason::process_ended);
      }
      return message;
    }
    if (!program_.receive(received_, until)) {
      if (program_.ended(Clock::now()) || Clock::now() < until) {
        fail_as_ended();
      }
      return std::nullopt;
    }
  }
}

void ScriptWorker::fail_as_ended() const {
  throw PluginError("closed the connection to this program, or was killed", Reason::process_ended);
}

ScriptMessage ScriptWorker::answer_to(const Json& head) {
  send(head);
  std::optional<ScriptMessage> answer = receive(Clock::now() + kMessageTimeout);
  if (!answer) {
    throw PluginError("did not answer within " + std::to_string(kMessageTimeout.count()) + " s",
                      Reason::never_stopped);
  }
  return *std::move(answer);
}

double ScriptWorker::memory_mb() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  long all = 0;
  long resident = 0;
  file >> all >> resident;
  return double(resident) * double(::sysconf(_SC_PAGESIZE)) / double(1 << 20);
}
}  // namespace altiplan::host
