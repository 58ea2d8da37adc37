// SPDX-License-Identifier: Apache-2.0
#include "link/declared.hpp"

#include <algorithm>

#include "link/checksum.hpp"

namespace altiplan::link {
namespace {

/// Larger elements first, extensions last and as declared.
std::vector<Field*> in_wire_order(std::vector<Field>& fields) {
  std::vector<Field*> order;
  for (Field& field : fields) {
    order.push_back(&field);
  }
  std::stable_sort(order.begin(), order.end(), [](const Field* a, const Field* b) {
    if (a->is_extension || b->is_extension) {
      return !a->is_extension && b->is_extension;
    }
    return a->size > b->size;
  });
  return order;
}
}  // namespace

void Layout::arrange() {
  std::string definition = name + ' ';
  length = base_length = 0;
  for (Field* field : in_wire_order(fields)) {
    field->offset = length;
    length += field->bytes();
    if (field->is_extension) {
      continue;
    }
    base_length = length;
    definition += field->type + ' ' + field->name + ' ';
    if (field->count > 0) {
      definition += static_cast<char>(field->count);
    }
  }
  const std::uint16_t crc = checksum(definition);
  crc_extra = static_cast<std::uint8_t>((crc & 0xff) ^ (crc >> 8));
}
}  // namespace altiplan::link
