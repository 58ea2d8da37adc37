// SPDX-License-Identifier: Apache-2.0
// MAT-files of level 5, as The MathWorks describe them (MAT-File Format, R2023b): a header of 128
// bytes, then elements of a tag (type, size) and bytes; arrays are elements of elements.
#include "altiplan/formats/mat_file.hpp"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "altiplan/formats/input_file.hpp"

namespace altiplan::formats {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kMaxBytes = 64'000'000;  // of a variable, inflated

// Types of elements, and classes of arrays.
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;
constexpr std::uint8_t kStructure = 2;
constexpr std::uint8_t kFirstNumbers = 6;
constexpr std::uint8_t kLastNumbers = 15;

class MatReader {
 public:
  MatReader(const std::string& file, std::string_view name) : file_(file), name_(name) {}

  std::map<std::string, MatArray> read() {
    constexpr std::size_t kHeader = 128;
    const std::string text = read_file(file_, kMaxBytes);
    if (text.size() < kHeader || !text.starts_with("MATLAB 5.0") ||
        text.substr(kHeader - 4, 4) != std::string_view("\x00\x01IM", 4)) {
      fail("expected a MAT-file of level 5, little-endian (save('-v7'))");
    }
    std::string_view rest = std::string_view(text).substr(kHeader);
    while (!rest.empty()) {
      Element element = next(rest);
      std::string inflated;
      if (element.type == kCompressed) {
        inflated = inflate(element.bytes);
        std::string_view inner = inflated;
        element = next(inner);
      }
      if (element.type == kMatrix && take_variable(element.bytes)) {
        return std::move(fields_);
      }
    }
    fail("it has no structure '" + std::string(name_) + "'");
  }

 private:
  struct Element {
    std::uint32_t type = 0;
    std::string_view bytes;
  };

  [[noreturn]] void fail(const std::string& why) const { throw InputError(file_, why); }
  [[noreturn]] void fail_damaged() const { fail("it is damaged: an element does not end"); }

  /// Takes the first element off; those of arrays fill up eight bytes each.
  Element next(std::string_view& rest) const {
    std::uint32_t tag[2] = {0, 0};
    if (rest.size() < sizeof tag) {
      fail_damaged();
    }
    std::memcpy(tag, rest.data(), sizeof tag);
    if (tag[0] >> 16 != 0) {  // a small one, within its tag
      const std::size_t size = tag[0] >> 16;
      if (size > 4) {
        fail_damaged();
      }
      const Element element{tag[0] & 0xffff, rest.substr(4, size)};
      rest.remove_prefix(8);
      return element;
    }
    const std::size_t size = tag[1];
    if (size > rest.size() - sizeof tag) {
      fail_damaged();
    }
    const Element element{tag[0], rest.substr(8, size)};
    const std::size_t filled = tag[0] == kCompressed ? size : (size + 7) / 8 * 8;
    rest.remove_prefix(std::min(8 + filled, rest.size()));
    return element;
  }

  std::string inflate(std::string_view bytes) const {
    std::string out;
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) {
      fail("out of memory");
    }
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    int code = Z_OK;
    while (code == Z_OK && out.size() <= kMaxBytes) {
      char block[1 << 16];
      stream.next_out = reinterpret_cast<Bytef*>(block);
      stream.avail_out = sizeof block;
      code = ::inflate(&stream, Z_NO_FLUSH);
      out.append(block, sizeof block - stream.avail_out);
    }
    inflateEnd(&stream);
    if (code != Z_STREAM_END) {
      fail(out.size() > kMaxBytes ? "a variable has more than 64 MB" : "it is damaged (zlib)");
    }
    return out;
  }

  struct Array {
    std::uint8_t kind = 0;  // of Class
    bool is_complex = false;
    std::vector<double> counts;
    std::string name;
    std::string_view rest;
  };

  Array array_of(std::string_view bytes) const {
    Array array;
    const Element flags = next(bytes);
    const Element counts = next(bytes);
    const Element name = next(bytes);
    if (flags.bytes.size() < 2) {
      fail_damaged();
    }
    array.kind = std::uint8_t(flags.bytes[0]);
    array.is_complex = (std::uint8_t(flags.bytes[1]) & 8) != 0;
    array.counts = numbers_of(counts);
    array.name = name.bytes;
    array.rest = bytes;
    return array;
  }

  template <class T>
  static void append(std::vector<double>& values, std::string_view bytes) {
    for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
      T value{};
      std::memcpy(&value, bytes.data() + at, sizeof value);
      values.push_back(double(value));
    }
  }

  std::vector<double> numbers_of(const Element& element) const {
    std::vector<double> values;
    switch (element.type) {
      case 1:
        append<std::int8_t>(values, element.bytes);
        break;
      case 2:
        append<std::uint8_t>(values, element.bytes);
        break;
      case 3:
        append<std::int16_t>(values, element.bytes);
        break;
      case 4:
        append<std::uint16_t>(values, element.bytes);
        break;
      case 5:
        append<std::int32_t>(values, element.bytes);
        break;
      case 6:
        append<std::uint32_t>(values, element.bytes);
        break;
      case 7:
        append<float>(values, element.bytes);
        break;
      case 9:
        append<double>(values, element.bytes);
        break;
      case 12:
        append<std::int64_t>(values, element.bytes);
        break;
      case 13:
        append<std::uint64_t>(values, element.bytes);
        break;
      default:
        fail("it is damaged: numbers of type " + std::to_string(element.type));
    }
    return values;
  }

  /// True if this is the structure.
  bool take_variable(std::string_view bytes) {
    Array array = array_of(bytes);
    if (array.kind != kStructure || array.name != name_) {
      return false;
    }
    if (array.counts != std::vector<double>{1, 1}) {
      fail("'" + array.name + "' is an array of structures, expected one");
    }
    const std::vector<double> length = numbers_of(next(array.rest));
    const std::string_view names = next(array.rest).bytes;
    const std::size_t each = length.size() == 1 && length[0] > 0 ? std::size_t(length[0]) : 0;
    if (each == 0) {
      fail_damaged();
    }
    for (std::size_t at = 0; at + each <= names.size(); at += each) {
      const std::string padded(names.substr(at, each));
      take_field(padded.c_str(), next(array.rest));  // up to its first zero
    }
    return true;
  }

  void take_field(const std::string& field, const Element& element) {
    if (element.type != kMatrix || element.bytes.empty()) {
      return;
    }
    Array array = array_of(element.bytes);
    const bool are_numbers = array.kind >= kFirstNumbers && array.kind <= kLastNumbers;
    if (!are_numbers || array.is_complex || array.counts.size() != 2) {
      return;
    }
    MatArray numbers;
    numbers.values = numbers_of(next(array.rest));
    if (array.counts[0] < 0 || array.counts[1] < 0 ||
        array.counts[0] * array.counts[1] != double(numbers.values.size())) {
      fail("it is damaged: '" + field + "' has " + std::to_string(numbers.values.size()) +
           " numbers");
    }
    numbers.rows = std::size_t(array.counts[0]);
    numbers.columns = std::size_t(array.counts[1]);
    fields_[field] = std::move(numbers);
  }

  std::string file_;
  std::string_view name_;
  std::map<std::string, MatArray> fields_;
};
}  // namespace

std::map<std::string, MatArray> read_mat_structure(const std::string& file,
                                                   const std::string& name) {
  return MatReader(file, name).read();
}
}  // namespace altiplan::formats
