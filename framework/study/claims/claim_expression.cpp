// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/config/config_check.hpp"
#include "study/claims/claim_reader.hpp"
#include "study/claims/claims.hpp"

namespace altiplan::study {
namespace {

constexpr std::size_t kListed = 8;  ///< variants in a message
using Kind = ClaimExpression::Kind;

/// The part of a name before its bracket.
std::string id_of(const std::string& variant) { return variant.substr(0, variant.find('[')); }

/// Recursive-descent parser of expressions, one function per precedence.
class Expression {
 public:
  Expression(ClaimReader& reader, const std::vector<std::string>& pipelines,
             ClaimQuantity& quantity)
      : reader_(reader), pipelines_(pipelines), quantity_(quantity) {}

  ClaimExpression read() { return either(); }

 private:
  static constexpr int kDeepest = 100;

  ClaimExpression either() {
    return logical_chain("or", Kind::either, [this] { return both(); });
  }

  ClaimExpression both() {
    return logical_chain("and", Kind::both, [this] { return comparison(); });
  }

  template <typename Next>
  ClaimExpression logical_chain(std::string_view word, Kind kind, const Next& next) {
    ClaimExpression left = next();
    while (reader_.takes_word(word)) {
      expect_logical(left, quantity_);
      ClaimExpression right = next();
      expect_logical(right, quantity_);
      left = joined_by(kind, std::move(left), std::move(right));
    }
    return left;
  }

  ClaimExpression comparison() {
    ClaimExpression left = sum();
    // Longer operators first.
    static constexpr std::pair<std::string_view, Kind> kSigns[] = {{"<=", Kind::less_or_equal},
                                                                   {">=", Kind::greater_or_equal},
                                                                   {"==", Kind::equal},
                                                                   {"<", Kind::less},
                                                                   {">", Kind::greater}};
    for (const auto& [sign, kind] : kSigns) {
      if (reader_.takes(sign)) {
        return numbers(kind, std::move(left), sum());
      }
    }
    return left;
  }

  ClaimExpression sum() {
    ClaimExpression left = product();
    while (true) {
      if (reader_.takes("+")) {
        left = numbers(Kind::add, std::move(left), product());
      } else if (reader_.takes("-")) {
        left = numbers(Kind::subtract, std::move(left), product());
      } else {
        return left;
      }
    }
  }

  ClaimExpression product() {
    ClaimExpression left = factor();
    while (true) {
      if (reader_.takes("*")) {
        left = numbers(Kind::multiply, std::move(left), factor());
      } else if (reader_.takes("/")) {
        left = numbers(Kind::divide, std::move(left), factor());
      } else {
        return left;
      }
    }
  }

  ClaimExpression factor() {
    reader_.skip_spaces();
    if (++depth_ > kDeepest) {
      ClaimReader::fail(reader_.at(), "nested deeper than " + std::to_string(kDeepest));
    }
    ClaimExpression found;
    found.at = reader_.at();
    if (reader_.takes("-")) {
      found.kind = Kind::negate;
      found.operands.push_back(factor());
      expect_number(found.operands.front());
    } else if (reader_.takes("(")) {
      found = either();
      if (!reader_.takes(")")) {
        reader_.expected("an operator or ')'");
      }
    } else if (const std::optional<double> number = reader_.takes_number()) {
      found.number = *number;
    } else {
      found.kind = Kind::value;
      found.value = value();
    }
    --depth_;
    return found;
  }

  /// PIPELINE.value, or value if there are no pipelines: its index in the quantity's values.
  std::size_t value() {
    ClaimValue named;
    if (pipelines_.empty()) {
      named.name = bare_word();
    } else {
      named.pipeline = pipeline();
      if (!reader_.rest().starts_with('.')) {
        reader_.expected("'.' and a value's name after the pipeline (as in " +
                         pipelines_[named.pipeline] + ".length_m)");
      }
    }
    while (reader_.rest().starts_with('.')) {
      reader_.skip(1);
      const std::string_view word = reader_.peek_word();
      if (word.empty()) {
        reader_.expected("a value's name");
      }
      named.name += (named.name.empty() ? "" : ".") + std::string(word);
      reader_.skip(word.size());
    }
    std::vector<ClaimValue>& values = quantity_.values;
    const auto known = std::find(values.begin(), values.end(), named);
    const auto index = std::size_t(known - values.begin());
    if (known == values.end()) {
      values.push_back(std::move(named));
    }
    return index;
  }

