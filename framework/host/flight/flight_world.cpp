// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_world.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"

namespace altiplan::host {
namespace {

/// A displaced layer: queries the original at the position shifted back.
class Carried final : public Environment, public Ground {
 public:
  Carried(std::shared_ptr<const Environment> original, const Vec3& by)
      : original_(std::move(original)), ground_(original_->ground()), by_(by) {
    info_.threats = original_->info().threats;
    for (Threat& threat : info_.threats) {
      threat.centre += by_;
    }
  }

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
  double do_over_approximation() const override { return original_->over_approximation(); }
  const LayerInfo& do_info() const override { return info_; }

  const Ground* do_ground() const override { return ground_ != nullptr ? this : nullptr; }
  std::optional<double> do_height(double x, double y) const override {
    const auto height = ground_->height(x - by_.x(), y - by_.y());
    return height ? std::optional(*height + by_.z()) : std::nullopt;
  }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return ground_->gap(a - by_, b - by_, enough);
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return ground_->gap_max(a - by_, b - by_);
  }
  double do_slope(const Box& box) const override {
    return ground_->slope({box.min - by_, box.max - by_});
  }

  std::shared_ptr<const Environment> original_;
  const Ground* ground_;  ///< of the original, or null
  Vec3 by_;
  LayerInfo info_;  ///< only its threats
};

/// A sphere that covers the relevant part of the shape: tall solids are cut at the height of p,
/// since a sphere around all of them could be of any size.
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

template <class Obstacles>
auto find(Obstacles& moving, const std::string& id) {
  return std::find_if(moving.begin(), moving.end(),
                      [&](const MovingObstacle& obstacle) { return obstacle.id == id; });
}
/// Minimum signed distance of that flight from the obstacle's surface: minus the depth inside it.
double signed_separation(const MovingObstacle& obstacle, const Vec3& a, double t0, const Vec3& b,
                         double t1) {
  const double outside = separation(obstacle, a, t0, b, t1);
  if (outside > 0) {
    return outside;
  }
  // Relative to the obstacle, the flight is a straight leg as well.
  const Shape shape = obstacle.at(t0);
  const Vec3 end = b - obstacle.velocity * (t1 - t0);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return leg_distance(Sphere{sphere->centre, 0}, a, end) - sphere->radius;
  }
  return leg_clearance(kit::ShapeLayer({shape}), a, end);
}
}  // namespace

FlightWorld::FlightWorld(const FlightSetup& setup)
    : truth_(setup.truth),
      known_(setup.request.world),
      sensing_m_(setup.request.vehicle.sensing_m) {}

void FlightWorld::apply(const FlightEvent& event) {
  measure_flown();
  using Kind = FlightEvent::Kind;
  std::vector<MovingObstacle> moving = truth_.moving();
  if (event.kind == Kind::add && event.moving) {
    moving.push_back(*event.moving);
    truth_ = truth_.with_moving(std::move(moving));
  } else if (event.kind == Kind::add) {
    truth_ = truth_.with(event.layer.value());
  } else if (event.kind == Kind::set_cells) {
    const Layer* old = truth_.find(event.id);
    if (old == nullptr) {
      throw Error("event set_cells: there is no layer '" + event.id + "' at that time");
    }
    const Layer layer = event.edit ? event.edit(*old) : event.layer.value();
    truth_ = truth_.with_replaced(layer);
    const Box whole = layer.environment->bounds();
    const Box box = event.box.is_bounded() ? event.box : whole;
    const auto [known, is_new] =
        set_cells_.try_emplace(event.id, Change{Change::Kind::set_cells, event.id, box});
    if (!is_new) {
      known->second.box = known->second.box.united(box);
    }
  } else if (event.kind == Kind::move) {
    move(event);
  } else if (truth_.find(event.id) != nullptr) {
    truth_ = truth_.without(event.id);
  } else if (const auto found = find(moving, event.id); found != moving.end()) {
    moving.erase(found);
    truth_ = truth_.with_moving(std::move(moving));
  } else {
    throw Error("event remove: there is no layer or moving obstacle '" + event.id +
                "' at that time");
  }
  if (event.known || (event.layer && event.layer->known && event.kind == Kind::add) ||
      (event.moving && event.moving->known)) {
    told_.insert(event.id);
  }
}

void FlightWorld::move(const FlightEvent& event) {
  std::vector<MovingObstacle> moving = truth_.moving();
  if (const Layer* layer = truth_.find(event.id)) {
    Layer carried = *layer;
    carried.environment = std::make_shared<Carried>(layer->environment, event.vector);
    truth_ = truth_.with_replaced(std::move(carried));
    set_cells_.erase(event.id);  // now the whole layer differs
  } else if (const auto found = find(moving, event.id); found != moving.end()) {
    found->shape = moved(found->shape, event.vector);
    truth_ = truth_.with_moving(std::move(moving));
  } else {
    throw Error("event move: there is no layer or moving obstacle '" + event.id + "' at that time");
  }
}

