// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "host/edit/page_request.hpp"

namespace altiplan::serve {

/// What the server is given, and tells.
struct Server {
  /// Called on any of its threads.
  std::function<host::PageAnswer(const host::PageRequest&)> answer;
  /// Called once it listens, with the page's address.
  std::function<void(const std::string& address)> begun;
};

/// Serves the page on a free port of the loopback interface, under a random token that every
/// request must name, until the page has been closed. In a library of its own, loaded by `altiplan
/// edit` alone: TLS and compression, which its HTTP library links, cost every start 7 ms.
/// Throws Error if no port is free.
using ServeFunction = void(const Server&);
inline constexpr const char* kServeSymbol = "altiplan_serve";
inline constexpr const char* kServeLibrary = "libaltiplan-serve.so";
}  // namespace altiplan::serve
