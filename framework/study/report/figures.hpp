// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "study/figures/svg.hpp"
#include "study/report/analysis.hpp"
#include "study/report/anytime.hpp"
#include "study/report/convergence.hpp"

namespace altiplan::study::report {

/// The share of solved runs of each pipeline, with its interval.
Figure success_figure(const StudyData& data, const Analysis& analysis);
/// The outcomes of the runs of each pipeline.
Figure outcome_figure(const StudyData& data, const Analysis& analysis);
/// Box plots of a metric, one per pipeline; outliers are points that open their runs.
Figure box_figure(const StudyData& data, const MetricAnalysis& metric);
/// The effect of each pairwise comparison of pipelines, with its interval.
Figure comparison_figure(const StudyData& data, const MetricAnalysis& metric);
/// Demšar's critical-difference diagram; nothing without a ranking.
std::optional<Figure> rank_figure(const StudyData& data, const MetricAnalysis& metric);
/// The share of all runs solved within each value of the metric; nothing if no run has the metric.
std::optional<Figure> effort_figure(const StudyData& data, const std::string& metric);
/// Dolan and Moré's performance profile; nothing if the metric is not a cost, or no pair has all
/// values.
std::optional<Figure> profile_figure(const StudyData& data, const MetricAnalysis& metric);
/// The pipelines in two metrics, and the front of those that none beats in both.
Figure pareto_figure(const StudyData& data, const Trade& trade);
/// Best and mean length by iteration, and the number of a population that found a route.
Figure convergence_figure(const StudyData& data, const Convergence& convergence);
/// Of all pipelines the cost over the best known, and the share of runs with a route, by seconds or
/// by evaluations; nothing if no run has a route.
std::optional<Figure> anytime_figure(const StudyData& data, const std::vector<Anytime>& all,
                                     bool by_evaluations);

/// Medians as a curve, and the band from the 10th to the 90th percentile where both are finite.
void draw_spread(Canvas& canvas, const std::vector<double>& x, const std::vector<Spread>& y,
                 const Axis& along, const Axis& up, std::size_t series);

/// The pipeline's short name, of at most that many characters.
std::string pipeline_label(const StudyData& data, std::size_t pipeline,
                           std::size_t max_characters = 40);
/// Number of characters of a name that fit to the left of a right-aligned text.
std::size_t room_beside(const std::string& text);
/// "0.95 [0.93, 0.97]".
std::string interval_text(double estimate, const std::optional<Interval>& interval, int digits = 4);
}  // namespace altiplan::study::report
