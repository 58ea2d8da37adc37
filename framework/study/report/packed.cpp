// SPDX-License-Identifier: Apache-2.0
#include "study/report/packed.hpp"

#include <zlib.h>

#include <span>
#include <vector>

#include "altiplan/error.hpp"
#include "host/base/base64.hpp"

namespace altiplan::study::report {

std::string packed(std::string_view text) {
  uLongf size = ::compressBound(uLong(text.size()));
  std::vector<Bytef> bytes(size);
  if (::compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()),
                  uLong(text.size()), Z_BEST_COMPRESSION) != Z_OK) {
    throw Error("out of memory while compressing " + std::to_string(text.size()) + " bytes");
  }
  return host::base64(std::as_bytes(std::span(bytes.data(), size)));
}
}  // namespace altiplan::study::report
