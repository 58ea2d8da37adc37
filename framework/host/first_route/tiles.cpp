// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"
#include "host/base/words.hpp"
#include "host/config/yaml.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLonLat = "EPSG:4326";

/// Extensions of the terrain plugin's formats, for files of a folder.
bool may_be_model(const fs::path& file) {
  static const std::set<std::string> kExtensions{".tif", ".tiff", ".hgt", ".dt0", ".dt1",
                                                 ".dt2", ".asc",  ".bil", ".img"};
  std::string extension = file.extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return kExtensions.count(extension) > 0;
}

/// So small a volume that little of a large model is read.
Site probing_site(const World& empty) {
  Site site;
  site.volume = {{0, 0, -1000}, {1, 1, 10000}};
  site.frame_crs = "own";
  site.before = &empty;
  return site;
}

/// Without heights, which are those of the part that was read.
std::string short_note(const std::string& note) {
  const std::string voids = note.substr(note.rfind(", "));
  return note.substr(0, note.find(", ")) + (voids == ", no voids" ? "" : voids);
}

Tile probe(Tile tile, Registry& registry) {
  const World empty;
  const auto layer = build_model(tile, probing_site(empty), registry);
  tile.frame = layer->info().frame.value();
  tile.bounds = layer->bounds();
  const auto& spacing = layer->ground()->height_field()->spacing();
  tile.spacing_m = std::max(spacing[0], spacing[1]);
  tile.note = short_note(layer->info().notes.at(0));
  return tile;
}

std::string lonlat(double lon, double lat) {
  return with_digits(lon, 9) + "," + with_digits(lat, 9);
}

bool is_held(const std::vector<Tile>& tiles, double lon, double lat) {
  return std::any_of(tiles.begin(), tiles.end(),
                     [&](const Tile& tile) { return tile.holds(lon, lat); });
}
}  // namespace