std::vector<Change> FlightWorld::sense(const Vec3& p, double time_s) {
  std::vector<Change> changes;
  const std::shared_ptr<const World> before = known_;
  for (const Layer& layer : truth_.layers()) {
    const Layer* old = before->find(layer.id);
    if (old != nullptr && old->environment == layer.environment) {
      continue;
    }
    if (told_.count(layer.id) > 0 || sees_difference(layer, old, p)) {
      changes.push_back(learn(layer, old));
    }
  }
  for (const Layer& old : before->layers()) {
    if (truth_.find(old.id) == nullptr && (told_.count(old.id) > 0 || sees(*old.environment, p))) {
      known_ = std::make_shared<const World>(known_->without(old.id));
      changes.push_back({Change::Kind::remove, old.id, old.environment->bounds()});
      fresh_.erase(old.id);
    }
  }
  sense_moving(p, time_s);
  told_.clear();
  return changes;
}

bool FlightWorld::sees_difference(const Layer& layer, const Layer* old, const Vec3& p) const {
  if (const auto cells = set_cells_.find(layer.id); old != nullptr && cells != set_cells_.end()) {
    const Box& box = cells->second.box;
    return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm() <= sensing_m_;
  }
  return sees(*layer.environment, p) || (old != nullptr && sees(*old->environment, p));
}

Change FlightWorld::learn(Layer layer, const Layer* old) {
  layer.known = true;
  Change change{Change::Kind::add, layer.id, layer.environment->bounds()};
  if (old != nullptr) {
    change.kind = Change::Kind::move;
    change.box = change.box.united(old->environment->bounds());
    if (const auto cells = set_cells_.find(layer.id); cells != set_cells_.end()) {
      change = cells->second;
    }
  }
  set_cells_.erase(layer.id);
  fresh_.insert(layer.id);
  known_ = std::make_shared<const World>(old == nullptr ? known_->with(std::move(layer))
                                                        : known_->with_replaced(std::move(layer)));
  return change;
}

void FlightWorld::sense_moving(const Vec3& p, double time_s) {
  const std::vector<MovingObstacle>& old = known_->moving();
  if (truth_.moving().empty() && old.empty()) {
    return;
  }
  const auto distance = [&](const MovingObstacle& obstacle) {
    return signed_distance(obstacle.at(time_s), p);
  };
  // An obstacle is seen at its position, and its absence at the expected position.
  const auto is_news = [&](const MovingObstacle& obstacle) {
    return told_.count(obstacle.id) > 0 || distance(obstacle) <= sensing_m_;
  };
  std::vector<MovingObstacle> now;
  bool differs = false;
  for (const MovingObstacle& obstacle : truth_.moving()) {
    const auto was = find(old, obstacle.id);
    const bool is_as_known = was != old.end() && distance(*was) == distance(obstacle);
    if (is_as_known || (was != old.end() && !is_news(*was) && !is_news(obstacle))) {
      now.push_back(*was);
    } else if (was != old.end() || is_news(obstacle)) {
      now.push_back(obstacle);
      now.back().known = true;
      differs = true;
    }
  }
  for (const MovingObstacle& was : old) {
    const bool is_gone = find(truth_.moving(), was.id) == truth_.moving().end();
    if (is_gone && is_news(was)) {
      differs = true;
    } else if (is_gone) {
      now.push_back(was);
    }
  }
  if (differs) {
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

const std::string* FlightWorld::contact(const std::optional<Approach>& before, const Vec3& a,
                                        double t0, const Vec3& b, double t1,
                                        const Request& request) const {
  const Vehicle& vehicle = request.vehicle;
  if (const Layer* layer = truth_.blocked_by(a, b, vehicle.radius_m)) {
    return &layer->id;
  }
  if (const Layer* layer = body_meets(before, Leg::straight(a, b), request)) {
    return &layer->id;
  }
  for (const MovingObstacle& obstacle : truth_.moving()) {
    if (hits(obstacle, a, t0, b, t1, vehicle.reach_m())) {
      return &obstacle.id;
    }
  }
  return nullptr;
}

double FlightWorld::separation_below(double min_distance, const Vec3& a, double t0, const Vec3& b,
                                     double t1) const {
  for (const Layer& layer : truth_.layers()) {
    if (const auto nearest = nearest_leg(*layer.environment, {a, b}, min_distance)) {
      min_distance = nearest->distance;
    }
  }
  for (const MovingObstacle& obstacle : truth_.moving()) {
    min_distance = std::min(min_distance, signed_separation(obstacle, a, t0, b, t1));
  }
  return min_distance;
}

void FlightWorld::flown(const Vec3& a, double t0, const Vec3& b, double t1) {
  if (flown_.empty()) {
    flown_.push_back(a);
  }
  flown_.push_back(b);
  for (const MovingObstacle& obstacle : truth_.moving()) {
    const double its = signed_separation(obstacle, a, t0, b, t1);
    if (its < separation_.distance) {
      separation_ = {legs_, its};
    }
  }
  ++legs_;
}

void FlightWorld::measure_flown() {
  if (flown_.empty()) {
    return;
  }
  const std::size_t first = legs_ - (flown_.size() - 1);
  for (const Layer& layer : truth_.layers()) {
    if (const auto nearest = nearest_leg(*layer.environment, flown_, separation_.distance)) {
      separation_ = {first + nearest->leg, nearest->distance};
    }
  }
  flown_.clear();
}

NearestLeg FlightWorld::separation() {
  measure_flown();
  return separation_;
}
}  // namespace altiplan::host
