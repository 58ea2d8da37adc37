// SPDX-License-Identifier: Apache-2.0
#include "host/base/gdal_programs.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"

namespace altiplan::host {
namespace {

std::string program_of(const char* name, const std::string& who) {
  const auto found = find_on_path({name});
  if (!found) {
    throw Error(who + " needs " + name + ": install the Debian package 'gdal-bin'");
  }
  return found->string();
}

/// Of "ERROR 1: what is wrong" what is wrong; "" without errors.
std::string first_complaint(const std::string& said) {
  std::size_t error = said.find("ERROR ");
  // gdalinfo asks PROJ for the ellipsoid of systems that have none, and goes on.
  while (error != said.npos && said.find("proj_get_ellipsoid", error) < said.find('\n', error)) {
    error = said.find("ERROR ", error + 1);
  }
  if (error == said.npos) {
    return "";
  }
  const std::size_t begin = std::min(said.find(": ", error), said.size() - 2) + 2;
  const std::size_t end = said.find('\n', begin);
  const std::size_t more = said.find_first_not_of(' ', std::min(end, said.size() - 1) + 1);
  const std::string words = said.substr(begin, end - begin);
  return words.ends_with(':') && more != said.npos
             ? words + " " + said.substr(more, said.find('\n', more) - more)
             : words;
}
}  // namespace

void GdalPrograms::expect_installed(const std::string& who) { program_of("gdalwarp", who); }

std::string GdalPrograms::run(std::vector<std::string> arguments) const {
  const std::string name = arguments.front();
  arguments.front() = program_of(name.c_str(), who_);
  const std::filesystem::path errors = in_folder("errors.txt");
  std::filesystem::remove(errors);
  Program program(std::move(arguments), {.wired = {1}, .errors = errors});
  const auto end = Program::Clock::now() + longest_;
  std::string printed;
  while (program.receive(printed, end)) {
  }
  const std::optional<int> code = program.ended(end);
  const std::string said = first_complaint(formats::read_file(errors));
  if (code != 0 || !said.empty()) {
    throw Error(file_ + ": " + name + ": " +
                (!code          ? "not done within " + std::to_string(longest_.count()) + " s"
                 : said.empty() ? "ended early"
                                : said));
  }
  return printed;
}
}  // namespace altiplan::host
