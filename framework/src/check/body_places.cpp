// SPDX-License-Identifier: Apache-2.0
#include "altiplan/body_places.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>

#include "altiplan/nearest_place.hpp"
#include "body_judge.hpp"

namespace altiplan {
namespace {

/// Calls the visitor with each motion of the body and its leg.
template <class Visit>
void each_sweep(const Route& route, const Request& request, const Visit& visit) {
  if (request.vehicle.body == nullptr || route.empty()) {
    return;
  }
  std::optional<Approach> before = request.before_start(route.front());
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    for (Sweep& sweep : body_sweeps(before, leg, request)) {
      visit(leg, std::move(sweep));
    }
    before = onward(before, leg);
  }
}

std::vector<Placement> places_at(const Sweep& sweep, double t) {
  std::vector<Placement> places;
  sweep.place(t, places);
  return places;
}

/// Number of parts of a motion, at most `spacing` metres long; 1 if the body only rotates.
int part_count(const Leg& leg, const Sweep& sweep, double spacing) {
  const Vec3 from = places_at(sweep, 0).front().at;
  if (places_at(sweep, 0.5).front().at == from) {
    return 1;
  }
  const double length = leg.turns() ? leg.length() : (places_at(sweep, 1).front().at - from).norm();
  return std::max(1, int(std::ceil(length / spacing)));
}

/// Branch and bound over pieces of the body's motions. The sphere around the body bounds its
/// distance from below; short pieces are excluded by the volume that the body sweeps, grown by the
/// minimum distance found.
class NearestSearch {
 public:
  NearestSearch(const Route& route, const Request& request)
      : layers_(request.world->layers()),
        body_(request.vehicle.body.get()),
        outer_(body_ != nullptr ? body_->outer_m() : 0) {
    each_sweep(route, request,
               [&](const Leg&, Sweep&& sweep) { sweeps_.push_back(std::move(sweep)); });
  }

  std::optional<NearestBody> operator()() {
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
      for (std::size_t sweep = 0; sweep < sweeps_.size(); ++sweep) {
        open(layer, sweep, 0, 1);
      }
    }
    while (!open_.empty() && open_.top().min_distance < best() - tolerance() / 2 && best() > 0) {
      if (effort_ > kMaxEffort) {
        if (nearest_) {
          nearest_->proven = false;
        }
        break;
      }
      const Piece piece = open_.top();
      open_.pop();
      look(piece);
    }
    return nearest_;
  }

 private:
  /// In microseconds, roughly; no clock, so that a picture is always the same.
  static constexpr double kMaxEffort = 1e5;

  struct Piece {
    double min_distance;  ///< no part of the body is nearer
    double half;          ///< the reference point is never farther from where it is at the middle
    std::size_t layer;
    std::size_t sweep;
    double begin;
    double end;
    bool operator<(const Piece& other) const { return min_distance > other.min_distance; }
  };

  double best() const { return nearest_ ? nearest_->distance : kInfinity; }
  double tolerance() const { return nearest_ ? std::max(0.01, 1e-3 * best()) : 0.01; }
  double bend_of(const Piece& piece) const {
    return sweeps_[piece.sweep].bend * (piece.end - piece.begin) * (piece.end - piece.begin);
  }

  void open(std::size_t layer, std::size_t sweep, double begin, double end) {
    Piece piece{0, 0, layer, sweep, begin, end};
    const auto at = [&](double t) { return places_at(sweeps_[sweep], t).front().at; };
    piece.half = (at(end) - at(begin)).norm() / 2 + 2 * bend_of(piece);
    const double clearance = layers_[layer].environment->clearance(at((begin + end) / 2));
    piece.min_distance = clearance - piece.half - outer_;
    effort_ += 2;
    if (piece.min_distance < best()) {
      open_.push(piece);
    }
  }

