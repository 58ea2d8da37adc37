// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace altiplan::link {

static_assert(std::endian::native == std::endian::little, "MAVLink sends the low byte first");

/// Number and name of a message.
struct Declared {
  std::uint32_t id;
  const char* name;
};

/// Marks in the list of a message's fields where its extensions begin.
inline constexpr struct Extensions {
} kExtensions;

/// Calls `visit(name, field)` for each of the fields, and `visit.extensions()` at that mark;
/// `names` are those of the fields, separated by ", ".
void visit_fields(auto& visit, std::string_view names, auto&... fields) {
  const auto one = [&](auto& field) {
    const std::string_view name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 2));
    if constexpr (std::is_same_v<decltype(field), const Extensions&>) {
      visit.extensions();
    } else {
      visit(name, field);
    }
  };
  (one(fields), ...);
}

/// Declares a struct to be a message: its number, its name, and its fields in the order of the
/// definition. All else follows from that and the types of the fields.
#define ALTIPLAN_MESSAGE(id, name, ...)          \
  static constexpr Declared kDeclared{id, name}; \
  void describe(auto& visit) { visit_fields(visit, #__VA_ARGS__, __VA_ARGS__); }

/// A field of a message as its definition lists it, and its position in the payload.
struct Field {
  std::string type;  ///< of one element: "uint8_t"
  std::string name;
  std::size_t size = 0;   ///< of one element, bytes
  std::size_t count = 0;  ///< elements of an array; 0: not an array
  bool is_extension = false;
  std::size_t offset = 0;

  std::size_t bytes() const { return size * (count == 0 ? 1 : count); }
};

/// How a message is sent: derived from its declaration alone.
struct Layout {
  std::uint32_t id = 0;
  std::string name;
  std::vector<Field> fields;    ///< in the order of the definition
  std::size_t length = 0;       ///< of the payload
  std::size_t base_length = 0;  ///< without extensions: what MAVLink 1 sends
  std::uint8_t crc_extra = 0;

  /// Orders the fields by size and computes offsets, lengths and the extra byte of the checksum
  /// (mavlink.io/en/guide/serialization.html).
  void arrange();
};

template <class T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, char>) {
    return "char";
  } else if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? "float" : "double";
  } else {
    constexpr const char* kSigned[] = {"int8_t", "int16_t", "int32_t", "int64_t"};
    constexpr const char* kUnsigned[] = {"uint8_t", "uint16_t", "uint32_t", "uint64_t"};
    constexpr int kLog = std::countr_zero(sizeof(T));
    return std::is_signed_v<T> ? kSigned[kLog] : kUnsigned[kLog];
  }
}

/// Visits a message's `describe` and lists its fields.
struct FieldList {
  std::vector<Field> fields{};
  bool in_extensions = false;

  void extensions() { in_extensions = true; }
  template <class T>
  void operator()(std::string_view name, const T& /*value*/) {
    fields.push_back({type_name<T>(), std::string(name), sizeof(T), 0, in_extensions});
  }
  template <class T, std::size_t N>
  void operator()(std::string_view name, const std::array<T, N>& /*value*/) {
    fields.push_back({type_name<T>(), std::string(name), sizeof(T), N, in_extensions});
  }
};

template <class M>
const Layout& layout_of() {
  static const Layout kLayout = [] {
    FieldList list;
    M().describe(list);
    Layout layout{M::kDeclared.id, M::kDeclared.name, std::move(list.fields)};
    layout.arrange();
    return layout;
  }();
  return kLayout;
}

/// Visits the fields of a message in the order of its definition, with their place in the payload.
template <class Copy>
struct FieldCopier {
  const Layout& layout;
  Copy copy;
  std::size_t index = 0;

  void extensions() {}
  template <class T>
  void operator()(std::string_view /*name*/, T& value) {
    copy(layout.fields[index++].offset, &value, sizeof value);
  }
};

/// All bytes of the payload, zeros at its end included.
template <class M>
std::string payload_of(M message) {
  const Layout& layout = layout_of<M>();
  std::string payload(layout.length, '\0');
  const auto copy = [&](std::size_t offset, const void* value, std::size_t size) {
    std::memcpy(payload.data() + offset, value, size);
  };
  FieldCopier<decltype(copy)> copier{layout, copy};
  message.describe(copier);
  return payload;
}

/// The message of a payload, which zeros follow where it is shorter than the message.
template <class M>
M message_of(std::string payload) {
  const Layout& layout = layout_of<M>();
  payload.resize(layout.length, '\0');
  M message;
  const auto copy = [&](std::size_t offset, void* value, std::size_t size) {
    std::memcpy(value, payload.data() + offset, size);
  };
  FieldCopier<decltype(copy)> copier{layout, copy};
  message.describe(copier);
  return message;
}
}  // namespace altiplan::link
