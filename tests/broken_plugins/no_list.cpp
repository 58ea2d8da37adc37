// SPDX-License-Identifier: Apache-2.0
// A manifest without the function that the host calls.
#include "altiplan/plugin_abi.hpp"

namespace {
__attribute__((section("altiplan_manifest"), used)) constinit const altiplan::Manifest kManifest =
    altiplan::make_manifest("constraint", "delta", "exports nothing");
}  // namespace
