// SPDX-License-Identifier: Apache-2.0
#include "host/flight_world.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

/// A layer carried elsewhere: asks the layer as it stood, at the place carried back.
class Carried final : public Environment {
 public:
  Carried(std::shared_ptr<const Environment> original, const Vec3& by)
      : original_(std::move(original)), by_(by) {}

 private:
  Box do_bounds() const override {
    const Box box = original_->bounds();
    return {box.min + by_, box.max + by_};
  }
  double do_clearance(const Vec3& p) const override { return original_->clearance(p - by_); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return original_->blocked(a - by_, b - by_, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    original_->near(p - by_, reach, [&](const Nearby& nearby) {
      Nearby carried = nearby;
      carried.point += by_;
      sink(carried);
    });
  }
  bool do_has_ground() const override { return original_->has_ground(); }
  std::optional<double> do_ground(double x, double y) const override {
    const auto ground = original_->ground(x - by_.x(), y - by_.y());
    return ground ? std::optional(*ground + by_.z()) : std::nullopt;
  }
  double do_ground_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return original_->ground_gap(a - by_, b - by_, enough);
  }
  double do_ground_gap_max(const Vec3& a, const Vec3& b) const override {
    return original_->ground_gap_max(a - by_, b - by_);
  }
  std::vector<Threat> do_threats() const override {
    std::vector<Threat> threats = original_->threats();
    for (Threat& threat : threats) {
      threat.centre += by_;
    }
    return threats;
  }
  double do_slack() const override { return original_->slack(); }

  std::shared_ptr<const Environment> original_;
  Vec3 by_;
};

/// A sphere that covers the shape as far as it matters at the height of p: tall solids are taken
/// at that height, where a sphere around the whole of them would be of any size.
SensedObstacle as_sphere(const MovingObstacle& obstacle, const Vec3& p, double time_s) {
  SensedObstacle seen{obstacle.id, {0, 0, 0}, 0, obstacle.velocity};
  const Shape shape = obstacle.at(time_s);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    seen.position = sphere->centre;
    seen.radius = sphere->radius;
    return seen;
  }
  const Box box = bounds(shape);
  seen.position = (box.min + box.max) / 2;
  seen.position.z() = std::clamp(p.z(), box.min.z(), box.max.z());
  const Vec3 size = box.max - box.min;
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  seen.radius = cylinder != nullptr ? cylinder->radius : std::hypot(size.x(), size.y()) / 2;
  return seen;
}

std::vector<MovingObstacle>::iterator find(std::vector<MovingObstacle>& moving,
                                           const std::string& id) {
  return std::find_if(moving.begin(), moving.end(),
                      [&](const MovingObstacle& obstacle) { return obstacle.id == id; });
}
}  // namespace

FlightWorld::FlightWorld(const FlightSetup& setup)
    : truth_(setup.truth),
      known_(setup.request.world),
      sensing_m_(setup.request.vehicle.sensing_m) {}

void FlightWorld::apply(const FlightEvent& event, double time_s) {
  using Kind = FlightEvent::Kind;
  std::vector<MovingObstacle> moving = truth_.moving();
  if (event.kind == Kind::add && event.moving) {
    moving.push_back(*event.moving);
    truth_ = truth_.with_moving(std::move(moving));
  } else if (event.kind == Kind::add) {
    truth_ = truth_.with(event.layer.value());
  } else if (event.kind == Kind::set_cells) {
    truth_ = truth_.with_replaced(event.layer.value());
    const Box whole = event.layer->environment->bounds();
    const Box box = event.box.is_bounded() ? event.box : whole;
    const auto [known, is_new] =
        set_cells_.try_emplace(event.id, Change{Change::Kind::set_cells, event.id, box});
    if (!is_new) {
      known->second.box = known->second.box.united(box);
    }
  } else if (event.kind == Kind::move) {
    move(event, time_s);
  } else if (truth_.find(event.id) != nullptr) {
    truth_ = truth_.without(event.id);
  } else if (const auto found = find(moving, event.id); found != moving.end()) {
    moving.erase(found);
    truth_ = truth_.with_moving(std::move(moving));
  } else {
    throw Error("event remove: there is no layer or moving obstacle '" + event.id + "' then");
  }
  if (event.known || (event.layer && event.layer->known && event.kind == Kind::add) ||
      (event.moving && event.moving->known)) {
    told_.insert(event.id);
  }
}

