// SPDX-License-Identifier: Apache-2.0
// altiplan-checksum LIBRARY: writes the checksum into a newly linked plugin library. Called by
// altiplan_add_plugin; call it again after changing a library (patchelf).
#include <exception>
#include <iostream>

#include "host/plugins/checksum.hpp"

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "altiplan-checksum: expected one library, found " << count - 1 << " arguments\n";
    return 2;
  }
  try {
    altiplan::host::write_checksum(arguments[1]);
  } catch (const std::exception& error) {
    std::cerr << "altiplan-checksum: " << arguments[1] << ": " << error.what() << '\n';
    return 3;
  }
  return 0;
}
