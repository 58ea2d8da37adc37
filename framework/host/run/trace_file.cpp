// SPDX-License-Identifier: Apache-2.0
#include "host/run/trace_file.hpp"

#include <charconv>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/json.hpp"

namespace altiplan::host {
namespace {

void append(std::string& line, double number) {
  if (!std::isfinite(number)) {
    line += "null";
    return;
  }
  char buffer[32];
  line.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
}

const char* kind_name(TraceEvent::Kind kind) {
  switch (kind) {
    case TraceEvent::Kind::expanded:
      return "expanded";
    case TraceEvent::Kind::added:
      return "added";
    case TraceEvent::Kind::removed:
      return "removed";
    case TraceEvent::Kind::rewired:
      return "rewired";
    case TraceEvent::Kind::iteration:
      break;
  }
  return "iteration";
}
}  // namespace

TraceFile::TraceFile(std::filesystem::path file, std::uintmax_t max_bytes)
    : file_(std::move(file)), lines_("{\"altiplan_trace\": 1}\n"), max_bytes_(max_bytes) {}

void TraceFile::flush() {
  try {
    if (error_.empty()) {
      file_.write(lines_);
    }
  } catch (const Error& error) {  // a missing trace does not end the search
    error_ = error.what();
  }
  lines_.clear();
}

void TraceFile::begin_search(const SearchProgress& progress) {
  began_ = Budget::Clock::now();
  progress_ = &progress;
  first_route_s_.reset();
}

void TraceFile::add(const TraceEvent& event) {
  if (bytes_ >= max_bytes_ && event.kind != TraceEvent::Kind::iteration) {
    ++left_out_;
    return;
  }
  std::string line = "{\"step\": " + exact_json_text(step_) + ", \"kind\": \"" +
                     kind_name(event.kind) + "\", \"node\": " + std::to_string(event.node) +
                     ", \"parent\": " + std::to_string(event.parent) + ", \"at\": [";
  for (int axis = 0; axis < 3; ++axis) {
    line += axis == 0 ? "" : ", ";
    append(line, event.position[axis]);
  }
  line += "], \"value\": ";
  append(line, event.value);
  if (event.kind == TraceEvent::Kind::iteration && progress_ != nullptr) {
    const double time = std::chrono::duration<double>(Budget::Clock::now() - began_).count();
    if (!first_route_s_ && std::isfinite(event.value)) {
      first_route_s_ = time;
    }
    line += ", \"time_s\": ";
    append(line, time);
    line += ", \"expanded\": " + std::to_string(progress_->expanded.load());
  }
  if (event.alive >= 0) {
    line += ", \"mean\": ";
    append(line, event.mean);
    line += ", \"alive\": " + std::to_string(event.alive);
  }
  line += "}\n";
  lines_ += line;
  bytes_ += line.size();
  constexpr std::size_t kBlock = 4096;
  if (lines_.size() >= kBlock) {
    flush();
  }
}

void TraceFile::close() {
  flush();
  if (!error_.empty()) {
    throw Error("the trace: " + error_);
  }
  file_.put_in_place();
}
}  // namespace altiplan::host
