// SPDX-License-Identifier: Apache-2.0
// Linked without the list of what a plugin exports.
#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

/// Another plugin's function of this name would be taken for it.
__attribute__((visibility("default"))) double helper_of_iota() { return 1; }

namespace {
class Iota final : public altiplan::Constraint {
 public:
  explicit Iota(const altiplan::NoParams&) {}

 private:
  bool do_admits(const altiplan::Motion&) const override { return helper_of_iota() > 0; }
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "iota", Iota, altiplan::NoParams, "exports more than its list")
