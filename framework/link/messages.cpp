// SPDX-License-Identifier: Apache-2.0
#include "link/messages.hpp"

#include <map>
#include <string_view>
#include <utility>

namespace altiplan::link {
namespace {

struct Known {
  const Layout* layout;
  Message (*read)(std::string_view payload);
};

template <std::size_t... I>
std::map<std::uint32_t, Known> all_known(std::index_sequence<I...> /*alternatives*/) {
  const auto known = []<class M>(M /*message*/) {
    return std::pair(M::kDeclared.id, Known{&layout_of<M>(), [](std::string_view payload) {
                                              return Message(message_of<M>(std::string(payload)));
                                            }});
  };
  return {known(std::variant_alternative_t<I, Message>())...};
}

const Known* find(std::uint32_t id) {
  static const auto kAll = all_known(std::make_index_sequence<std::variant_size_v<Message>>());
  const auto found = kAll.find(id);
  return found == kAll.end() ? nullptr : &found->second;
}
}  // namespace

const Layout* find_layout(std::uint32_t id) {
  const Known* known = find(id);
  return known == nullptr ? nullptr : known->layout;
}

const Layout& layout_of(const Message& message) {
  return std::visit([]<class M>(const M&) -> const Layout& { return layout_of<M>(); }, message);
}

std::string payload_of(const Message& message) {
  return std::visit([](const auto& one) { return payload_of(one); }, message);
}

std::optional<Message> decode(std::uint32_t id, std::string_view payload) {
  const Known* known = find(id);
  return known == nullptr ? std::nullopt : std::optional(known->read(payload));
}
}  // namespace altiplan::link
