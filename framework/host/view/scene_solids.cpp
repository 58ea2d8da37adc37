// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "altiplan/attributed.hpp"
#include "host/base/base64.hpp"
#include "host/base/words.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

using Role = Drawn::Role;
/// Beyond this number, the boxes of one layer and role are passed as a block of numbers.
constexpr std::size_t kFewBoxes = 200;

const char* name(Role role) {
  switch (role) {
    case Role::keep_out:
      return "keep_out";
    case Role::keep_in:
      return "keep_in";
    case Role::threat:
      return "threat";
    case Role::unknown:
      return "unknown";
    case Role::obstacle:
      break;
  }
  return "obstacle";
}

Json rounded(const std::array<double, 2>& p) { return {host::rounded(p[0]), host::rounded(p[1])}; }

Json ring_json(const std::vector<std::array<double, 2>>& ring) {
  Json json = Json::array();
  for (const auto& p : ring) {
    json.push_back(rounded(p));
  }
  return json;
}

struct ShapeWriter {
  Json& json;

  void operator()(const Sphere& sphere) const {
    json["shape"] = "sphere";
    json["at"] = host::rounded(sphere.centre);
    json["radius"] = host::rounded(sphere.radius);
  }
  void operator()(const Cylinder& cylinder) const {
    json["shape"] = "cylinder";
    json["at"] = rounded(std::array{cylinder.x, cylinder.y});
    json["radius"] = host::rounded(cylinder.radius);
    heights(cylinder.floor, cylinder.ceiling);
  }
  void operator()(const BoxShape& shape) const {
    json["shape"] = "box";
    json["min"] = host::rounded(shape.box.min);
    json["max"] = host::rounded(shape.box.max);
  }
  void operator()(const Prism& prism) const {
    json["shape"] = "prism";
    json["outline"] = ring_json(prism.outline);
    json["holes"] = Json::array();
    for (const auto& hole : prism.holes) {
      json["holes"].push_back(ring_json(hole));
    }
    heights(prism.floor, prism.ceiling);
  }
  void heights(double floor, double ceiling) const {
    json["floor"] = host::rounded(floor);
    json["ceiling"] = host::rounded(ceiling);
  }
};

/// A layer or moving obstacle as it is between two events.
struct Stay {
  std::optional<Layer> layer;
  std::optional<MovingObstacle> moving;
  Vec3 carried{0, 0, 0};  ///< by events, since the layer was built
  std::optional<std::size_t> added_by;
  std::optional<std::size_t> removed_by;

  const std::string& id() const { return layer ? layer->id : moving->id; }
};

Json index_json(const std::optional<std::size_t>& index) {
  return index ? Json(*index) : Json(nullptr);
}

/// The properties common to all parts of a layer.
Json part_json(const Stay& stay, Role role, const std::string& text) {
  return {{"layer", stay.id()},
          {"role", name(role)},
          {"known", stay.layer->known},
          {"name", text},
          {"added_by", index_json(stay.added_by)},
          {"removed_by", index_json(stay.removed_by)}};
}

/// Clipped to `whole` where a box is unbounded.
Json packed_boxes(Json part, const std::vector<Box>& boxes, const Box& whole) {
  std::vector<float> corners;
  corners.reserve(6 * boxes.size());
  for (const Box& any : boxes) {
    const Box box = any.is_bounded() ? any : any.intersected(whole);
    for (const Vec3& corner : {box.min, box.max}) {
      corners.insert(corners.end(), {float(corner.x()), float(corner.y()), float(corner.z())});
    }
  }
  part["count"] = boxes.size();
  part["data"] = base64_of(corners);
  return part;
}

Drawing drawing_of(const Layer& layer, const Box& box, SceneNotes& notes) {
  return attributed(
      [&] {
        return "the environment '" + layer.plugin + "' (" + layer.id +
               "), when asked for its drawing,";
      },
      [&] {
        const std::optional<Drawing> drawing = layer.environment->drawing();
        return drawing ? *drawing : drawing_by_cells(layer, box, notes);
      });
}

