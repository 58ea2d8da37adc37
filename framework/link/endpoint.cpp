// SPDX-License-Identifier: Apache-2.0
#include "link/endpoint.hpp"

#include <charconv>
#include <map>

#include "altiplan/error.hpp"

namespace altiplan::link {
namespace {

const std::map<std::string, Endpoint::Kind> kKinds{{"udp", Endpoint::Kind::udp},
                                                   {"udpin", Endpoint::Kind::udp_in},
                                                   {"tcp", Endpoint::Kind::tcp},
                                                   {"serial", Endpoint::Kind::serial}};

[[noreturn]] void refuse(const std::string& text) {
  throw Error(excerpt(text) +
              " is not the address of a vehicle: expected udp:HOST:PORT, udpin:[HOST:]PORT, "
              "tcp:HOST:PORT or serial:DEVICE:BAUD");
}
}  // namespace

Endpoint read_endpoint(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t last = text.rfind(':');
  const auto kind = kKinds.find(text.substr(0, first));
  if (first == std::string::npos || kind == kKinds.end()) {
    refuse(text);
  }
  Endpoint endpoint{kind->second, "", 0, text};
  if (last > first) {
    endpoint.host = text.substr(first + 1, last - first - 1);
  }
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + last + 1, end, endpoint.number);
  const int max_number = endpoint.kind == Endpoint::Kind::serial ? 4'000'000 : 65'535;
  if (error != std::errc() || stop != end || endpoint.number < 1 || endpoint.number > max_number) {
    refuse(text);
  }
  if (endpoint.kind == Endpoint::Kind::udp_in && endpoint.host.empty()) {
    endpoint.host = "127.0.0.1";
  }
  if (endpoint.host.size() > 2 && endpoint.host.front() == '[' && endpoint.host.back() == ']') {
    endpoint.host = endpoint.host.substr(1, endpoint.host.size() - 2);
  } else if (endpoint.host.empty() || (endpoint.host.find(':') != std::string::npos &&
                                       endpoint.kind != Endpoint::Kind::serial)) {
    refuse(text);
  }
  return endpoint;
}
}  // namespace altiplan::link
