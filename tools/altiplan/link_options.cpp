// SPDX-License-Identifier: Apache-2.0
#include "link_options.hpp"

#include <iostream>

namespace altiplan::cli {
namespace {

std::string address_problem(const std::string& text) {
  try {
    link::read_endpoint(text);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::optional<link::Signer> signer_of(const LinkOptions& options) {
  if (!options.sign_key) {
    return std::nullopt;
  }
  return link::Signer(link::read_signing_key(*options.sign_key));
}
}  // namespace

void add_link_options(App& command, const char* names, LinkOptions& options) {
  command
      .add_option(std::string(names) + " ADDRESS", options.address,
                  "the vehicle: udp:HOST:PORT, udpin:[HOST:]PORT to listen (default host "
                  "127.0.0.1), tcp:HOST:PORT or serial:DEVICE:BAUD")
      ->required()
      ->check(address_problem);
  command.add_option("--target N", options.target, "system id of the vehicle (default: the first)")
      ->check(Check::between(1, 255));
  command.add_option("--system N", options.system, "own system id (default 255)")
      ->check(Check::between(1, 255));
  command.add_option("--component N", options.component, "own component id (default 190)")
      ->check(Check::between(1, 255));
  command.add_option("--sign-key FILE", options.sign_key,
                     "file of a 32-byte key: packets are signed, and unsigned ones ignored");
  command
      .add_option("--timeout SECONDS", options.timeout_s,
                  "timeout for the first heartbeat of the vehicle (s, default 10)")
      ->check(number_from(0.1, 3600));
}

int connected(const LinkOptions& options, const std::function<int(Connection&)>& work) {
  const Interrupt interrupt;
  try {
    const link::Address self{std::uint8_t(options.system), std::uint8_t(options.component)};
    std::optional<link::Signer> signer = signer_of(options);
    link::Link link(link::open_transport(link::read_endpoint(options.address)), self,
                    std::move(signer));
    const link::Time timeout(std::int64_t(options.timeout_s * 1000));
    const std::optional<std::uint8_t> target =
        options.target ? std::optional(std::uint8_t(*options.target)) : std::nullopt;
    Connection connection{link, link::await_vehicle(link, target, timeout, interrupt.token()),
                          interrupt.token()};
    return work(connection);
  } catch (const link::LinkError& error) {
    std::cerr << "altiplan: " << error.what() << '\n';
    return interrupt.happened() ? kInterrupted : kNoRoute;
  }
}
}  // namespace altiplan::cli
