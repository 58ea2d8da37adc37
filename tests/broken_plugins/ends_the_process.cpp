// SPDX-License-Identifier: Apache-2.0
// A good manifest, but loading it aborts.
#include <cstdlib>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {

class Epsilon final : public altiplan::Constraint {
 public:
  explicit Epsilon(const altiplan::NoParams&) {}
};
__attribute__((constructor)) void end_the_process() { std::abort(); }
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "epsilon", Epsilon, altiplan::NoParams, "aborts")
