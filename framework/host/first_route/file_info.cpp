// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/file_info.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"
#include "host/base/words.hpp"
#include "host/config/yaml.hpp"
#include "host/first_route/search.hpp"
#include "host/first_route/zones.hpp"
#include "host/import_export/route_format.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

/// Layers that an extension tells.
struct LayerKind {
  const char* ending;
  const char* plugin;
  const char* kind;
};
constexpr LayerKind kLayers[] = {{".3dmap", "voxel_map", "voxel map"},
                                 {".map", "grid_map", "grid map"},
                                 {".bt", "octomap", "octree"},
                                 {".ot", "octomap", "octree"},
                                 {".stl", "mesh", "mesh"},
                                 {".obj", "mesh", "mesh"},
                                 {".city.json", "city", "city model"},
                                 {".city.jsonl", "city", "city model"},
                                 {".csv", "city", "city model"}};

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The layer in a world of its own.
std::unique_ptr<Environment> build(const char* plugin, const fs::path& file,
                                   const std::string& parameters, Registry& registry,
                                   const Frame& frame = {}) {
  const World empty;
  Site site;
  site.frame = frame;
  site.before = &empty;
  // The name has no folder that the file would be relative to.
  const Value value =
      parse_yaml("{file: " + exact_json_text(file.string()) + parameters + "}", plugin);
  try {
    return registry.get("environment", plugin).environment(&value, site);
  } catch (const ConfigError& error) {
    throw Error(error.problems().front().message);
  }
}

std::string entry(const char* plugin, const fs::path& file, const std::string& parameters) {
  return std::string("  - ") + plugin + ": {file: " + exact_json_text(file.string()) + parameters +
         "}";
}

std::string corner(const Vec3& p) {
  return "[" + with_digits(p.x(), 8) + ", " + with_digits(p.y(), 8) + ", " + with_digits(p.z(), 6) +
         "]";
}

/// `volume` and `cell_m` for a layer that bounds them.
void add_volume(const Environment& layer, double spacing_m, FileInfo& info) {
  constexpr double kAbove = 200;
  Box box = layer.bounds();
  if (const Ground* ground = layer.ground(); ground != nullptr && ground->height_field()) {
    box.min.z() = std::floor(ground->height_field()->min_height());
    box.max.z() = std::ceil(ground->height_field()->max_height()) + kAbove;
  }
  if (box.is_empty() || !box.is_bounded()) {
    return;
  }
  for (int axis = 0; axis < 2; ++axis) {
    box.min[axis] = std::ceil(box.min[axis] * 10) / 10;
    box.max[axis] = std::floor(box.max[axis] * 10) / 10;
  }
  info.scenario.push_back("volume: {min_m: " + corner(box.min) + ", max_m: " + corner(box.max) +
                          "}");
  if (const auto& cells = layer.info().native_grid) {
    info.scenario.push_back("# planners use its own cells: cell_m: " + corner(cells->cell));
  } else {
    info.scenario.push_back("# planners: cell_m: " + open_cells({box, 0, spacing_m, 1}));
  }
}

FileInfo layer_info(const LayerKind& kind, const fs::path& file, Registry& registry) {
  const auto layer = build(kind.plugin, file, "", registry);
  FileInfo info{kind.kind, layer->info().notes, {"environment:", entry(kind.plugin, file, "")}};
  if (const auto& cells = layer->info().native_grid) {
    info.facts.push_back(std::to_string(cells->counts[0]) + " x " +
                         std::to_string(cells->counts[1]) + " x " +
                         std::to_string(cells->counts[2]) + " cells of its own");
  }
  add_volume(*layer, 0, info);
  return info;
}

FileInfo terrain_info(const fs::path& file, const std::string& crs, Registry& registry) {
  const Tile tile = read_tile(file, crs, registry);
  const std::string parameters =
      (tile.crs.empty() ? "" : ", crs: " + tile.crs) + ", voids: neighbours";
  FileInfo info{"elevation model", {}, {"environment:", entry("terrain", file, parameters)}};
  try {
    const auto layer = build("terrain", file, parameters, registry);
    info.facts = layer->info().notes;
    info.scenario.push_back("# frame, if not given: " + layer->info().frame->crs() +
                            ", origin at its south-west post");
    add_volume(*layer, tile.spacing_m, info);
  } catch (const Error& error) {  // too large to be read whole; a part about a flight may be
    const Box degrees = tile.frame.degrees(tile.bounds);
    info.facts = {tile.note,
                  "longitude " + with_digits(degrees.min.x(), 7) + " to " +
                      with_digits(degrees.max.x(), 7) + ", latitude " +
                      with_digits(degrees.min.y(), 7) + " to " + with_digits(degrees.max.y(), 7),
                  std::string("not read whole, but about a flight: ") + error.what()};
  }
  if (!tile.crs.empty()) {
    info.facts.push_back("names no coordinate system: read as " + tile.crs);
  }
  return info;
}

