// SPDX-License-Identifier: Apache-2.0
#include "altiplan/constraint.hpp"

#include "altiplan/attributed.hpp"

namespace altiplan {

Constraint::~Constraint() = default;
AppliesTo Constraint::do_applies_to() const { return AppliesTo::both; }
void Constraint::do_tighten(Limits&, const Request&) const {}

bool Constraint::do_admits(const Motion&) const { return true; }
bool Constraint::do_admits_all() const { return false; }
std::vector<Violation> Constraint::do_violations(const Polyline&, const Request&) const {
  return {};
}

bool NamedConstraint::admits(const Motion& leg) const {
  return attributed([&] { return "the constraint '" + name + "'"; },
                    [&] { return constraint->admits(leg); });
}
}  // namespace altiplan
