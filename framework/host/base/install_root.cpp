// SPDX-License-Identifier: Apache-2.0
#include "host/base/install_root.hpp"

#include <dlfcn.h>
#include <link.h>

namespace altiplan::host {
namespace fs = std::filesystem;

fs::path install_root() {
  Dl_info here{};
  link_map* object = nullptr;  // that this code belongs to; the program is the first one
  const auto* code = reinterpret_cast<const void*>(&install_root);
  const bool is_found =
      ::dladdr1(code, &here, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  std::error_code error;
  if (!is_found || object->l_prev == nullptr) {
    return fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  }
  fs::path folder = fs::canonical(object->l_name, error).parent_path();
  for (int up = 0; up < 4; ++up) {
    folder = folder.parent_path();
  }
  return folder;
}
}  // namespace altiplan::host
