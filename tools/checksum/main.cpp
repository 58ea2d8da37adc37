// SPDX-License-Identifier: Apache-2.0
// altiplan-checksum LIBRARY: fills in the checksum of a plugin library that has just been linked.
// altiplan_add_plugin calls it; so does whoever changes a library afterwards (patchelf).
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
