// SPDX-License-Identifier: Apache-2.0
// Built for another API, as its manifest says.
#include "altiplan/plugin_abi.hpp"

namespace {
constexpr altiplan::Manifest of_another_api() {
  altiplan::Manifest manifest = altiplan::make_manifest("constraint", "zeta", "of another API");
  ++manifest.api_major;
  manifest.checksum = checksum_of(manifest);
  return manifest;
}
__attribute__((section("altiplan_manifest"), used)) constinit const altiplan::Manifest kManifest =
    of_another_api();
}  // namespace
