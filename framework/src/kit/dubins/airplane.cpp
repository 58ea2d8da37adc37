// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/dubins/airplane.hpp"

#include <algorithm>
#include <tuple>

#include "lanes.hpp"
#include "part_legs.hpp"
#include "roots.hpp"

namespace altiplan::kit {
namespace {

/// Paths this much shorter than they must be, relatively, are long enough.
constexpr double kRounding = 1e-12;

using Lengths = std::array<double, 6>;

/// Paths with one parameter from 0 to `size`, of each word: words with a larger radius.
struct Stretched {
  static constexpr int kSize = 8;
  const PosePair& pair;
  double min_radius;

  bool has(DubinsWord) const { return true; }
  double radius(double x) const { return min_radius * std::exp(0.4 * x); }
  Lengths lengths(double x) const { return pair.lengths(radius(x)); }
  double length(double x, DubinsWord word) const { return pair.length(radius(x), word); }
  std::optional<AirplanePath> path(double x, DubinsWord word) const {
    const auto found = pair.path(radius(x), word);
    return found ? std::optional(AirplanePath{*found}) : std::nullopt;
  }
};

/// Turns of the least radius before words that turn to the other side.
struct AfterTurn {
  static constexpr int kSize = 16;
  const PosePair& pair;
  double min_radius;
  int sense;

  bool has(DubinsWord word) const { return turn_sense(word, 0) != sense; }
  double radius(double) const { return min_radius; }
  double angle(double x) const { return x * (kCircle / kSize); }
  PosePair rest(double x) const { return pair.after_turn(sense * angle(x), min_radius); }
  Lengths lengths(double x) const {
    Lengths all = rest(x).lengths(min_radius);
    for (double& length : all) {
      length += min_radius * angle(x);
    }
    return all;
  }
  double length(double x, DubinsWord word) const {
    return rest(x).length(min_radius, word) + min_radius * angle(x);
  }
  std::optional<AirplanePath> path(double x, DubinsWord word) const {
    const auto found = rest(x).path(min_radius, word);
    return found ? std::optional(AirplanePath{*found, sense * angle(x)}) : std::nullopt;
  }
};

/// The path flown in the opposite direction: left turns become right turns.
AirplanePath backwards(const AirplanePath& path) {
  constexpr std::array kOpposite{DubinsWord::rsr, DubinsWord::lsl, DubinsWord::rsl,
                                 DubinsWord::lsr, DubinsWord::rlr, DubinsWord::lrl};
  const auto [first, middle, last] = path.word.parts;
  const DubinsWord word = kOpposite[std::size_t(path.word.word)];
  return {{word, path.word.radius, {last, middle, first}}, -path.after, -path.before};
}

/// Finds a path of a length between two poses, or the shortest of those that are longer.
class LengthSearch {
 public:
  LengthSearch(const PosePair& pair, double radius, double wanted)
      : pair_(pair), radius_(radius), wanted_(wanted), lengths_(pair.lengths(radius)) {}

  AirplanePath run() const {
    if (*std::min_element(lengths_.begin(), lengths_.end()) >= wanted_ * (1 - kRounding)) {
      return {pair_.path(radius_)};
    }
    if (const auto found = same_turns()) {
      return *found;
    }
    for (const bool at_edges : {false, true}) {
      if (const auto found = search(Stretched{pair_, radius_}, at_edges)) {
        return *found;
      }
      if (const auto found = after_turn(pair_, at_edges)) {
        return *found;
      }
      if (const auto found = after_turn(pair_.reversed(), at_edges)) {
        return backwards(*found);
      }
    }
    return circles_added();
  }

 private:
  std::optional<AirplanePath> after_turn(const PosePair& pair, bool at_edges) const {
    const auto left = search(AfterTurn{pair, radius_, 1}, at_edges);
    return left ? left : search(AfterTurn{pair, radius_, -1}, at_edges);
  }

