// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claim_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "study/claims/claims.hpp"

namespace altiplan::study {
namespace {
using Kind = ClaimExpression::Kind;

/// The runs of a pair, by pipeline.
using Runs = std::map<std::size_t, const RunRow*>;

/// NaN if the run lacks the value or did not solve the problem.
double value_of(const RunRow& run, const std::string& name, std::size_t column) {
  if (name == "solved") {
    return run.solved() ? 1 : 0;
  }
  const bool counts = run.solved() || is_of_every_run(name);
  return counts && column < run.values.size() ? run.values[column] : kNone;
}

double of_operands(Kind kind, double a, double b) {
  if (kind <= Kind::divide) {
    return kind == Kind::add        ? a + b
           : kind == Kind::subtract ? a - b
           : kind == Kind::multiply ? a * b
                                    : a / b;
  }
  if (std::isnan(a) || std::isnan(b)) {
    return kNone;  // neither true nor false
  }
  return kind == Kind::less               ? a < b
         : kind == Kind::less_or_equal    ? a <= b
         : kind == Kind::greater          ? a > b
         : kind == Kind::greater_or_equal ? a >= b
         : kind == Kind::equal            ? a == b
         : kind == Kind::both             ? a != 0 && b != 0
                                          : a != 0 || b != 0;
}

}  // namespace

double evaluate(const ClaimExpression& expression, const std::vector<double>& values) {
  switch (expression.kind) {
    case Kind::number:
      return expression.number;
    case Kind::value:
      return values[expression.value];
    case Kind::negate:
      return -evaluate(expression.operands[0], values);
    default:
      return of_operands(expression.kind, evaluate(expression.operands[0], values),
                         evaluate(expression.operands[1], values));
  }
}

namespace {
/// Pipelines whose `solved` is an operand of the outermost chain of `and`.
void find_guards(const ClaimExpression& expression, const ClaimQuantity& quantity,
                 std::set<std::size_t>& guards) {
  if (expression.kind == Kind::both) {
    find_guards(expression.operands[0], quantity, guards);
    find_guards(expression.operands[1], quantity, guards);
  } else if (expression.kind == Kind::value && quantity.values[expression.value].name == "solved") {
    guards.insert(quantity.values[expression.value].pipeline);
  }
}

/// Evaluates the quantity's expression pair by pair.
class Evaluation {
 public:
  Evaluation(const StudyData& data, const ClaimQuantity& quantity) : quantity_(quantity) {
    find_guards(quantity.expression, quantity, guards_);
    for (const ClaimValue& value : quantity.values) {
      columns_.push_back(data.column(value.name));
    }
    pairs_.missing.assign(quantity.values.size(), 0);
  }

  /// `runs` are those of the pipelines named.
  void add(std::size_t scenario, const Runs& runs, bool is_whole) {
    ++pairs_.all;
    pairs_.whole += is_whole ? 1 : 0;
    std::vector<double> values;
    bool is_false = false;  // because of a guard
    bool is_missing = false;
    for (std::size_t i = 0; i < quantity_.values.size(); ++i) {
      const ClaimValue& named = quantity_.values[i];
      const auto run = runs.find(named.pipeline);
      values.push_back(run == runs.end() ? kNone : value_of(*run->second, named.name, columns_[i]));
      if (!std::isnan(values.back())) {
        continue;
      }
      if (run != runs.end() && !run->second->solved() && guards_.contains(named.pipeline)) {
        is_false = true;
      } else {
        is_missing = true;
        ++pairs_.missing[i];
      }
    }
    if (!is_missing) {
      add_result(scenario, is_false ? 0 : evaluate(quantity_.expression, values));
    }
  }

  void repeats() { pairs_.repeat_themselves = true; }

  ClaimPairs take() { return std::move(pairs_); }

 private:
  void add_result(std::size_t scenario, double result) {
    if (std::isnan(result)) {
      ++pairs_.undefined;
      return;
    }
    pairs_.results.push_back(result);
    pairs_.scenarios.push_back(scenario);
  }

  const ClaimQuantity& quantity_;
  std::set<std::size_t> guards_;
  std::vector<std::size_t> columns_;  ///< one per value of the quantity
  ClaimPairs pairs_;
};
}  // namespace

ClaimPairs pairs_of(const StudyData& data, const ClaimQuantity& quantity, EqualRepetitions equal) {
  std::set<std::size_t> named;
  for (const ClaimValue& value : quantity.values) {
    named.insert(value.pipeline);
  }
  const std::vector<bool> repeat = repeat_themselves(data);
  const bool is_once =
      equal == EqualRepetitions::count_once &&
      std::all_of(named.begin(), named.end(), [&](std::size_t p) { return repeat[p]; });
  Evaluation evaluation(data, quantity);
  // Rows are sorted by scenario, so the pairs of a scenario are contiguous.
  for (auto row = data.rows.begin(); row != data.rows.end();) {
    const std::size_t scenario = row->scenario;
    std::map<int, Runs> pairs;  // by repetition
    for (; row != data.rows.end() && row->scenario == scenario; ++row) {
      Runs& runs = pairs[row->repetition];
      if (named.contains(row->pipeline)) {
        runs[row->pipeline] = &*row;
      }
    }
    if (is_once && pairs.size() > 1) {
      evaluation.repeats();
      const auto is_whole = [&](const auto& pair) { return pair.second.size() == named.size(); };
      const auto whole = std::find_if(pairs.begin(), pairs.end(), is_whole);
      const Runs& runs = whole == pairs.end() ? pairs.begin()->second : whole->second;
      evaluation.add(scenario, runs, whole != pairs.end());
      continue;
    }
    for (const auto& [repetition, runs] : pairs) {
      evaluation.add(scenario, runs, runs.size() == named.size());
    }
  }
  return evaluation.take();
}
}  // namespace altiplan::study
