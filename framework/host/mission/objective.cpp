// SPDX-License-Identifier: Apache-2.0
#include "host/mission/objective.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/total_limit.hpp"
#include "host/base/built_in.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::host {
namespace {

/// Costs times weights, added up. A sum of consistent bounds is consistent.
class WeightedSum : public Objective {
 public:
  struct Term {
    double weight;
    std::shared_ptr<const Objective> objective;
  };
  explicit WeightedSum(std::vector<Term> terms) : terms_(std::move(terms)) {}

 protected:
  const std::vector<Term>& terms() const { return terms_; }

 private:
  double do_cost(const Leg& leg, double time_s, const Request& request) const override {
    double sum = 0;
    for (const Term& term : terms_) {
      sum += term.weight * term.objective->cost(leg, time_s, request);
    }
    return sum;
  }
  double do_bound(const Vec3& from, const Vec3& to, const Request& request) const override {
    double sum = 0;
    for (const Term& term : terms_) {
      sum += term.weight * term.objective->bound(from, to, request);
    }
    return sum;
  }
  /// The terms of all, each times its weight.
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    std::vector<double> all;
    for (const Term& term : terms_) {
      for (const double cost : term.objective->costs(route, request)) {
        all.push_back(term.weight * cost);
      }
    }
    return all;
  }
  double do_min_cost(const Request& request) const override {
    double sum = 0;
    for (const Term& term : terms_) {
      sum += term.weight * term.objective->min_cost(request);
    }
    return sum;
  }
  /// That of all terms; none where they differ: the weights convert them.
  std::string do_unit() const override {
    const std::string unit = terms_.front().objective->unit();
    for (const Term& term : terms_) {
      if (term.objective->unit() != unit) {
        return "";
      }
    }
    return unit;
  }
  Traits do_traits() const override {
    Traits any{.place = false};
    for (const Term& term : terms_) {
      const Traits its = term.objective->traits();
      any.place = any.place || its.place;
      any.heading = any.heading || its.heading;
      any.time = any.time || its.time;
      any.waypoints = any.waypoints || its.waypoints;
    }
    return any;
  }

  std::vector<Term> terms_;
};

/// The same of terms that all are means.
class WeightedMean final : public WeightedSum, public kit::MeanCost {
 public:
  /// None if a term is no mean.
  static std::shared_ptr<const Objective> of(const std::vector<Term>& terms) {
    auto sum = std::make_shared<WeightedMean>(terms);
    for (const Term& term : terms) {
      const auto* mean = dynamic_cast<const kit::MeanCost*>(term.objective.get());
      if (mean == nullptr || !mean->is_mean()) {
        return nullptr;
      }
      sum->means_.push_back(mean);
    }
    return sum;
  }
  using WeightedSum::WeightedSum;

  double per_metre(const Vec3& from, const Vec3& to) const override {
    double sum = 0;
    for (std::size_t i = 0; i < means_.size(); ++i) {
      sum += terms()[i].weight * means_[i]->per_metre(from, to);
    }
    return sum;
  }

 private:
  std::vector<const kit::MeanCost*> means_;
};

std::shared_ptr<const Objective> make_objective(const Config& config, const std::string& name,
                                                const Value& parameters, const Site& site,
                                                const std::string& key) {
  if (name == "weighted") {
    WeightedParams params;
    bind(params, &parameters);
    std::vector<WeightedSum::Term> terms;
    for (std::size_t i = 0; i < params.of.size(); ++i) {
      const ObjectiveTerm& term = params.of[i];
      terms.push_back({term.weight, make_objective(config, term.plugin, term.parameters, site,
                                                   item(key + ".of", i) + "." + term.plugin)});
    }
    const std::shared_ptr<const Objective> mean = WeightedMean::of(terms);
    return mean != nullptr ? mean : std::make_shared<WeightedSum>(std::move(terms));
  }
  try {
    std::shared_ptr<Objective> made =
        plugin(*config.registry, "objective", name).objective(&parameters, site);
    if (made == nullptr) {
      throw PluginError("made no object");
    }
    made->set_name("'" + name + "' (" + key + ")");
    return made;
  } catch (const ConfigError&) {
    throw;
  } catch (const PluginError& error) {
    throw PluginError("the objective '" + name + "' (" + key + ") " + error.what(), error.reason());
  } catch (const ParameterError& error) {
    throw ConfigError(place_of(parameters, error.key()), key + "." + error.key(), error.what());
  } catch (const Error& error) {
    throw ConfigError(parameters.where, key, error.what());
  }
}

