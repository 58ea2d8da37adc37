// SPDX-License-Identifier: Apache-2.0
// Its manifest announces a smoother, its list holds a constraint.
#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
class Eta final : public altiplan::Constraint {
 public:
  explicit Eta(const altiplan::NoParams&) {}
};

__attribute__((section("altiplan_manifest"), used)) constinit const altiplan::Manifest kManifest =
    altiplan::make_manifest("smoother", "eta", "is something else");
constinit const altiplan::PluginEntry kEntry =
    altiplan::detail::make_entry<altiplan::Constraint, Eta, altiplan::NoParams>("eta", "is so");
__attribute__((section("altiplan_entries"), used)) const altiplan::PluginEntry* const kAt = &kEntry;
}  // namespace
