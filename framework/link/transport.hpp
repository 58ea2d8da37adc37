// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "altiplan/error.hpp"
#include "link/endpoint.hpp"

namespace altiplan::link {

/// The link, or the vehicle at its other end, failed.
class LinkError : public Error {
 public:
  using Error::Error;
};

/// Carries bytes to and from a vehicle.
class Transport {
 public:
  virtual ~Transport() = default;

  virtual void send(std::string_view bytes) = 0;
  /// The bytes that arrive within the time, of one datagram at most; "" if none do.
  virtual std::string receive(std::chrono::milliseconds wait) = 0;
  /// A datagram holds whole packets.
  virtual bool has_datagrams() const = 0;
};

/// Throws LinkError if the endpoint cannot be opened.
std::unique_ptr<Transport> open_transport(const Endpoint& endpoint);
}  // namespace altiplan::link
