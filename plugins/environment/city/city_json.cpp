// SPDX-License-Identifier: Apache-2.0
// CityJSON (https://www.cityjson.org/specs): a city model as JSON, vertices by index; and
// CityJSONSeq, a line with the metadata, then a line with the vertices of each feature.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "altiplan/earth.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/polygon.hpp"
#include "altiplan/map_system.hpp"
#include "buildings.hpp"

namespace altiplan::city {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 64;
constexpr std::uintmax_t kAnySize = std::numeric_limits<std::uintmax_t>::max();

/// `before` lines of the file precede the text.
Json parse(const std::string& file, const std::string& text, std::size_t before = 0) {
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) {
      throw Error(file + ": lists and objects are nested more than " + std::to_string(kMaxDepth) +
                  " levels deep");
    }
    return true;
  };
  try {
    return Json::parse(text, shallow);
  } catch (const Json::parse_error& error) {
    const std::string read = text.substr(0, std::max<std::size_t>(error.byte, 1) - 1);
    const auto line = before + 1 + std::size_t(std::count(read.begin(), read.end(), '\n'));
    throw Error(file + ":" + std::to_string(line) + ":" +
                std::to_string(read.size() - read.rfind('\n')) +
                ": is not valid JSON: it ends early or has an error here");
  } catch (const Json::out_of_range&) {
    throw Error(file + ": contains a number that is too large (beyond 1.8e308)");
  }
}

/// Rings of vertices, the first the outline.
using Face = std::vector<std::vector<Vec3>>;

struct Model {
  std::vector<Vec3> vertices;

  Model(const Json& header, const Json& feature) {
    Vec3 scale(1, 1, 1);
    Vec3 translate(0, 0, 0);
    if (header.contains("transform")) {
      for (int axis = 0; axis < 3; ++axis) {
        scale[axis] = header["transform"].at("scale").at(std::size_t(axis)).get<double>();
        translate[axis] = header["transform"].at("translate").at(std::size_t(axis)).get<double>();
      }
    }
    for (const Json& vertex : feature.at("vertices").get_ref<const Json::array_t&>()) {
      const Vec3 v(vertex.at(0).get<double>(), vertex.at(1).get<double>(),
                   vertex.at(2).get<double>());
      vertices.push_back(translate + scale.cwiseProduct(v));
      if (!vertices.back().allFinite()) {
        throw Error("vertex " + std::to_string(vertices.size() - 1) + " is not finite");
      }
    }
  }

  Face face(const Json& rings) const {
    Face face;
    for (const Json& ring : rings.get_ref<const Json::array_t&>()) {
      face.emplace_back();
      for (const Json& index : ring.get_ref<const Json::array_t&>()) {
        if (!index.is_number_unsigned() || index.get<std::size_t>() >= vertices.size()) {
          throw Error("expected the index of one of the " + std::to_string(vertices.size()) +
                      " vertices, found " + index.dump());
        }
        face.back().push_back(vertices[index.get<std::size_t>()]);
      }
    }
    return face;
  }
};

/// The faces of a geometry, and those that its semantics declare as ground.
struct Surfaces {
  std::vector<Face> all;
  std::vector<Face> ground;

  Surfaces(const Model& model, const Json& geometry) {
    const Json* values = nullptr;
    const Json* kinds = nullptr;
    if (geometry.contains("semantics") && geometry["semantics"].is_object()) {
      values = &geometry["semantics"].at("values");
      kinds = &geometry["semantics"].at("surfaces");
    }
    const std::string type = geometry.at("type").get<std::string>();
    const int nested = type == "MultiSurface" || type == "CompositeSurface" ? 0
                       : type == "Solid"                                    ? 1
                       : type == "MultiSolid" || type == "CompositeSolid"   ? 2
                                                                            : -1;
    if (nested < 0) {
      throw Error("expected a geometry of surfaces or solids, found '" + type + "'");
    }
    add(model, geometry.at("boundaries"), nested, values, kinds);
  }

