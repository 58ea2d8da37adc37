// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/first_route/search.hpp"

namespace altiplan::host {

/// A scenario and a pipeline for a wish, and what was chosen, line by line.
struct FirstFiles {
  std::string scenario;
  std::string pipeline;
  std::vector<std::string> choices;
  std::vector<std::string> zone_layers;  ///< ids
};

/// Chooses frame, volume, cells and planner for a wish: try after try in a wider corridor, in the
/// end on smaller cells.
class FirstRoute {
 public:
  /// Reads the models. Throws Error for what the wish contradicts itself in, or the models do not
  /// cover.
  FirstRoute(const RouteWish& wish, const std::vector<std::filesystem::path>& plugin_path);

  static constexpr int kTries = 4;
  /// The volume of a try; one equal to that of the try before is not worth another run.
  Box volume(int attempt) const;
  bool repeats(int attempt) const;
  /// The files, to be written as scenario.yaml and pipeline.yaml in that folder.
  FirstFiles files(int attempt, const std::filesystem::path& folder) const;
  /// The scenario in which the mission of a route is judged as it is flown: with the limits that
  /// are wished for, in no volume. Its paths are relative to the current folder.
  std::string flown_scenario() const;
  /// A point of the wish, on the ground of sea level.
  Vec3 local(const WishedPoint& point) const;
  double speed_mps() const;
  const WishedHeights& heights() const { return heights_; }
  /// By how much the limits of height are narrower than wished for, as far as the points allow.
  double flown_margin() const;
  /// What routes keep from obstacles, for how far beside them they may be flown; 0: nothing.
  double clearance_m() const;
  /// Of a survey.
  const SurveyLines& lines() const { return lines_.value(); }
  /// In the frame; of a line with a width what lies beside each of its legs.
  const std::vector<formats::Polygon>& areas() const { return areas_; }
  double area_m2() const;
  /// By how much an aeroplane's rows go on beyond the areas.
  double beyond_m() const;
  /// Where a route lies over voids of the models: a sentence, "" if nowhere.
  std::string over_voids(const Polyline& route) const;

 private:
  /// The wish's files of zones by the ids of their layers.
  std::vector<std::string> zone_layers() const;
  std::string environment(const Box& volume, const std::filesystem::path& folder) const;
  std::string climb() const;
  std::string vehicle() const;
  std::string point(const WishedPoint& at) const;
  bool is_on_ground(const WishedPoint& at) const;
  /// Has the corridor hold take-off and landing.
  void reach_runways();
  /// Start, via points and goal; of a survey the start, if there is one, and the task.
  std::string ends() const;
  std::string survey_task() const;
  std::string cover_task() const;
  std::string follow_task() const;
  std::string lines_in_words() const;
  /// Metres flown, about.
  double length_m() const;
  std::string world(const std::string& environment, const Box& volume) const;
  std::string heights(double margin, const std::string& applies_to) const;
  std::string scenario(const Box& volume, const std::filesystem::path& folder) const;
  std::vector<std::string> choices(int attempt, const Box& volume, const Search& search) const;
  std::string heights_in_words() const;
  double bank_deg() const;
  void expect_flyable() const;

  RouteWish wish_;
  WishedHeights heights_;
  std::vector<std::string> zone_parameters_;  ///< for each of the wish's files
  std::shared_ptr<Registry> registry_;
  Corridor corridor_;
  std::optional<SurveyLines> lines_;
  std::vector<formats::Polygon> areas_;  ///< of a survey, in the frame
  formats::Ring line_;                   ///< of a survey along one, in the frame
};
}  // namespace altiplan::host
