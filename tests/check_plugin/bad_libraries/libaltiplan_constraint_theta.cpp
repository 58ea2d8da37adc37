// SPDX-License-Identifier: Apache-2.0
// Its name and that of its plugin differ.
#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
class Iota final : public altiplan::Constraint {
 public:
  explicit Iota(const altiplan::NoParams&) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "iota", Iota, altiplan::NoParams, "is in a library of another name")