std::vector<fs::path> model_files(const fs::path& given) {
  if (given.extension() == ".vrt") {
    throw Error("--terrain: " + given.string() +
                " is a VRT, which may read any file: give the tiles themselves, or their folder");
  }
  if (!fs::is_directory(given)) {
    return {given};
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(given)) {
    if (entry.is_regular_file() && may_be_model(entry.path())) {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    throw Error("--terrain: the folder " + given.string() +
                " holds no elevation model (.tif, .hgt, .dt1, .asc, …)");
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool Tile::is_geographic() const { return frame.crs().rfind(kLonLat, 0) == 0; }

bool Tile::holds(double lon, double lat) const {
  if (std::abs(lat) > 90 || std::abs(lon) > 360) {
    return false;
  }
  try {
    const auto [x, y] = frame.to_local(lon, lat);
    return x >= bounds.min.x() && x <= bounds.max.x() && y >= bounds.min.y() && y <= bounds.max.y();
  } catch (const Error&) {
    return false;  // so far away that its projection fails
  }
}

std::string files_text(const Tile& tile) {
  std::string tiles;
  for (const fs::path& file : tile.more) {
    tiles += (tiles.empty() ? ", tiles: [" : ", ") + exact_json_text(file.string());
  }
  return "file: " + exact_json_text(tile.file.string()) + (tiles.empty() ? "" : tiles + "]");
}

std::unique_ptr<Environment> build_model(const Tile& tile, const Site& site, Registry& registry,
                                         const std::string& voids) {
  // The name has no folder that the file would be relative to.
  const Value parameters = parse_yaml("{" + files_text(tile) + ", voids: " + voids +
                                          (tile.crs.empty() ? "" : ", crs: " + tile.crs) + "}",
                                      "terrain");
  return registry.get("environment", "terrain").environment(&parameters, site);
}

std::string terrain_entry(const Tile& tile, const std::string& file) {
  return "  - terrain: {file: " + exact_json_text(file) +
         (tile.crs.empty() ? "" : ", crs: " + tile.crs) +
         ", voids: neighbours}\n    id: " + exact_json_text(tile.file.filename().string()) + "\n";
}

Tile read_tile(const fs::path& file, const std::string& crs, Registry& registry) {
  Tile tile;
  tile.file = file;
  try {
    try {
      const Tile found = probe(tile, registry);
      if (!crs.empty()) {  // refused unless it is the model's own
        tile.crs = crs;
        probe(tile, registry);
      }
      return found;
    } catch (const ParameterError& error) {
      if (error.key() != "crs" || !tile.crs.empty()) {
        throw;
      }
      tile.crs = crs.empty() ? kLonLat : crs;
      return probe(tile, registry);
    }
  } catch (const PluginError&) {
    throw;
  } catch (const ConfigError& error) {
    throw Error(error.problems().front().message);
  } catch (const ParameterError& error) {
    const bool is_guessed = error.key() == "crs" && crs.empty();
    throw Error(error.what() +
                std::string(is_guessed
                                ? ": the file names no coordinate system: give --crs EPSG:CODE"
                                : ""));
  }
}

std::vector<Tile> read_tiles(const RouteWish& wish, Registry& registry) {
  std::vector<Tile> tiles;
  std::set<fs::path> read;
  for (const fs::path& given : wish.terrain) {
    for (const fs::path& file : model_files(given)) {
      if (read.insert(fs::weakly_canonical(file)).second) {
        try {
          tiles.push_back(read_tile(file, wish.crs.value_or(""), registry));
        } catch (const PluginError&) {
          throw;
        } catch (const Error& error) {
          throw Error(std::string("--terrain: ") + error.what());
        }
      }
    }
  }
  return tiles;
}

void drop_distant(std::vector<Tile>& tiles, const Frame& frame, const Box& reached) {
  std::erase_if(tiles, [&](const Tile& tile) {
    constexpr int kPoints = 8;
    Box box = Box::empty();
    for (int i = 0; i <= kPoints; ++i) {
      for (int j = 0; j <= kPoints; ++j) {
        const Vec3 size = tile.bounds.max - tile.bounds.min;
        const auto place = tile.frame.to_lonlat(tile.bounds.min.x() + size.x() * i / kPoints,
                                                tile.bounds.min.y() + size.y() * j / kPoints);
        const auto [x, y] = frame.to_local(place[0], place[1]);
        box = box.with({x, y, 0});
      }
    }
    return box.is_bounded() && box.intersected(reached).is_empty();
  });
}

std::vector<Tile> united(std::vector<Tile> tiles, Registry& registry) {
  if (tiles.size() < 2) {
    return tiles;
  }
  Tile all = tiles.front();
  for (auto tile = tiles.begin() + 1; tile != tiles.end(); ++tile) {
    if (tile->crs != all.crs) {
      return tiles;
    }
    all.more.push_back(tile->file);
  }
  try {
    return {probe(all, registry)};
  } catch (const ParameterError& error) {
    if (error.key() != "tiles" && error.key() != "max_posts") {
      throw;
    }
    return tiles;
  }
}

void expect_covered(const std::vector<Tile>& tiles, const WishedPoint& point) {
  const auto& [option, lon, lat, height] = point;
  const double usual = longitude_near(lon, 0);
  if (std::abs(lon) > 180 && is_held(tiles, lon, lat)) {
    throw Error(option + ": expected a longitude from -180 to 180, found " + with_digits(lon, 9) +
                ": give " + with_digits(usual, 9));
  }
  if (is_held(tiles, lon, lat)) {
    return;
  }
  const std::string what = option + ": longitude " + with_digits(lon, 9) + ", latitude " +
                           with_digits(lat, 9) + " is outside the elevation model";
  for (const auto& [x, y] : {std::pair(lat, lon),
                             {-lon, lat},
                             {lon, -lat},
                             {-lon, -lat},
                             {-lat, lon},
                             {lat, -lon},
                             {-lat, -lon}}) {
    if (is_held(tiles, x, y)) {
      const bool is_swapped = std::abs(x) == std::abs(lat) && std::abs(y) == std::abs(lon);
      throw Error(what + ", and " + lonlat(x, y) + " is inside: give longitude first" +
                  (is_swapped ? "" : ", west and south negative"));
    }
  }
  Box degrees = Box::empty();
  for (const Tile& tile : tiles) {
    const Box more = tile.frame.degrees(tile.bounds);
    const double west = more.min.x();
    const Vec3 east(degrees.is_empty() ? 0 : longitude_near(west, degrees.min.x()) - west, 0, 0);
    degrees = degrees.united({more.min + east, more.max + east});
  }
  const auto range = [](double low, double high) {
    return with_digits(low, 7) + " to " + with_digits(high, 7);
  };
  // The sides of a projected model are not meridians and parallels.
  const bool beside = degrees.contains(Vec3(lon, lat, degrees.min.z()));
  throw Error(what + ", which covers longitude " + range(degrees.min.x(), degrees.max.x()) +
              " and latitude " + range(degrees.min.y(), degrees.max.y()) +
              (beside ? " but not all of that: its sides, or those of its tiles, do not run along "
                        "meridians and parallels; give a point farther inside"
                      : ""));
}
}  // namespace altiplan::host
