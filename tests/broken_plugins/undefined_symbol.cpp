// SPDX-License-Identifier: Apache-2.0
// Calls a function that no library has; lazy binding would notice only in the call.
#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

double missing_function_of_a_test();

namespace {

class Gamma final : public altiplan::Constraint {
 public:
  explicit Gamma(const altiplan::NoParams&) {}

 private:
  bool do_admits(const altiplan::Motion&) const override {
    return missing_function_of_a_test() > 0;
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "gamma", Gamma, altiplan::NoParams, "cannot be loaded")
