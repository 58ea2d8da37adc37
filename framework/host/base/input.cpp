// SPDX-License-Identifier: Apache-2.0
#include "host/base/input.hpp"

#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {

std::string file_problem(const std::filesystem::path& file) {
  std::error_code error;  // why_unreadable reports it
  if (std::filesystem::status(file, error).type() == std::filesystem::file_type::not_found) {
    return "file not found: '" + file.string() + "'" +
           formats::nearest_beside(file.string(), false);
  }
  const std::string why = formats::why_unreadable(file.string());
  if (why.empty()) {
    return "";
  }
  if (is_machine_fault(reading_error(file))) {
    throw MachineFault(file.string() + ": " + why);
  }
  return "'" + file.string() + "' " + why;
}
}  // namespace altiplan::host