 private:
  void add(const Model& model, const Json& boundaries, int nested, const Json* values,
           const Json* kinds) {
    for (std::size_t n = 0; n < boundaries.size(); ++n) {
      const Json* value =
          values != nullptr && values->is_array() && n < values->size() ? &(*values)[n] : nullptr;
      if (nested > 0) {
        add(model, boundaries.at(n), nested - 1, value, kinds);
        continue;
      }
      all.push_back(model.face(boundaries.at(n)));
      if (value != nullptr && value->is_number_unsigned() &&
          kinds->at(value->get<std::size_t>()).at("type") == "GroundSurface") {
        ground.push_back(all.back());
      }
    }
  }
};

formats::Ring flat(const std::vector<Vec3>& ring) {
  formats::Ring result;
  for (const Vec3& p : ring) {
    result.push_back({p.x(), p.y()});
  }
  return formats::without_repeats(result);
}

double cross(const formats::Point2& o, const formats::Point2& p, const formats::Point2& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

/// A. M. Andrew's monotone chain.
formats::Ring convex_hull(formats::Ring points) {
  std::sort(points.begin(), points.end());
  formats::Ring hull;
  for (const int pass : {0, 1}) {
    const std::size_t kept = hull.size();
    for (const formats::Point2& p : points) {
      while (hull.size() >= kept + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    if (pass == 0) {
      std::reverse(points.begin(), points.end());
    }
  }
  return hull;
}

/// True if the prisms' plans contain p, or nearly.
bool covered(const std::vector<Prism>& prisms, const Vec3& p) {
  constexpr double kNearly = 0.1;  // metres: accuracy of the models
  return std::any_of(prisms.begin(), prisms.end(), [&](const Prism& prism) {
    return signed_distance(Shape(prism), {p.x(), p.y(), (prism.floor + prism.ceiling) / 2}) <
           kNearly;
  });
}

/// Prisms that enclose all of the geometry: over its ground, or over the hull of its plan if the
/// ground is not given or something protrudes.
std::vector<Prism> prisms_of(const Surfaces& surfaces) {
  double low = kInfinity;
  double high = -kInfinity;
  formats::Ring plan;
  for (const Face& face : surfaces.all) {
    for (const std::vector<Vec3>& ring : face) {
      for (const Vec3& p : ring) {
        low = std::min(low, p.z());
        high = std::max(high, p.z());
        plan.push_back({p.x(), p.y()});
      }
    }
  }
  if (!(low < high)) {
    throw Error("has no height");
  }
  std::vector<Prism> prisms;
  for (const Face& face : surfaces.ground) {
    formats::Polygon polygon{flat(face.at(0)), {}};
    for (std::size_t n = 1; n < face.size(); ++n) {
      polygon.holes.push_back(flat(face[n]));
    }
    if (!formats::polygon_problem(polygon).empty()) {
      prisms.clear();
      break;
    }
    prisms.push_back({polygon.outline, polygon.holes, low, high});
  }
  const bool complete = std::all_of(plan.begin(), plan.end(), [&](const formats::Point2& p) {
    return covered(prisms, {p[0], p[1], 0});
  });
  if (prisms.empty() || !complete) {
    prisms = {{convex_hull(plan), {}, low, high}};
    if (const std::string problem = formats::polygon_problem({prisms[0].outline, {}});
        !problem.empty()) {
      throw Error("has no plan: " + problem);
    }
  }
  return prisms;
}

/// The geometry of the highest level of detail.
const Json* finest(const Json& object) {
  const Json* best = nullptr;
  const auto lod = [](const Json& geometry) {
    const Json level = geometry.value("lod", Json(0));
    return level.is_string() ? level.get<std::string>() : level.dump();
  };
  if (object.contains("geometry")) {
    for (const Json& geometry : object["geometry"].get_ref<const Json::array_t&>()) {
      if (best == nullptr || lod(*best) < lod(geometry)) {
        best = &geometry;
      }
    }
  }
  return best;
}

void add_object(const Model& model, const std::string& name, const Json& object,
                Buildings& buildings) {
  const std::string type = object.at("type").get<std::string>();
  const Json* geometry = finest(object);
  if ((type != "Building" && type != "BuildingPart") || geometry == nullptr) {
    return;
  }
  for (Prism& prism : prisms_of(Surfaces(model, *geometry))) {
    buildings.list.push_back({name, std::move(prism)});
  }
}
}  // namespace

namespace {

/// The metadata, and what holds objects and their vertices: the same, or each line of CityJSONSeq.
struct Documents {
  Json header;
  std::vector<Json> features;

  const Json& feature(std::size_t n) const { return features.empty() ? header : features[n]; }
  std::size_t count() const { return std::max<std::size_t>(features.size(), 1); }
};

bool is_sequence(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end != text.npos && text.find("\"CityJSONFeature\"", end) != text.npos &&
         Json::accept(text.substr(0, end));
}

Documents documents_of(const std::string& file, const std::string& text) {
  if (!is_sequence(text)) {
    return {parse(file, text), {}};
  }
  Documents all;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string one = text.substr(begin, end - begin);
    begin = end + 1;
    if (one.find_first_not_of(" \t\r") == one.npos) {
      continue;
    }
    Json json = parse(file, one, line);
    if (line == 0) {
      all.header = std::move(json);
    } else if (json.is_object() && json.value("type", Json()) == "CityJSONFeature") {
      all.features.push_back(std::move(json));
    } else {
      throw Error(file + ": line " + std::to_string(line + 1) + ": expected a CityJSONFeature");
    }
  }
  return all;
}

/// "EPSG:7415" of "https://www.opengis.net/def/crs/EPSG/0/7415" and "urn:ogc:def:crs:EPSG::7415".
std::string definition_of(const std::string& reference) {
  const std::size_t digits = reference.find_last_not_of("0123456789") + 1;
  const bool is_compound = reference.find(",crs:") != reference.npos;
  return is_compound || reference.find("EPSG") == reference.npos || digits >= reference.size()
             ? reference
             : "EPSG:" + reference.substr(digits);
}

std::optional<MapSystem> system_of(const Json& header) {
  if (!header.contains("metadata") || !header["metadata"].contains("referenceSystem")) {
    return std::nullopt;
  }
  return MapSystem(definition_of(header["metadata"]["referenceSystem"].get<std::string>()));
}

/// A file without a coordinate system whose coordinates are stored more finely than a hundredth of
/// a millimetre, and are longitudes and latitudes if these are any.
void expect_metres(const Json& header, const std::vector<Model>& models) {
  constexpr double kFine = 1e-5;
  const bool is_fine =
      header.contains("transform") && header["transform"].at("scale").at(0).get<double>() < kFine;
  const auto is_place = [](const Vec3& v) {
    return std::abs(v.x()) <= 180 && std::abs(v.y()) <= 90;
  };
  if (is_fine && std::all_of(models.begin(), models.end(), [&](const Model& model) {
        return std::all_of(model.vertices.begin(), model.vertices.end(), is_place);
      })) {
    throw Error(
        "names no coordinate system (metadata.referenceSystem), and its coordinates look like "
        "longitude and latitude: expected the system, or metres");
  }
}

/// Brings vertices to local metres above sea level, or to metres of the file's own axes and heights
/// where the world has no frame.
class Placing {
 public:
  Placing(const std::optional<MapSystem>& system, bool has_origin, const Site& site)
      : system_(system), is_own_(has_origin) {
    if (!has_origin && site.frame.has_position()) {
      frame_ = site.frame;
      to_sea_level_ = true;
    }
  }

  bool is_in_frame() const { return frame_.has_position() && system_.has_value(); }
  std::string note() const {
    return "in " + system_->name() +
           (to_sea_level_ ? ", " + system_->heights() : ", heights as given");
  }

  /// Returns the frame that a file defines for the world whose own axes are in degrees, or in
  /// lengths that are wrong by more than half a per cent.
  std::optional<Frame> place(std::vector<Model>& models) {
    if (!system_) {
      return std::nullopt;
    }
    const bool defines = !frame_.has_position() && !is_true_to_scale(models);
    if (defines) {
      if (is_own_) {
        throw Error("is in " +
                    std::string(system_->unit_m() == 0 ? "degrees" : "lengths that are not true") +
                    " (" + system_->name() + "), where origin_m has no meaning");
      }
      std::vector<formats::Point2> places;
      for (const Model& model : models) {
        for (const Vec3& v : model.vertices) {
          const auto at = system_->to_wgs84({v.x(), v.y(), v.z()});
          places.push_back({at[0], at[1]});
        }
      }
      frame_ = formats::frame_around(places);
    }
    for (Model& model : models) {
      for (Vec3& v : model.vertices) {
        const auto [lon, lat, z] = system_->to_wgs84({v.x(), v.y(), v.z()});
        const double zero = to_sea_level_ ? 0 : system_->to_wgs84({v.x(), v.y(), 0})[2];
        v *= system_->unit_m();
        if (frame_.has_position()) {
          const auto local = frame_.to_local(lon, lat);
          v.head<2>() = Eigen::Vector2d(local[0], local[1]);
        }
        v.z() = z - zero;
      }
    }
    return defines ? std::optional(frame_) : std::nullopt;
  }

 private:
  /// As elevation models are held to: about the first vertex, along both axes.
  bool is_true_to_scale(const std::vector<Model>& models) const {
    constexpr double kMaxError = 0.005;
    constexpr double kStep = 100;  // of the system's units
    for (const Model& model : models) {
      if (model.vertices.empty()) {
        continue;
      }
      const Vec3& v = model.vertices.front();
      const auto place = [&](double east, double north) {
        const auto at = system_->to_wgs84({v.x() + east, v.y() + north, v.z()});
        return LonLat{at[0], at[1]};
      };
      const auto is_true = [&](const LonLat& to) {
        const double metres = geodesic_course(place(0, 0), to).metres;
        return std::abs(metres / (kStep * system_->unit_m()) - 1) <= kMaxError;
      };
      return system_->unit_m() > 0 && is_true(place(kStep, 0)) && is_true(place(0, kStep));
    }
    return system_->unit_m() > 0;
  }

  const std::optional<MapSystem>& system_;
  bool is_own_;
  bool to_sea_level_ = false;
  Frame frame_;
};
}  // namespace

bool is_city_json(const std::string& file) {
  const std::string text = formats::read_file(file, kAnySize);
  if (text.find("CityJSON") == text.npos) {
    return false;  // other files are parsed only by their own readers
  }
  const Json json = documents_of(file, text).header;
  return json.is_object() && json.contains("type") && json["type"] == "CityJSON";
}

Buildings read_city_json(const std::string& file,
                         const std::optional<std::array<double, 2>>& origin_m, const Site& site) {
  const Documents documents = documents_of(file, formats::read_file(file, kAnySize));
  Buildings buildings;
  std::size_t others = 0;
  std::string at = "it";
  std::optional<MapSystem> system;
  std::string note;
  bool is_placed = false;
  try {
    system = system_of(documents.header);
    std::vector<Model> models;
    for (std::size_t n = 0; n < documents.count(); ++n) {
      models.emplace_back(documents.header, documents.feature(n));
    }
    if (!system) {
      expect_metres(documents.header, models);
    }
    Placing placing(system, origin_m.has_value(), site);
    buildings.frame = placing.place(models);
    is_placed = placing.is_in_frame();
    note = system ? placing.note() : "";
    for (std::size_t n = 0; n < documents.count(); ++n) {
      for (const auto& [name, object] : documents.feature(n).at("CityObjects").items()) {
        at = "'" + name + "'";
        const std::size_t before = buildings.list.size();
        add_object(models[n], name, object, buildings);
        others += buildings.list.size() == before;
      }
    }
  } catch (const Json::exception& error) {
    const std::string why = error.what();  // "[json.exception.type_error.302] type must be …"
    throw Error(file + ": " + at +
                " violates the CityJSON format: " + why.substr(why.find("] ") + 2));
  } catch (const Error& error) {
    throw Error(file + ": " + at + ": " + error.what());
  }
  if (buildings.list.empty()) {
    throw Error(file + ": contains no building with a geometry");
  }
  buildings.notes = {std::to_string(buildings.list.size()) + " prisms, " + std::to_string(others) +
                     " objects without a geometry of their own, or no buildings, skipped"};
  if (system) {
    buildings.notes.push_back(note);
  }
  if (!is_placed) {
    Vec3 low = bounds(buildings.list.front().shape).min;
    for (const Building& building : buildings.list) {
      low = low.cwiseMin(bounds(building.shape).min);
    }
    const std::array<double, 2> origin = origin_m.value_or(std::array<double, 2>{low.x(), low.y()});
    for (Building& building : buildings.list) {
      building.shape = moved(building.shape, {-origin[0], -origin[1], 0});
    }
    buildings.notes.push_back("origin at " + std::to_string(origin[0]) + ", " +
                              std::to_string(origin[1]) + " of the file's metres");
  }
  return buildings;
}
}  // namespace altiplan::city