  /// LSL and RSR with the largest number of whole circles, and the radius R that just uses up the
  /// length. With a sum S of the turns it is |m| + R S with m linear in R: a quadratic equation. As
  /// lengths grow with the radius, it has one root. This is a path if S has a circle more than the
  /// difference of the headings, or else if it is what the word's turns sum up to.
  std::optional<AirplanePath> same_turns() const {
    std::optional<AirplanePath> best;
    for (const DubinsWord word : {DubinsWord::lsl, DubinsWord::rsr}) {
      const bool mirrored = word == DubinsWord::rsr;
      const double sin = mirrored ? -pair_.sin : pair_.sin;
      const double left = mirrored ? -pair_.left : pair_.left;
      const double turn = mirrored && pair_.turn > 0 ? kCircle - pair_.turn : pair_.turn;
      const double m = std::hypot(pair_.ahead - radius_ * sin, left - radius_ * pair_.versed);
      const double circles = std::floor((wanted_ - m - radius_ * turn) / (kCircle * radius_));
      const double sum = turn + circles * kCircle;
      const double a = sum * sum - 2 * pair_.versed;
      const double b = wanted_ * sum - pair_.ahead * sin - left * pair_.versed;
      const double c = wanted_ * wanted_ - pair_.ahead * pair_.ahead - left * left;
      const double radius = c / (b + std::sqrt(std::max(0.0, b * b - a * c)));
      if (circles >= 0 && radius < (best ? best->word.radius : kInfinity)) {
        const auto found = completed({*pair_.path(std::max(radius, radius_), word)});
        best = found ? found : best;
      }
    }
    return best;
  }

  /// The path with as many whole circles as it lacks, if that makes it as long as it shall be.
  std::optional<AirplanePath> completed(AirplanePath path) const {
    const double lacking = (wanted_ - path.length()) / (kCircle * path.word.radius);
    path.word.parts[0] += kCircle * std::max(0.0, std::round(lacking));
    return std::abs(path.length() - wanted_) <= 1e-9 * wanted_ ? std::optional(path) : std::nullopt;
  }

  /// A path of the family with just the length and any number of circles. That is a root of what a
  /// path lacks in circles, less the nearest whole number, which is continuous where a turn of a
  /// circle is dropped. Steps at whose ends it has different signs are searched; those within which
  /// a word begins or ends, which takes longer, `at_edges` alone.
  template <class Family>
  std::optional<AirplanePath> search(const Family& family, bool at_edges) const {
    Lengths before = family.lengths(0);
    for (int n = 0; n < Family::kSize; ++n) {
      const Lengths after = family.lengths(n + 1);
      for (const DubinsWord word : kDubinsWords) {
        const auto w = std::size_t(word);
        const bool edge = (before[w] < kInfinity) != (after[w] < kInfinity);
        if (family.has(word) && edge == at_edges && std::min(before[w], after[w]) < kInfinity) {
          if (const auto found = search_step(family, word, n, before[w], n + 1, after[w])) {
            return found;
          }
        }
      }
      before = after;
    }
    return std::nullopt;
  }

  template <class Family>
  std::optional<AirplanePath> search_step(const Family& family, DubinsWord word, double low,
                                          double length_low, double high,
                                          double length_high) const {
    const auto length = [&](double x) { return family.length(x, word); };
    if (length_low == kInfinity) {
      std::tie(low, length_low) = edge(length, low, high, length_high);
    } else if (length_high == kInfinity) {
      std::tie(high, length_high) = edge(length, high, low, length_low);
    }
    const auto circles = [&](double x, double of) {
      return (wanted_ - of) / (kCircle * family.radius(x));
    };
    const auto off_whole = [](double number) { return number - std::round(number); };
    const double circles_low = circles(low, length_low);
    const double circles_high = circles(high, length_high);
    const double a = off_whole(circles_low);
    const double b = off_whole(circles_high);
    const bool too_long = circles_low < -0.5 && circles_high < -0.5;
    if (too_long || (a < 0) == (b < 0) || std::abs(a - b) > 0.5) {
      return std::nullopt;
    }
    bool missing = false;
    const auto f = [&](double x) {
      const double there = length(x);
      missing = there == kInfinity;
      return missing ? 0 : off_whole(circles(x, there));
    };
    const double root = root_between(f, low, a, high, b);
    if (missing) {
      const auto found = search_step(family, word, low, length_low, root, kInfinity);
      return found ? found : search_step(family, word, root, kInfinity, high, length_high);
    }
    const auto found = family.path(root, word);
    return found ? completed(*found) : std::nullopt;
  }

