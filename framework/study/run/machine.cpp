// SPDX-License-Identifier: Apache-2.0
#include "study/run/machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

#include "altiplan/formats/iso_time.hpp"
#include "altiplan_build.hpp"

namespace altiplan::study {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) {
      const std::size_t colon = line.find(": ");
      return colon == std::string::npos ? line : line.substr(colon + 2);
    }
  }
  return "unknown processor";
}
}  // namespace

StoredSession this_session() {
  StoredSession session;
  session.started = formats::iso_time(double(std::time(nullptr)));
  session.version = ALTIPLAN_VERSION;
  utsname system{};
  uname(&system);
  session.host = system.nodename;
  session.system = std::string(system.sysname) + " " + system.release + " " + system.machine;
  session.cpu = processor();
  session.cores = int(sysconf(_SC_NPROCESSORS_ONLN));
  session.memory_mb = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) / 1e6;
  return session;
}
}  // namespace altiplan::study