  std::string bare_word() {
    const std::string word(reader_.peek_word());
    if (word.empty() || (word[0] >= '0' && word[0] <= '9')) {
      reader_.expected("a number, '(' or a value's name");
    }
    reader_.skip(word.size());
    return word;
  }

  std::size_t pipeline() {
    const std::size_t at = reader_.at();
    const std::string id(reader_.peek_word());
    if (id.empty() || (id[0] >= '0' && id[0] <= '9')) {
      reader_.expected("a number, '(' or PIPELINE.value");
    }
    std::vector<std::string> variants;
    std::vector<std::string> ids;
    for (const std::string& name : pipelines_) {
      ids.push_back(id_of(name));
      if (ids.back() == id) {
        variants.push_back(name);
      }
    }
    if (variants.empty()) {
      ClaimReader::fail(at, "no pipeline is named '" + id + "'" + host::did_you_mean(id, ids));
    }
    reader_.skip(id.size());
    const std::string name = id + std::string(bracket(id, variants));
    if (name == id && variants.size() == 1) {
      return index_of(variants.front());
    }
    if (std::find(variants.begin(), variants.end(), name) == variants.end()) {
      ClaimReader::fail(
          at, name == id ? "'" + id + "' stands for " + std::to_string(variants.size()) +
                               " variants; expected one of " + host::listed(variants, kListed)
                         : "no variant is named '" + name + "'; expected one of " +
                               host::listed(variants, kListed));
    }
    return index_of(name);
  }

  /// "[weight_g=0.3]", or "" if no bracket follows. It may contain any characters, so the longest
  /// variant name that matches the text is taken.
  std::string_view bracket(const std::string& id, const std::vector<std::string>& variants) {
    const std::string_view rest = reader_.rest();
    if (!rest.starts_with('[')) {
      return "";
    }
    std::size_t length = 0;
    for (const std::string& name : variants) {
      if (rest.starts_with(std::string_view(name).substr(id.size()))) {
        length = std::max(length, name.size() - id.size());
      }
    }
    if (length == 0) {
      const std::size_t end = rest.find(']');
      if (end == rest.npos) {
        ClaimReader::fail(reader_.at(), "the '[' is not closed");
      }
      length = end + 1;
    }
    reader_.skip(length);
    return rest.substr(0, length);
  }

  std::size_t index_of(const std::string& name) const {
    return std::size_t(std::find(pipelines_.begin(), pipelines_.end(), name) - pipelines_.begin());
  }

  static void expect_number(const ClaimExpression& part) {
    if (part.is_logical()) {
      ClaimReader::fail(part.at, "expected a number, found a comparison");
    }
  }

  static ClaimExpression numbers(Kind kind, ClaimExpression left, ClaimExpression right) {
    expect_number(left);
    expect_number(right);
    return joined_by(kind, std::move(left), std::move(right));
  }
  static ClaimExpression joined_by(Kind kind, ClaimExpression left, ClaimExpression right) {
    ClaimExpression both;
    both.kind = kind;
    both.at = left.at;
    both.operands.push_back(std::move(left));
    both.operands.push_back(std::move(right));
    return both;
  }

  ClaimReader& reader_;
  const std::vector<std::string>& pipelines_;
  ClaimQuantity& quantity_;
  int depth_ = 0;
};
}  // namespace

ClaimExpression read_expression(ClaimReader& reader, const std::vector<std::string>& pipelines,
                                ClaimQuantity& quantity) {
  return Expression(reader, pipelines, quantity).read();
}

void expect_logical(const ClaimExpression& expression, const ClaimQuantity& quantity) {
  if (expression.is_logical()) {
    return;
  }
  if (expression.kind == Kind::value && is_yes_or_no(quantity.values[expression.value].name)) {
    return;
  }
  ClaimReader::fail(expression.at,
                    "expected a comparison (such as a.length_m <= b.length_m), or a value that is "
                    "0 or 1 (solved, flight.reached, steps.ID.accepted, steps.ID.budget_hit)");
}
}  // namespace altiplan::study
