// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace altiplan::host {

/// A request of the page, and what it gets.
struct PageRequest {
  std::string method;  ///< GET or POST
  std::string path;    ///< after the token: "/edit"
  std::string body;    ///< JSON
};
struct PageAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
};
}  // namespace altiplan::host