  /// Where a word that there is at `inside` ends, and its length there.
  template <class Length>
  static std::pair<double, double> edge(const Length& length, double outside, double inside,
                                        double length_inside) {
    for (int n = 0; n < 16; ++n) {
      const double middle = (outside + inside) / 2;
      const double there = length(middle);
      (there < kInfinity ? inside : outside) = middle;
      length_inside = there < kInfinity ? there : length_inside;
    }
    return {inside, length_inside};
  }

  /// The shortest of what is too long: a word with whole circles.
  AirplanePath circles_added() const {
    std::optional<AirplanePath> best;
    for (const DubinsWord word : kDubinsWords) {
      if (const auto found = pair_.path(radius_, word)) {
        AirplanePath path{*found};
        const double lacking = (wanted_ * (1 - kRounding) - path.length()) / (kCircle * radius_);
        path.word.parts[0] += kCircle * std::max(0.0, std::ceil(lacking));
        best = !best || path.length() < best->length() ? path : best;
      }
    }
    return *best;
  }

  const PosePair& pair_;
  double radius_;
  double wanted_;
  Lengths lengths_;
};
}  // namespace

double AirplaneLimits::min_length(double height_change) const {
  if (height_change == 0) {
    return 0;
  }
  return std::abs(height_change) / std::tan(height_change > 0 ? climb : sink);
}

AirplanePath path_of_length(const PosePair& pair, double radius, double min_length) {
  return LengthSearch(pair, radius, min_length).run();
}

std::optional<AirplanePath> airplane_path(const Pose& from, const Pose& to,
                                          const AirplaneLimits& limits) {
  const double minimum = limits.min_length(to.position.z() - from.position.z());
  if (minimum == kInfinity) {
    return std::nullopt;
  }
  return path_of_length(PosePair(from, to), limits.radius, minimum);
}

double airplane_length(const Pose& from, const Pose& to, const AirplaneLimits& limits,
                       double at_most) {
  const double minimum = limits.min_length(to.position.z() - from.position.z());
  if (minimum > at_most) {
    return kInfinity;
  }
  const PosePair pair(from, to);
  const Lengths lengths = pair.lengths(limits.radius);
  const double shortest = *std::min_element(lengths.begin(), lengths.end());
  if (shortest > at_most) {
    return kInfinity;
  }
  if (shortest >= minimum || minimum == kInfinity) {
    return std::max(shortest, minimum);
  }
  // Any length is possible with a circle more than LSL or RSR has, and far away with an extra turn.
  const double with_circle = std::min(lengths[0], lengths[1]) + kCircle * limits.radius;
  if (with_circle <= minimum || pair.distance() >= 8 * limits.radius) {
    return minimum;
  }
  const double length = path_of_length(pair, limits.radius, minimum).length();
  return length <= at_most ? length : kInfinity;
}

std::vector<Leg> AirplanePath::legs(const Pose& from, const Vec3& to, const Vec3& wind) const {
  const auto sense = [](double turn) { return turn < 0 ? -1 : 1; };
  const std::array<PathPart, 5> parts{{{sense(before), std::abs(before)},
                                       {turn_sense(word.word, 0), word.parts[0]},
                                       {turn_sense(word.word, 1), word.parts[1]},
                                       {turn_sense(word.word, 2), word.parts[2]},
                                       {sense(after), std::abs(after)}}};
  return part_legs(parts, word.radius, from, to, wind);
}
}  // namespace altiplan::kit
