// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "host/first_route/wish.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::host {

/// An elevation model, in the frame that it would give a world.
struct Tile {
  std::filesystem::path file;
  std::vector<std::filesystem::path> more;  ///< files that are one model with it
  std::string crs;                          ///< to be named in a scenario; "" if the file names it
  Frame frame;
  Box bounds;
  double spacing_m = 0;  ///< of its posts, the larger one
  std::string note;      ///< "403 x 344 posts of 74.6 x 92.5 m", and voids if there are any

  bool is_geographic() const;
  bool has_voids() const { return note.find("voids") != note.npos; }
  /// True if the point lies over the posts.
  bool holds(double lon, double lat) const;
};

/// The file, or all models in the folder; messages begin with --terrain.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& given);

/// The models' layer as the terrain plugin builds it in that site.
std::unique_ptr<Environment> build_model(const Tile& tile, const Site& site, Registry& registry,
                                         const std::string& voids = "neighbours");

/// Reads place and size of a model. One without a coordinate system (`crs`: "") is read as
/// longitude and latitude if its numbers may be these. Throws Error naming the file.
Tile read_tile(const std::filesystem::path& file, const std::string& crs, Registry& registry);
/// The wish's models, and all in its folders; messages begin with --terrain.
std::vector<Tile> read_tiles(const RouteWish& wish, Registry& registry);

/// Drops those that do not reach into the box of that frame.
void drop_distant(std::vector<Tile>& tiles, const Frame& frame, const Box& reached);

/// One model of them all where they are of one grid: where they have to be resampled, each alone
/// ends within its own sides, and gaps are left between them. Else as they are.
std::vector<Tile> united(std::vector<Tile> tiles, Registry& registry);

/// Throws Error for a point beyond all tiles, naming what they cover, and, where the point with its
/// numbers swapped or their signs changed lies within, that one.
void expect_covered(const std::vector<Tile>& tiles, const WishedPoint& point);

/// Its files as parameters of the plugin: "file: …, tiles: […]".
std::string files_text(const Tile& tile);
/// The layer's entry of `environment`; `file` as the scenario has it.
std::string terrain_entry(const Tile& tile, const std::string& file);
}  // namespace altiplan::host
