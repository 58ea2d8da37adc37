// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.hpp"
#include "interrupt.hpp"
#include "link/link.hpp"

namespace altiplan::cli {

/// How a vehicle is reached.
struct LinkOptions {
  std::string address;
  int system = 255;
  int component = 190;
  std::optional<int> target;
  std::optional<std::string> sign_key;
  double timeout_s = 10;
};

/// Adds the address under these names ("--link" and what else scripts call it), and the other
/// options.
void add_link_options(App& command, const char* names, LinkOptions& options);

/// A vehicle that has been heard.
struct Connection {
  link::Link& link;
  link::Vehicle vehicle;
  std::stop_token stop;
};

/// Connects and calls the work. A link that fails, or a vehicle that refuses, is reported: exit
/// code 1, or 130 if the user interrupted it.
int connected(const LinkOptions& options, const std::function<int(Connection&)>& work);
}  // namespace altiplan::cli