void FlightWorld::move(const FlightEvent& event, double) {
  std::vector<MovingObstacle> moving = truth_.moving();
  if (const Layer* layer = truth_.find(event.id)) {
    Layer carried = *layer;
    carried.environment = std::make_shared<Carried>(layer->environment, event.vector);
    truth_ = truth_.with_replaced(std::move(carried));
  } else if (const auto found = find(moving, event.id); found != moving.end()) {
    found->shape = moved(found->shape, event.vector);
    truth_ = truth_.with_moving(std::move(moving));
  } else {
    throw Error("event move: there is no layer or moving obstacle '" + event.id + "' then");
  }
}

std::vector<Change> FlightWorld::sense(const Vec3& p, double time_s) {
  std::vector<Change> changes;
  World now = *known_;
  for (const Layer& layer : truth_.layers()) {
    const Layer* old = known_->find(layer.id);
    if (old != nullptr && old->environment == layer.environment) {
      continue;
    }
    if (told_.count(layer.id) == 0 && !sees(*layer.environment, p) &&
        !(old != nullptr && sees(*old->environment, p))) {
      continue;
    }
    Layer seen = layer;
    seen.known = true;
    const Box box = layer.environment->bounds();
    if (old == nullptr) {
      now = now.with(std::move(seen));
      changes.push_back({Change::Kind::add, layer.id, box});
    } else {
      now = now.with_replaced(std::move(seen));
      const auto cells = set_cells_.find(layer.id);
      changes.push_back(cells != set_cells_.end() ? cells->second
                                                  : Change{Change::Kind::move, layer.id,
                                                           box.united(old->environment->bounds())});
      set_cells_.erase(layer.id);
    }
    fresh_.insert(layer.id);
  }
  for (const Layer& old : known_->layers()) {
    if (truth_.find(old.id) == nullptr && (told_.count(old.id) > 0 || sees(*old.environment, p))) {
      now = now.without(old.id);
      changes.push_back({Change::Kind::remove, old.id, old.environment->bounds()});
      fresh_.erase(old.id);
    }
  }
  if (!changes.empty()) {
    known_ = std::make_shared<const World>(std::move(now));
  }
  sense_moving(p, time_s);
  return changes;
}

void FlightWorld::sense_moving(const Vec3& p, double time_s) {
  const std::vector<MovingObstacle>& old = known_->moving();
  std::vector<MovingObstacle> now;
  bool differs = false;
  for (const MovingObstacle& obstacle : truth_.moving()) {
    const auto was = std::find_if(old.begin(), old.end(), [&](const MovingObstacle& other) {
      return other.id == obstacle.id;
    });
    if (was != old.end() || told_.count(obstacle.id) > 0 ||
        signed_distance(obstacle.at(time_s), p) <= sensing_m_) {
      now.push_back(obstacle);
      now.back().known = true;
      differs = differs || was == old.end() ||
                signed_distance(was->at(time_s), p) != signed_distance(obstacle.at(time_s), p);
    }
  }
  if (differs || now.size() != old.size()) {
    known_ = std::make_shared<const World>(known_->with_moving(std::move(now)));
  }
}

const std::vector<SensedObstacle>& FlightWorld::sensed(const Vec3& p, double time_s) {
  sensed_.clear();
  for (const MovingObstacle& obstacle : known_->moving()) {
    sensed_.push_back(as_sphere(obstacle, p, time_s));
  }
  return sensed_;
}

const std::string* FlightWorld::contact(const Vec3& a, double t0, const Vec3& b, double t1,
                                        double radius) const {
  if (const Layer* layer = truth_.blocked_by(a, b, radius)) {
    return &layer->id;
  }
  for (const MovingObstacle& obstacle : truth_.moving()) {
    if (hits(obstacle, a, t0, b, t1, radius)) {
      return &obstacle.id;
    }
  }
  return nullptr;
}

double FlightWorld::separation_below(double least, const Vec3& a, double t0, const Vec3& b,
                                     double t1) const {
  const double run = (b - a).norm();
  for (const Layer& layer : truth_.layers()) {
    if (layer.environment->clearance(a) - run < least) {
      least = std::min(least, std::max(0.0, leg_clearance(*layer.environment, a, b)));
    }
  }
  for (const MovingObstacle& obstacle : truth_.moving()) {
    least = std::min(least, separation(obstacle, a, t0, b, t1));
  }
  return least;
}
}  // namespace altiplan::host
