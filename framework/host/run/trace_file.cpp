// SPDX-License-Identifier: Apache-2.0
#include "host/run/trace_file.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "altiplan/error.hpp"

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

TraceFile::TraceFile(std::filesystem::path file)
    : path_(std::move(file)), file_(std::fopen(path_.c_str(), "w")) {
  if (file_ == nullptr) {
    throw Error("cannot write the trace '" + path_.string() + "': " + std::strerror(errno));
  }
  std::fputs("{\"altiplan_trace\": 1}\n", file_);
}

TraceFile::~TraceFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
  }
}

void TraceFile::add(const TraceEvent& event) {
  std::string line = "{\"step\": " + nlohmann::json(step_).dump() + ", \"kind\": \"" +
                     kind_name(event.kind) + "\", \"node\": " + std::to_string(event.node) +
                     ", \"parent\": " + std::to_string(event.parent) + ", \"at\": [";
  for (int axis = 0; axis < 3; ++axis) {
    line += axis == 0 ? "" : ", ";
    append(line, event.position[axis]);
  }
  line += "], \"value\": ";
  append(line, event.value);
  if (event.alive >= 0) {
    line += ", \"mean\": ";
    append(line, event.mean);
    line += ", \"alive\": " + std::to_string(event.alive);
  }
  line += "}\n";
  std::fputs(line.c_str(), file_);
}

void TraceFile::close() {
  const bool bad = std::ferror(file_) != 0;
  const bool not_closed = std::fclose(file_) != 0;
  file_ = nullptr;
  if (bad || not_closed) {
    throw Error("cannot write the trace '" + path_.string() + "': the disk may be full");
  }
}
}  // namespace altiplan::host
