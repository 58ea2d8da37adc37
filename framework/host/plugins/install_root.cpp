// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/install_root.hpp"

#include <dlfcn.h>
#include <sys/auxv.h>

namespace altiplan::host {
namespace fs = std::filesystem;

fs::path install_root() {
  Dl_info here{};
  Dl_info program{};
  const auto* code = reinterpret_cast<const void*>(&install_root);
  const auto* headers = reinterpret_cast<const void*>(::getauxval(AT_PHDR));
  std::error_code error;
  // The headers of the program lie in its first mapping; this code lies in another one only if it
  // belongs to a module that the program has loaded.
  const bool is_module = ::dladdr(code, &here) != 0 && ::dladdr(headers, &program) != 0 &&
                         here.dli_fbase != program.dli_fbase;
  if (!is_module) {
    return fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  }
  fs::path folder = fs::canonical(here.dli_fname, error).parent_path();
  for (int up = 0; up < 4; ++up) {
    folder = folder.parent_path();
  }
  return folder;
}
}  // namespace altiplan::host
