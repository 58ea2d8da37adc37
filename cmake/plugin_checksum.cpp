// SPDX-License-Identifier: Apache-2.0
// Room in each plugin's library for the checksum of what is loaded of it, which altiplan-checksum
// fills after linking (host/plugins/checksum.hpp).
namespace {
__attribute__((section("altiplan_checksum"), used, aligned(4))) const char kRoom[32] = {};
}
