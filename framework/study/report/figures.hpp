// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "study/figures/svg.hpp"
#include "study/report/analysis.hpp"
#include "study/report/convergence.hpp"

namespace altiplan::study::report {

/// The share of solved runs of each pipeline, with its interval.
Figure success_figure(const StudyData& data, const Analysis& analysis);
/// How the runs of each pipeline ended.
Figure outcome_figure(const StudyData& data, const Analysis& analysis);
/// The values of a metric, a box for each pipeline; its outliers are points that open their runs.
Figure box_figure(const StudyData& data, const MetricAnalysis& metric);
/// What a comparison comes to, with its interval, for each two pipelines.
Figure comparison_figure(const StudyData& data, const MetricAnalysis& metric);
/// Demšar's critical-difference diagram; nothing without a ranking.
std::optional<Figure> rank_figure(const StudyData& data, const MetricAnalysis& metric);
/// The share of all runs that solved within so much; nothing where no run has the metric.
std::optional<Figure> effort_figure(const StudyData& data, const std::string& metric);
/// Dolan and Moré's performance profile; nothing where the metric is no cost, or no pair has all
/// that it takes.
std::optional<Figure> profile_figure(const StudyData& data, const MetricAnalysis& metric);
/// Best and mean length by iteration, and how many of a population found a route.
Figure convergence_figure(const StudyData& data, const Convergence& convergence);

/// The pipeline's short name, of at most so many characters.
std::string pipeline_label(const StudyData& data, std::size_t pipeline, std::size_t most = 40);
/// How many characters of a name fit to the left of a text, which ends where the figure does.
std::size_t room_beside(const std::string& text);
/// "0.95 [0.93, 0.97]".
std::string interval_text(double estimate, const std::optional<Interval>& interval, int digits = 4);
}  // namespace altiplan::study::report
