// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/error.hpp"

namespace altiplan {

/// Runs a plugin's code; what it throws becomes an error that says whose it is. `who` is asked only
/// then ("the layer 'north' (terrain)").
template <class Who, class Call>
auto attributed(const Who& who, const Call& call) {
  try {
    return call();
  } catch (const ParameterError&) {
    throw;
  } catch (const BudgetSpent&) {
    throw;
  } catch (...) {
    attribute_to(who() + " ");
  }
}
}  // namespace altiplan
