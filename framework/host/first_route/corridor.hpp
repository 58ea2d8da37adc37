// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/first_route/tiles.hpp"

namespace altiplan::host {

/// Where routes between the points are sought: a frame, the models, and boxes that grow.
class Corridor {
 public:
  /// Throws Error for points outside the models.
  Corridor(const RouteWish& wish, Registry& registry);

  /// Boxes hold this place, too.
  void reach(const Vec3& p) { points_.push_back(p); }
  /// Boxes from the narrowest to all of the models; heights are those of the ground within.
  static constexpr int kWidths = 3;
  Box box(int width) const;

  /// "frame: {origin_lonlat: [8.5, 46.5]}", or "" for the first model's own.
  const std::string& frame_line() const { return frame_line_; }
  std::string frame_in_words() const;
  const Frame& frame() const { return frame_; }
  /// What of a route lies over voids of the models, which are read once more.
  struct Voids {
    double length_m = 0;
    bool at_start = false;
    bool at_goal = false;
  };
  Voids voids_below(const Polyline& route) const;
  /// Models within the box, the start's first.
  std::vector<Tile> tiles(const Box& box) const;
  /// True if the box covers all models.
  bool is_all(const Box& box) const;
  double length_m() const { return length_m_; }
  double spacing_m() const { return tiles_.front().spacing_m; }

 private:
  /// Leaves out models so far from all points that no box reaches them.
  void drop_distant();
  void choose_frame();
  Box in_frame(const Tile& tile) const;
  Box all_tiles() const;
  /// Lowest and highest ground.
  std::array<double, 2> ground(const Box& box) const;

  Registry& registry_;
  std::vector<Tile> tiles_;
  std::vector<WishedPoint> wished_;
  double turn_radius_m_ = 0;
  std::string frame_line_;
  LonLat middle_{0, 0};        ///< of the points
  bool is_resampled_ = false;  ///< the models are brought into the frame
  Frame frame_;
  /// Of each model in the frame, where that takes building it.
  mutable std::map<std::filesystem::path, Box> covered_;
  std::vector<Vec3> points_;  ///< without heights
  double length_m_ = 0;
};
}  // namespace altiplan::host