/// The objective in force, or null.
std::shared_ptr<const Objective> made_objective(const Config& config, const Site& site) {
  const ObjectiveEntry* entry = config.objective();
  if (entry == nullptr) {
    return nullptr;
  }
  Site own = site;
  own.random = site.random.sub("objective");
  const std::string key = config.pipeline.objective ? "objective." : "scenario.objective.";
  return make_objective(config, entry->plugin, entry->parameters, own, key + entry->plugin);
}

void expect_minimised(const Config& config, const Objective& objective) {
  if (std::vector<Problem> problems = planner_problems(config, objective); !problems.empty()) {
    throw ConfigError(std::move(problems));
  }
}
}  // namespace

std::shared_ptr<const Objective> objective_of(const Config& config, const Site& site) {
  std::shared_ptr<const Objective> objective = made_objective(config, site);
  if (objective != nullptr) {
    expect_minimised(config, *objective);
  }
  return objective;
}

void expect_minimised(const Config& config) {
  const World nothing;
  Site site;
  site.before = &nothing;
  site.volume = {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
  std::shared_ptr<const Objective> objective;
  try {
    objective = made_objective(config, site);
  } catch (const Error&) {  // it is known with the world alone
  }
  if (objective != nullptr) {
    expect_minimised(config, *objective);
  }
}

std::shared_ptr<const Constraint> limit_of(const Config& config, const Value& parameters,
                                           const Site& site, const std::string& key) {
  LimitParams params;
  bind(params, &parameters);
  Site own = site;
  own.random = site.random.sub(key);
  return std::make_shared<TotalLimit>(make_objective(config, params.of.plugin, params.of.parameters,
                                                     own, key + ".of." + params.of.plugin),
                                      params.maximum);
}

std::vector<Metric> metrics_of(const Config& config, const Site& site,
                               const std::function<void(const std::string&)>& calling) {
  std::vector<Metric> metrics;
  Site own = site;
  const auto add = [&](const std::vector<MetricEntry>& entries, const std::string& list) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      calling("the metric '" + entries[i].id + "': its constructor");
      own.random = site.random.sub("metric:" + entries[i].id);
      metrics.push_back(
          {entries[i].id, make_objective(config, entries[i].plugin, entries[i].parameters, own,
                                         item(list, i) + "." + entries[i].plugin)});
    }
  };
  add(config.scenario.metrics, "scenario.metrics");
  add(config.pipeline.metrics, "metrics");
  return metrics;
}

MetricValues measured(const Route& route, const Request& request,
                      const std::vector<Metric>& metrics) {
  MetricValues values;
  for (const Metric& metric : metrics) {
    values.emplace_back(metric.name, metric.of->cost(route, request));
  }
  return values;
}

MetricValues measured(const std::vector<std::pair<double, Vec3>>& track, const Request& request,
                      const std::vector<Metric>& metrics) {
  MetricValues values;
  for (const Metric& metric : metrics) {
    // The samples of a flight are no waypoints.
    double cost = metric.of->traits().waypoints ? kInfinity : 0;
    for (std::size_t i = 1; i < track.size(); ++i) {
      cost += metric.of->cost(Leg::straight(track[i - 1].second, track[i].second),
                              track[i - 1].first - track.front().first, request);
    }
    values.emplace_back(metric.name, cost);
  }
  return values;
}
}  // namespace altiplan::host
