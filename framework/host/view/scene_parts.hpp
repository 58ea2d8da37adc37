// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "altiplan/body.hpp"
#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "host/mission/mission.hpp"
#include "host/run/run_result.hpp"
#include "host/view/scene.hpp"

// The parts of a scene, one file each.

namespace altiplan::host {

/// Of the format.
inline constexpr int kSceneVersion = 1;

/// Notes about simplifications, each once.
class SceneNotes {
 public:
  void add(const std::string& line);
  /// A note that the user should see without opening the scene.
  void warn(const std::string& line);
  const std::vector<std::string>& lines() const { return lines_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> lines_;
  std::vector<std::string> warnings_;
};

/// Rounded to millimetres, fine enough for a picture; null if the number is not finite.
Json rounded(double value);
Json rounded(const std::optional<double>& value);
Json rounded(const Vec3& p);

/// As high as voids are filled over which nothing may fly: shown as the holes that they are.
inline constexpr double kClosedGround = 10'000;

/// The world's ground within the box, or null: an elevation model by its own posts, every n-th if
/// there are too many; any other ground by a regular grid.
Json ground_json(const World& world, const Box& box, SceneNotes& notes);

/// The box to show: the volume and all routes and tracks, never flat.
Box scene_box(const Mission& mission, const std::vector<StoredResult>& results);

/// A route with room around it.
Box box_about(const Route& route);

/// Thousands of zones of a country would fill the file.
void drop_what_is_beside(Json& scene, const Box& box);

/// Everything in a world, without results.
Json world_scene(const std::string& title, const Mission& mission,
                 const std::vector<FlightEvent>& events, const Box& box, SceneNotes& notes);

/// `start`, `goal`, `via` and `loiters`.
Json ends_scene(const Mission& mission);

/// `solids`, `boxes`, `meshes`, `moving` and `events`: everything in the world but its ground.
Json obstacles_scene(const Mission& mission, const std::vector<FlightEvent>& events, const Box& box,
                     SceneNotes& notes);

/// Adds `solids`, `boxes`, `meshes`, `moving` and `events` to the scene: everything in the world,
/// static or moving, and its changes.
void add_solids(Json& scene, const Mission& mission, const std::vector<FlightEvent>& events,
                const Box& box, SceneNotes& notes);

/// The parts of a body, each the triangles of its surface.
Json body_json(const Body& body);
/// Where the body is along the route, and where it comes nearest to obstacles.
Json body_places_json(const Route& route, const Request& request, const std::string& whose,
                      SceneNotes& notes);

/// A layer without a drawing, cut into cells: the space that it blocks within the box, slightly too
/// large rather than missing thin parts.
Drawing drawing_by_cells(const Layer& layer, const Box& box, SceneNotes& notes);

/// The clearance of a point from the layers of each kind (their plugin), as for the judge, within 1
/// mm.
std::map<std::string, double> clearances(const World& world, const Vec3& p);

/// The clearance part of a profile: `clearance`, and `to`, an array for each kind of layer, null if
/// there is none.
class ClearanceProfile {
 public:
  void add(const std::map<std::string, double>& each);
  void write(Json& profile) const;

 private:
  std::size_t count_ = 0;
  Json clearance_ = Json::array();
  Json to_ = Json::object();
};

/// How much of a result is shown, and who has judged it.
struct SceneDetail {
  std::size_t samples = 300;  ///< of each profile
  /// With the heights that layers fill, and where a route may pass; with the places of the least
  /// clearances; and the profile of a flight. Without, a scene takes a tenth of the time, and has
  /// no more samples than that.
  bool heights = true;
  /// The run that has just made the result, in this world and this process: its verdicts hold, and
  /// nothing is judged again.
  const RunResult* judged = nullptr;
};

/// The profile of a route along its length, sampled at its waypoints, evenly between them, and at
/// its minimum clearance from each kind of layer and minimum height above ground; as many points as
/// `detail` has samples unless it has more waypoints.
Json route_profile(const Route& route, const Request& request, const SceneDetail& detail);

/// The heights that each layer but the ground fills along a profile: `solid`, above and below the
/// vehicle, and `beside`, there or within `beside_m` of it to either side. Within half a metre; at
/// each sample a list of [low, high].
class SolidProfile {
 public:
  SolidProfile(const std::array<double, 2>& heights, double beside_m)
      : heights_(heights), beside_m_(beside_m) {}
  /// The next sample, at p, where the vehicle moves along `ahead`.
  void add(const World& world, const Vec3& p, const Vec3& ahead);
  void write(Json& profile) const;

 private:
  std::array<double, 2> heights_;
  double beside_m_;
  std::size_t count_ = 0;
  std::map<std::string, std::map<std::size_t, std::array<Json, 2>>> layers_;
};

/// For a profile that has its `altitude` and `ground`.
SolidProfile solid_profile(const Json& profile, const Box& volume);

/// Adds to a route's profile, at each sample: `lowest` and `highest`, the limits of the allowed
/// heights around the route's own or nearest to it, null where there is none nearby, within half a
/// metre; and its SolidProfile.
void add_heights(Json& profile, const Request& request);

/// The limits on routes, null if there are none.
Json limits_json(const Request& request);

/// The stored flight, judged now, its track thinned to what is visible.
Json flight_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, const SceneDetail& detail,
                  SceneNotes& notes);

/// The search as recorded in its trace, thinned evenly, or null. `progress` gets the share read.
Json trace_scene(const StoredResult& stored, SceneNotes& notes,
                 const std::function<void(double share)>& progress);

/// Copies keys of a stored result. Throws a Json::exception if one is missing, or is not a text.
void copy_texts(Json& to, const Json& from, std::initializer_list<const char*> keys);
/// The metrics, or null; throws a Json::exception if one of them is neither a number nor null.
Json metrics_scene(const Json& metrics);

/// Replaces the stored status by the one that the judge finds now, unless only the run can know it.
/// `judged` is null, or gives both if they differ; the message then adds `why`.
void set_status(Json& shown, const std::string& file, const std::string& now,
                const std::string& why);
/// The stored metrics, updated with those measured now.
Json metrics_now(const Json& stored, const Json& now);
/// The status of a route with that verdict.
std::string status_of(const CheckResult& check);
/// The message of the first violation; "" if there is none.
std::string first_found(const CheckResult& check);

/// A verdict with at most a readable number of violations; throws a Json::exception if malformed.
Json check_scene(Json check, const std::string& whose, SceneNotes& notes);

/// One result: from the stored file what only the run can know, its routes and its flight judged
/// now, and its profile in the known world; without its trace.
Json result_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, const SceneDetail& detail,
                  SceneNotes& notes);
}  // namespace altiplan::host
