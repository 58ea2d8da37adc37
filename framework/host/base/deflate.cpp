// SPDX-License-Identifier: Apache-2.0
#include "host/base/deflate.hpp"

#include <zlib.h>

#include "altiplan/error.hpp"

namespace altiplan::host {

std::string compressed(std::string_view bytes, int level) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size()), level) != Z_OK) {
    throw Error("out of memory while compressing");
  }
  out.resize(size);
  return out;
}

namespace {

/// `window_bits` tells zlib's format (15) from bare deflate (-15).
std::optional<std::string> inflated_from(std::string_view bytes, std::size_t max_bytes,
                                         int window_bits) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits) != Z_OK) {
    throw Error("out of memory while decompressing");
  }
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  std::string out;
  std::string part(1 << 16, '\0');
  int code = Z_OK;
  while (code == Z_OK && out.size() <= max_bytes) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = uInt(part.size());
    code = inflate(&stream, Z_NO_FLUSH);
    out.append(part, 0, part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (out.size() > max_bytes) {
    return std::nullopt;
  }
  if (code != Z_STREAM_END) {
    throw Error("the compressed data is damaged");
  }
  return out;
}
}  // namespace

std::optional<std::string> decompressed(std::string_view bytes, std::size_t max_bytes) {
  return inflated_from(bytes, max_bytes, MAX_WBITS);
}

std::optional<std::string> inflated(std::string_view bytes, std::size_t max_bytes) {
  return inflated_from(bytes, max_bytes, -MAX_WBITS);
}

std::string deflated(std::string_view bytes) {
  constexpr std::size_t kHeader = 2;  // of zlib's format
  constexpr std::size_t kTrailer = 4;
  const std::string whole = compressed(bytes, Z_BEST_COMPRESSION);
  return whole.substr(kHeader, whole.size() - kHeader - kTrailer);
}
}  // namespace altiplan::host