void draw_layer(Json& scene, const Stay& stay, const Box& box, SceneNotes& notes) {
  const Drawing drawing = drawing_of(*stay.layer, box, notes);
  std::map<Role, std::vector<Box>> boxes;
  for (const Drawn& drawn : drawing.shapes) {
    if (const auto* shape = std::get_if<BoxShape>(&drawn.shape)) {
      boxes[drawn.role].push_back(std::get<BoxShape>(moved(*shape, stay.carried)).box);
    }
  }
  for (const auto& [role, all] : boxes) {
    if (all.size() > kFewBoxes) {
      scene["boxes"].push_back(packed_boxes(part_json(stay, role, ""), all, box));
    }
  }
  for (const Drawn& drawn : drawing.shapes) {
    if (std::holds_alternative<BoxShape>(drawn.shape) && boxes[drawn.role].size() > kFewBoxes) {
      continue;
    }
    Json solid = part_json(stay, drawn.role, drawn.name);
    std::visit(ShapeWriter{solid}, moved(drawn.shape, stay.carried));
    scene["solids"].push_back(std::move(solid));
  }
  if (!drawing.triangles.empty()) {
    std::vector<float> corners;
    for (const auto& triangle : drawing.triangles) {
      for (const Vec3& corner : triangle) {
        const Vec3 at = corner + stay.carried;
        corners.insert(corners.end(), {float(at.x()), float(at.y()), float(at.z())});
      }
    }
    Json mesh = part_json(stay, Role::obstacle, "");
    mesh["triangles"] = base64_of(corners);
    scene["meshes"].push_back(std::move(mesh));
  }
}

Json moving_json(const Stay& stay) {
  const MovingObstacle& moving = *stay.moving;
  Json json{{"id", moving.id},
            {"layer", moving.id},
            {"role", name(Role::obstacle)},
            {"known", moving.known},
            {"since_s", moving.since_s},
            {"velocity", host::rounded(moving.velocity)},
            {"added_by", index_json(stay.added_by)},
            {"removed_by", index_json(stay.removed_by)}};
  std::visit(ShapeWriter{json}, moved(moving.shape, stay.carried));
  return json;
}

/// Everything that ever exists: each thing once, and once more for each event that changes it.
class Stays {
 public:
  explicit Stays(const World& truth) {
    for (const Layer& layer : truth.layers()) {
      all_.push_back({layer, {}, {0, 0, 0}, {}, {}});
    }
    for (const MovingObstacle& moving : truth.moving()) {
      all_.push_back({{}, moving, {0, 0, 0}, {}, {}});
    }
  }

  void meet(const FlightEvent& event, std::size_t index) {
    using Kind = FlightEvent::Kind;
    if (event.kind == Kind::add) {
      all_.push_back({event.layer, event.moving, {0, 0, 0}, index, {}});
    } else if (event.changes_world()) {
      const auto found = std::find_if(all_.begin(), all_.end(), [&](const Stay& stay) {
        return stay.id() == event.id && !stay.removed_by;
      });
      if (found == all_.end()) {
        return;  // reported by the flight
      }
      found->removed_by = index;
      Stay next = *found;
      next.added_by = index;
      next.removed_by.reset();
      if (event.kind == Kind::move) {
        next.carried += event.vector;
        all_.push_back(std::move(next));
      } else if (event.kind == Kind::set_cells && next.layer) {
        next.layer = event.edit ? event.edit(*next.layer) : event.layer.value();
        all_.push_back(std::move(next));
      }
    }
  }

  const std::vector<Stay>& all() const { return all_; }

 private:
  std::vector<Stay> all_;
};

std::string event_text(const FlightEvent& event) {
  using Kind = FlightEvent::Kind;
  switch (event.kind) {
    case Kind::add:
      return event.id + " appears";
    case Kind::remove:
      return event.id + " is gone";
    case Kind::move:
      return event.id + " moves by " + place(event.vector) + " m";
    case Kind::set_cells:
      return "cells of " + event.id + " change";
    case Kind::visit:
      return "a target appears at " + place(event.target.at);
    case Kind::move_goal:
      break;
  }
  return "the goal moves to " + place(event.vector);
}
}  // namespace

void add_solids(Json& scene, const Mission& mission, const std::vector<FlightEvent>& events,
                const Box& box, SceneNotes& notes) {
  // By time; events triggered by the vehicle come last, as their time is unknown.
  std::vector<std::size_t> order(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    order[i] = i;
    scene["events"].push_back({{"text", event_text(events[i])}});
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return events[a].at_s.value_or(kInfinity) < events[b].at_s.value_or(kInfinity);
  });
  Stays stays(mission.truth);
  for (const std::size_t i : order) {
    stays.meet(events[i], i);
  }
  for (const Stay& stay : stays.all()) {
    if (stay.layer) {
      draw_layer(scene, stay, box, notes);
    } else {
      scene["moving"].push_back(moving_json(stay));
    }
  }
}
}  // namespace altiplan::host
