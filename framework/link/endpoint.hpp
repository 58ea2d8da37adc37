// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace altiplan::link {

/// Where a vehicle is reached.
struct Endpoint {
  enum class Kind { udp, udp_in, tcp, serial };
  Kind kind = Kind::udp;
  std::string host;  ///< of serial: the device
  int number = 0;    ///< port; of serial: baud
  std::string text;  ///< as given
};

/// Reads `udp:HOST:PORT`, `udpin:[HOST:]PORT` (127.0.0.1 without a host), `tcp:HOST:PORT` or
/// `serial:DEVICE:BAUD`; throws Error. An IPv6 address is in brackets.
Endpoint read_endpoint(const std::string& text);
}  // namespace altiplan::link
