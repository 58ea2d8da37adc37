// SPDX-License-Identifier: Apache-2.0
#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

extern "C" int neighbours_answer();

namespace {

struct Params {
  double answer = neighbours_answer();
  void describe(altiplan::Fields& f) { f("answer", answer).doc("what the neighbour says"); }
};

class Neighbourly final : public altiplan::Constraint {
 public:
  explicit Neighbourly(const Params&) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "neighbourly", Neighbourly, Params, "needs a library beside its own")