  void look(const Piece& piece) {
    const Layer& layer = layers_[piece.layer];
    const Sweep& sweep = sweeps_[piece.sweep];
    const double middle = (piece.begin + piece.end) / 2;
    const bool is_short = piece.half <= std::max(8 * outer_, 0.5);
    if (is_short) {
      if (nearest_ && !comes_nearer(*layer.environment, piece)) {
        return;
      }
      for (const Placement& place : places_at(sweep, middle)) {
        look_at(layer, place);
      }
    }
    if (!is_leaf(piece) && piece.begin < middle && middle < piece.end) {
      open(piece.layer, piece.sweep, piece.begin, middle);
      open(piece.layer, piece.sweep, middle, piece.end);
    }
  }

  /// True if no point of the body is farther than the tolerance from where it is at the middle.
  bool is_leaf(const Piece& piece) const {
    const Sweep& sweep = sweeps_[piece.sweep];
    const Placement from = places_at(sweep, piece.begin).front();
    const Placement to = places_at(sweep, piece.end).front();
    const double angle = Eigen::AngleAxisd(to.rotation * from.rotation.transpose()).angle();
    return bend_of(piece) <= tolerance() / 8 && piece.half + outer_ * angle / 2 <= tolerance() / 2;
  }

  /// True unless the body is known to come nowhere nearer on the piece, to within the tolerance and
  /// what the volume has in excess of all headings.
  bool comes_nearer(const Environment& layer, const Piece& piece) {
    const Sweep& sweep = sweeps_[piece.sweep];
    std::vector<Placement> ends = places_at(sweep, piece.begin);
    sweep.place(piece.end, ends);
    const double distance = best() - tolerance() / 2 - 3 * sweep.between;
    return distance >= 0 && meets(layer, ends, distance, bend_of(piece) + sweep.between);
  }

  /// True if the layer is within a distance of what the body sweeps.
  bool meets(const Environment& layer, std::span<const Placement> ends, double distance,
             double grown) {
    return std::any_of(body_->parts.begin(), body_->parts.end(), [&](BodyPart part) {
      part.rounding += distance;
      // Obstacles around a large volume are many.
      effort_ += 10 + std::min(distance * distance, 1000.0) +
                 0.2 * double(part.corners.size() * ends.size());
      return layer.meets({part, outer_ + distance, ends, grown});
    });
  }

  /// Keeps the place if the body is nearer there.
  void look_at(const Layer& layer, const Placement& place) {
    const Environment& environment = *layer.environment;
    const auto is_within = [&](double distance) {
      return meets(environment, {&place, 1}, distance, 0);
    };
    const double fine = tolerance() / 4;
    double near = std::max(0.0, environment.clearance(place.at) - outer_);
    double far = best();
    if (!nearest_) {
      // Less than 0 where the whole body is inside.
      far = std::max(0.0, place_clearance(environment, place.at) + outer_);
      effort_ += 20;
    } else if (near >= far || !is_within(std::max(0.0, far - fine))) {
      return;
    }
    if (!std::isfinite(far)) {
      return;
    }
    if (near == 0 && is_within(0)) {
      far = 0;
    }
    while (far - near > fine) {
      const double middle = (near + far) / 2;
      (is_within(middle) ? far : near) = middle;
    }
    nearest_ = {place, layer.id, std::max(0.0, far), true};
  }

  const std::vector<Layer>& layers_;
  const Body* body_;
  double outer_;
  std::vector<Sweep> sweeps_;
  std::priority_queue<Piece> open_;
  std::optional<NearestBody> nearest_;
  double effort_ = 0;
};
}  // namespace

std::vector<Placement> body_along(const Route& route, const Request& request, double spacing) {
  std::vector<Placement> all;
  each_sweep(route, request, [&](const Leg& leg, const Sweep& sweep) {
    const int parts = part_count(leg, sweep, spacing);
    for (int n = 0; n <= parts; ++n) {
      const Placement place = places_at(sweep, double(n) / parts).front();
      const bool repeats = !all.empty() && all.back().at == place.at &&
                           all.back().rotation.isApprox(place.rotation, 1e-9);
      if (!repeats) {
        all.push_back(place);
      }
    }
  });
  return all;
}

std::optional<NearestBody> nearest_body(const Route& route, const Request& request) {
  return NearestSearch(route, request)();
}
}  // namespace altiplan
