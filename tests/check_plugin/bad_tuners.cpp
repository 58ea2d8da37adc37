// SPDX-License-Identifier: Apache-2.0
// Tuners broken on purpose, one thing each.
#include <limits>

#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

enum class Flaw {
  none,
  outside,
  unequal,
  endless,
  restless,
  shared,
  thin,
  not_a_number,
  throws,
  in_turns,
  nothing
};

double same() { return 0; }

/// Draws points; equal weights in each group.
template <Flaw kFlaw, double (*kOther)()>
class SpoiltSearch final : public Search {
 public:
  SpoiltSearch(std::vector<Dimension> space, RandomStream random)
      : space_(std::move(space)), random_(random) {
    ++alive();
  }
  ~SpoiltSearch() override { --alive(); }

 private:
  static std::atomic<int>& alive() {
    static thread_local std::atomic<int> count = 0;
    return count;
  }
  std::vector<double> point() {
    std::vector<double> point;
    for (const Dimension& d : space_) {
      double group = 0;
      for (const Dimension& other : space_) {
        group += other.group == d.group;
      }
      const double drawn = random_.uniform(d.min, d.max);
      const bool unequal = kFlaw == Flaw::unequal && space_.size() == 2;
      const bool outside = kFlaw == Flaw::outside && space_.size() == 1;
      point.push_back(d.group >= 0 && !unequal ? 1 / group : drawn + outside * (d.max - d.min));
    }
    if (kOther() > 0 && space_[0].group < 0 && space_[0].max > space_[0].min) {
      point[0] = std::min(space_[0].max, space_[0].min + kOther());
    }
    if (kFlaw == Flaw::thin && space_.size() == 3) {
      point.pop_back();
    }
    if (kFlaw == Flaw::not_a_number && failed_) {
      point[0] = std::numeric_limits<double>::quiet_NaN();
    }
    if (kFlaw == Flaw::in_turns && alive() > 1) {
      static std::atomic<int> asked = 0;
      if (++asked % 2 == 0) {
        point[1] = space_[1].min;
      }
    }
    return point;
  }
  std::vector<std::vector<double>> do_ask() override {
    static std::atomic<int> of_all = 0;
    const int batch = kFlaw == Flaw::shared ? ++of_all % 20 : ++batches_;
    const bool ends = kFlaw == Flaw::restless ? batch == 10 : batch >= 10;
    if ((ends && kFlaw != Flaw::endless) || kFlaw == Flaw::nothing) {
      return {};
    }
    std::vector<std::vector<double>> points(kFlaw == Flaw::endless ? 1000 : 3);
    for (auto& one : points) {
      one = point();
    }
    return points;
  }
  void do_tell(std::span<const double> scores) override {
    failed_ = failed_ || scores[0] == kInfinity;
    if (kFlaw == Flaw::throws && failed_) {
      throw std::runtime_error("no score");
    }
  }

  std::vector<Dimension> space_;
  RandomStream random_;
  int batches_ = 0;
  bool failed_ = false;
};

template <Flaw kFlaw, Does kDoes = does_nothing, double (*kOther)() = same>
class SpoiltTuner final : public Tuner {
 public:
  template <class Params>
  explicit SpoiltTuner(const Params&) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    kDoes();
    return std::make_unique<SpoiltSearch<kFlaw, kOther>>(std::move(space), random);
  }
};
using Sound = SpoiltTuner<Flaw::none>;
template <Does kDoes>
using DoesWhat = SpoiltTuner<Flaw::none, kDoes>;
using ByAddress = SpoiltTuner<Flaw::none, does_nothing, by_address>;
}  // namespace

ALTIPLAN_PLUGIN(Tuner, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Tuner, "outside", SpoiltTuner<Flaw::outside>, NoParams,
                "asks for points outside a space of one dimension")
ALTIPLAN_PLUGIN(Tuner, "unequal", SpoiltTuner<Flaw::unequal>, NoParams,
                "a weight alone in its group is not 1")
ALTIPLAN_PLUGIN(Tuner, "endless", SpoiltTuner<Flaw::endless>, NoParams, "never ends its search")
ALTIPLAN_PLUGIN(Tuner, "restless", SpoiltTuner<Flaw::restless>, NoParams,
                "asks for more after it has ended its search")
ALTIPLAN_PLUGIN(Tuner, "thin", SpoiltTuner<Flaw::thin>, NoParams,
                "its points lack the third dimension")
ALTIPLAN_PLUGIN(Tuner, "asks_nothing", SpoiltTuner<Flaw::nothing>, NoParams, "asks for nothing")
ALTIPLAN_PLUGIN(Tuner, "shared", SpoiltTuner<Flaw::shared>, NoParams,
                "all its searches count their batches together")
ALTIPLAN_PLUGIN(Tuner, "knows_its_twin", SpoiltTuner<Flaw::in_turns>, NoParams,
                "a search asks otherwise while there is another")
ALTIPLAN_PLUGIN(Tuner, "throws_at_failures", SpoiltTuner<Flaw::throws>, NoParams,
                "throws where a score is infinite")
ALTIPLAN_PLUGIN(Tuner, "not_a_number", SpoiltTuner<Flaw::not_a_number>, NoParams,
                "asks for what is no number after a failure")
ALTIPLAN_BAD_ENTRIES(Tuner, Sound, NoParams)
ALTIPLAN_BAD_PROCESSES(Tuner, DoesWhat<changes_locale>, DoesWhat<prints>, DoesWhat<writes_file>,
                       DoesWhat<leaks>, ByAddress, NoParams)
