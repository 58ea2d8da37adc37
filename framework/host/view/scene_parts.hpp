// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "host/mission/mission.hpp"
#include "host/view/scene.hpp"

// The parts that a scene is made of, a file each.

namespace altiplan::host {

/// Lines about what was simplified, each once.
class SceneNotes {
 public:
  void add(const std::string& line);
  /// A line that the user should see without opening the scene.
  void warn(const std::string& line);
  const std::vector<std::string>& lines() const { return lines_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> lines_;
  std::vector<std::string> warnings_;
};

/// Millimetres are as fine as a picture gets; null where the number is not finite.
Json rounded(double value);
Json rounded(const std::optional<double>& value);
Json rounded(const Vec3& p);

/// The world's ground within the box, or null: an elevation model by its own posts, every n-th
/// where there are too many of them; any other ground by a regular grid.
Json ground_json(const World& world, const Box& box, SceneNotes& notes);

/// A box that is worth seeing: the volume and all that was planned and flown, never flat.
Box scene_box(const Mission& mission, const std::vector<StoredResult>& results);

/// Adds to the scene `solids`, `boxes`, `meshes`, `moving` and `events`: all that stands, moves,
/// comes and goes in the world.
void add_solids(Json& scene, const Mission& mission, const std::vector<FlightEvent>& events,
                const Box& box, SceneNotes& notes);

/// A layer that does not say what it looks like, cut into cells: a picture of what it blocks within
/// the box, a little too large rather than without what is thin.
Drawing drawing_by_cells(const Layer& layer, const Box& box, SceneNotes& notes);

/// The clearance of a place from the layers of each kind (their plugin), as the judge has it,
/// within 1 mm.
std::map<std::string, double> clearances(const World& world, const Vec3& p);

/// The part of a profile that tells how near the route is to what: `clearance`, and `to`, an array
/// for each kind, null where there is none.
class ClearanceProfile {
 public:
  void add(const std::map<std::string, double>& each);
  /// The least that was added last.
  double least() const { return least_; }
  void write(Json& profile) const;

 private:
  std::size_t count_ = 0;
  double least_ = kInfinity;
  Json clearance_ = Json::array();
  Json to_ = Json::object();
};

/// A route in numbers, sampled at its waypoints, evenly between them, and where it comes nearest to
/// each kind of layer and lowest above the ground; `samples` of them unless it has more waypoints.
Json route_profile(const Route& route, const Request& request, std::size_t samples);

/// The stored flight, judged now, its track thinned to what can be seen, its profile to so many
/// samples.
Json flight_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, std::size_t samples, SceneNotes& notes);

/// The search as its trace tells it, thinned evenly, or null.
Json trace_scene(const StoredResult& stored, SceneNotes& notes);

/// Copies keys of a stored result. Throws a Json::exception where one is missing, or is no text.
void copy_texts(Json& to, const Json& from, std::initializer_list<const char*> keys);
/// The metrics, or null; throws a Json::exception where one of them is no number and not null.
Json metrics_scene(const Json& metrics);

/// Puts the status that the judge finds now in place of the stored one, unless that is one that
/// only the run can know. `judged` is null, or says both where they differ; the message then adds
/// why.
void set_status(Json& shown, const std::string& file, const std::string& now,
                const std::string& why);
/// The stored metrics with those measured now in their places.
Json metrics_now(const Json& stored, const Json& now);
/// The word for what the judge found of a route.
std::string status_of(const CheckResult& check);
/// The first of what the judge found; "" where it found nothing.
std::string first_found(const CheckResult& check);

/// A verdict with no more violations than can be read; throws a Json::exception where it is none.
Json check_scene(Json check, const std::string& whose, SceneNotes& notes);

/// One result: what the stored file says that only the run can know, its routes and its flight
/// judged now, and its profile, of so many samples, in the world that was known.
Json result_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, std::size_t samples, SceneNotes& notes);
}  // namespace altiplan::host
