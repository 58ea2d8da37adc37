// SPDX-License-Identifier: Apache-2.0
// Tuners and plugin entries broken on purpose, a law each.
#include <atomic>
#include <limits>
#include <stdexcept>

#include "altiplan/plugin_abi.hpp"
#include "catches.hpp"

namespace altiplan::conformance {
namespace {

enum class Flaw { none, outside, unequal, endless, restless, shared, thin, not_a_number, throws };

class ToldSearch final : public Search {
 public:
  ToldSearch(std::vector<Dimension> space, RandomStream random, Flaw flaw)
      : space_(std::move(space)), random_(random), flaw_(flaw) {}

 private:
  /// Equal weights in each group, a draw elsewhere.
  std::vector<double> point() {
    std::vector<double> point;
    for (const Dimension& d : space_) {
      double group = 0;
      for (const Dimension& other : space_) {
        group += other.group == d.group;
      }
      const double drawn = random_.uniform(d.min, d.max);
      const bool weight = d.group >= 0 && flaw_ != Flaw::unequal;
      point.push_back(weight ? 1 / group : drawn + (flaw_ == Flaw::outside) * (d.max - d.min));
    }
    if (flaw_ == Flaw::thin) {
      point.pop_back();
    }
    if (flaw_ == Flaw::not_a_number && failed_) {
      point[0] = std::numeric_limits<double>::quiet_NaN();
    }
    return point;
  }
  std::vector<std::vector<double>> do_ask() override {
    static std::atomic<int> of_all = 0;
    const int batch = flaw_ == Flaw::shared ? ++of_all % 20 : ++batches_;
    const bool ends = flaw_ == Flaw::restless ? batch == 10 : batch >= 10;
    if (ends && flaw_ != Flaw::endless) {
      return {};
    }
    std::vector<std::vector<double>> points(flaw_ == Flaw::endless ? 1000 : 3);
    for (auto& one : points) {
      one = point();
    }
    return points;
  }
  void do_tell(std::span<const double> scores) override {
    failed_ = failed_ || scores[0] == kInfinity;
    if (flaw_ == Flaw::throws && failed_) {
      throw std::runtime_error("no score");
    }
  }

  std::vector<Dimension> space_;
  RandomStream random_;
  Flaw flaw_;
  int batches_ = 0;
  bool failed_ = false;
};

class ToldTuner final : public Tuner {
 public:
  explicit ToldTuner(Flaw flaw) : flaw_(flaw) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    return std::make_unique<ToldSearch>(std::move(space), random, flaw_);
  }
  Flaw flaw_;
};

TEST(CatchesTuner, Flaws) {
  const auto of = [](Flaw flaw) {
    return tuner_cases([flaw] { return std::make_unique<ToldTuner>(flaw); });
  };
  expect_clean("sound", of(Flaw::none));
  for (const Flaw flaw :
       {Flaw::outside, Flaw::unequal, Flaw::endless, Flaw::restless, Flaw::thin}) {
    expect_caught("flaw " + std::to_string(int(flaw)), of(flaw), "Tuner law 1");
  }
  expect_caught("shared", of(Flaw::shared), "Tuner law 3");
  expect_caught("throws", of(Flaw::throws), "Tuner law 2");
  expect_caught("not a number after a failure", of(Flaw::not_a_number), "Tuner law 2");
}

struct Sound {
  double size_m = 5;
  Vec3 cell_m{1, 2, 3};
  std::vector<double> weights;
  void describe(Fields& f) {
    f("size_m", size_m).range(1, 9).doc("of it");
    f("cell_m", cell_m).greater_than(0).doc("of a cell");
    f("weights", weights).range(0, 1).doc("of terms");
  }
};
struct BadName {
  int bad_name = 1;
  void describe(Fields& f) { f("badName", bad_name).doc("what"); }
};
struct Silent {
  int size = 1;
  void describe(Fields& f) { f("size", size); }
};
struct Wild {
  double size = 20;
  void describe(Fields& f) { f("size", size).range(1, 9).doc("of it"); }
};

template <class Params>
class Straight final : public Smoother {
 public:
  explicit Straight(const Params&) {}

 private:
  PlanResult do_smooth(const Route& route, const Request&) const override {
    PlanResult result;
    result.status = Status::solved;
    result.route = route;
    return result;
  }
};

template <class Params>
PluginEntry entry(const char* name = "straight", const char* sentence = "does nothing") {
  return detail::make_entry<Smoother, Straight<Params>, Params>(name, sentence);
}

TEST(CatchesPlugin, Flaws) {
  expect_clean("sound", plugin_cases(entry<Sound>()));
  expect_caught("name", plugin_cases(entry<Sound>("goStraight")), "Plugin entry: a kind");
  expect_caught("sentence", plugin_cases(entry<Sound>("straight", "")), "Plugin entry: a kind");
  PluginEntry odd = entry<Sound>();
  odd.kind = "planner";
  expect_caught("kind", plugin_cases(odd), "Plugin entry: a kind");
  expect_caught("camel", plugin_cases(entry<BadName>()), "Plugin parameters: names");
  expect_caught("silent", plugin_cases(entry<Silent>()), "Plugin parameters: names");
  expect_caught("wild", plugin_cases(entry<Wild>()), "Plugin parameters: defaults");
  PluginEntry deaf = entry<Sound>();
  deaf.describe = [](const Value*, const std::string& path) {
    return detail::describe<Sound>(nullptr, path);
  };
  expect_caught("deaf", plugin_cases(deaf), "Plugin parameters: unknown keys");
  PluginEntry throwing = entry<Sound>();
  throwing.describe = [](const Value* value, const std::string& path) {
    return value != nullptr ? throw std::runtime_error("no") : detail::describe<Sound>(value, path);
  };
  expect_caught("throwing", plugin_cases(throwing), "Plugin parameters: describe");
  PluginEntry careless = entry<Sound>();
  careless.smoother = [](const Value*) -> std::unique_ptr<Smoother> {
    return std::make_unique<Straight<Sound>>(Sound());
  };
  expect_caught("careless", plugin_cases(careless), "Plugin entry: makes");
  PluginEntry thrower = entry<Sound>();
  thrower.smoother = [](const Value*) -> std::unique_ptr<Smoother> { throw 42; };
  expect_caught("thrower", plugin_cases(thrower), "Plugin entry: makes");
}
}  // namespace
}  // namespace altiplan::conformance