FileInfo zones_info(const fs::path& file, const formats::Airspace* airspace, Registry& registry) {
  const std::string parameters = zone_parameters(file, {});
  std::unique_ptr<Environment> layer;
  FileInfo info{airspace ? "published airspace" : "zones", {}, {}};
  try {
    layer = build("zones", file, parameters, registry);
    info.facts = layer->info().notes;
  } catch (const Error& error) {
    // Zones all over the Earth are read in any frame, and have none of their own.
    layer = build("zones", file, parameters, registry, Frame::local({0, 0}));
    info.facts = {error.what()};
  }
  if (airspace) {
    const std::vector<std::string> more = facts_of(*airspace);
    info.facts.insert(info.facts.end(), more.begin(), more.end());
  }
  if (const Box box = layer->bounds(); layer->info().frame && !box.is_empty()) {
    const Vec3 middle = (box.min + box.max) / 2;
    const auto [lon, lat] = layer->info().frame->to_lonlat(middle.x(), middle.y());
    if (std::isfinite(lon + lat)) {
      info.scenario.push_back("frame: {origin_lonlat: [" + with_digits(lon, 7) + ", " +
                              with_digits(lat, 7) + "]}  # without a terrain");
    }
  }
  info.scenario.insert(info.scenario.end(), {"environment:", entry("zones", file, parameters)});
  return info;
}

/// Footprints with heights are buildings.
FileInfo features_info(const fs::path& file, Registry& registry) {
  const formats::GeoJson json = formats::read_geojson(file.string());
  if (json.features.empty() && json.surroundings.empty() && !json.lines.empty()) {
    return info_of(read_mission_file(file.string()), file.string());
  }
  std::map<std::string, std::size_t> properties;
  for (const formats::GeoFeature& feature : json.features) {
    for (const auto& [name, value] : feature.properties) {
      ++properties[name];
    }
  }
  FileInfo info{
      "GeoJSON", {counted(json.features.size(), "polygon") + ", " + json.skipped_text()}, {}};
  if (properties.count("height") > 0) {
    info.kind = "buildings";
    info.scenario = {"environment:", entry("city", file, "")};
  } else if (!json.features.empty() || !json.surroundings.empty()) {
    info = zones_info(file, nullptr, registry);
  }
  std::string list;
  for (const auto& [name, count] : properties) {
    list += (list.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
  }
  if (!list.empty()) {
    info.facts.push_back("properties: " + list);
  }
  return info;
}

/// A text file is one of several kinds, which its content tells.
std::optional<FileInfo> text_info(const fs::path& file, Registry& registry) {
  std::string text;
  try {
    text = formats::read_file(file.string());
  } catch (const formats::InputError&) {
    return std::nullopt;  // too large for any of them
  }
  if (const auto airspace = formats::read_airspace(file.string(), text)) {
    return zones_info(file, airspace.get(), registry);
  }
  const std::string extension = formats::ending_of(file.string());
  if (extension != ".geojson" &&
      (holds_mission(file.string(), text) || extension == ".mission" || extension == ".wpml")) {
    return info_of(read_mission_file(file.string(), text), file.string());
  }
  if (extension == ".geojson" || extension == ".json") {
    return features_info(file, registry);
  }
  return std::nullopt;
}
}  // namespace

FileInfo info_of(const fs::path& file, const std::string& crs, Registry& registry) {
  if (const std::string why = formats::why_unreadable(file.string()); !why.empty()) {
    throw Error(file.string() + ": " + why);
  }
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return char(std::tolower(letter)); });
  if (ends_with(name, ".scen") || ends_with(name, ".3dscen")) {
    throw Error(file.string() +
                ": a set of scenarios (MovingAI, Warframe): studies read it (from)");
  }
  if (ends_with(name, ".vrt")) {
    throw Error(file.string() + ": is a VRT, which may read any file: give the tiles themselves");
  }
  const bool is_litchi_table =
      ends_with(name, ".csv") && holds_mission(file.string(), formats::read_file(file.string()));
  for (const LayerKind& kind : kLayers) {
    if (!is_litchi_table && ends_with(name, kind.ending)) {
      return layer_info(kind, file, registry);
    }
  }
  if (const std::optional<FileInfo> info = text_info(file, registry)) {
    return *info;
  }
  return terrain_info(file, crs, registry);
}
}  // namespace altiplan::host
