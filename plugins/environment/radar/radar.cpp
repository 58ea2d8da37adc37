// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/field.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/world.hpp"
#include "radar_equation.hpp"

namespace altiplan::radar {
namespace {

struct Params {
  Point at;
  std::optional<double> range_m;
  std::optional<RadarEquation> equation;
  bool masking = false;
  bool blocks = true;

  void describe(Fields& f) {
    f.point(at).required().doc("position of the antenna");
    f("range_m", range_m)
        .unit("m")
        .greater_than(0)
        .doc("detection range; alternative to `equation`");
    f("equation", equation).doc("the quantities of the radar equation, paper 000, eq. (1)");
    f("masking", masking).doc("ground between the antenna and a point masks the point");
    f("blocks", blocks)
        .doc("false: nothing is blocked; objectives price the detection (exposure: {layer: …})");
    f.check(range_m.has_value() != equation.has_value(), "give either range_m or equation");
  }
};

Vec3 antenna(const Params& params, const Site& site) {
  Vec3 at = site.resolve(params.at);
  if (!params.at.has_height && !params.at.above_ground_m && params.at.form != Point::Form::cell) {
    if (site.volume.min.z() != site.volume.max.z()) {
      throw Error("a radar needs the height of its antenna: a third number or above_ground_m");
    }
    at.z() = site.volume.min.z();  // level flight
  }
  return at;
}

/// A ball around the antenna; with masking, without the parts hidden by the ground. Where it does
/// not block, there is no ball. Its field is the echo against the noise and itself: the echo falls
/// with the fourth power of the distance (eq. (1)), and both are equal at the range.
///
/// A point's line of sight has the gap g, its minimum height above the ground: the point is covered
/// if g >= 0. Moving the point by d changes g by at most √(1 + s²) d, s the steepest slope of the
/// ground, so -g / √(1 + s²) is a 1-Lipschitz lower bound of the distance to the covered volume.
class Radar final : public Environment, public Field {
 public:
  Radar(const Params& params, const Site& site)
      : at_(antenna(params, site)),
        range_(params.range_m ? *params.range_m : params.equation->range_m()),
        ball_(params.blocks ? std::vector<Shape>{Sphere{at_, range_}} : std::vector<Shape>{}) {
    if (params.masking) {
      find_ground(*site.before);
    }
    if (params.blocks) {
      info_.threats = {{at_, range_, "radar", ""}};
    }
    info_.notes = {note()};
  }

 private:
  void find_ground(const World& before) {
    for (const Layer& layer : before.layers()) {
      if (const Ground* ground = layer.environment->ground()) {
        if (ground_ != nullptr) {
          throw ParameterError("masking", "needs one layer with ground before the radar, found '" +
                                              ground_layer_.id + "' and '" + layer.id + "'");
        }
        ground_ = ground;
        ground_layer_ = layer;
      }
    }
    if (ground_ == nullptr) {
      throw ParameterError("masking", "needs a layer with ground (terrain) before the radar");
    }
    area_ = ground_layer_.environment->bounds();
    area_.min.z() = -kInfinity;
    area_.max.z() = kInfinity;
    const auto height = ground_->height(at_.x(), at_.y());
    if (!height || at_.z() < *height) {
      throw Error(height ? "the antenna is below the ground"
                         : "masking: there is no ground below the antenna");
    }
    const double slope = ground_->slope(Box{at_, at_}.grown(range_).intersected(area_));
    steepness_ = std::hypot(1, slope);
    if (!std::isfinite(slope)) {
      ground_ = nullptr;  // the hidden volume is unknown
    }
  }

  // Lower bound of the signed distance of p from the volume not hidden by the ground; without
  // ground nothing is hidden.
  double to_covered(const Vec3& p) const {
    const double to_edge = (p - area_.min).cwiseMin(area_.max - p).head<2>().minCoeff();
    if (to_edge <= 0) {
      return to_edge;
    }
    const double hidden = -ground_->gap(at_, p) / steepness_;
    return std::min(to_edge, std::max(hidden, -to_edge));
  }

  const Field* do_field() const override { return this; }
  std::optional<double> do_value(const Vec3& p) const override {
    const double part = (p - at_).norm() / range_;
    return ground_ != nullptr && to_covered(p) > 0 ? 0 : 1 / (1 + std::pow(part, 4));
  }

  Box do_bounds() const override { return ball_.bounds(); }

  double do_clearance(const Vec3& p) const override {
    const double to_ball = ball_.clearance(p);
    return ground_ != nullptr ? std::max(to_ball, to_covered(p)) : to_ball;
  }

  // With masking: samples the leg at spacings no larger than the over-approximation; a sample
  // represents half of it to both sides.
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    if (!ball_.blocked(a, b, r)) {
      return false;
    }
    if (ground_ == nullptr) {
      return true;
    }
    // The result at a sample must not depend on how it was found, else it would not be monotone in
    // r; samples nearer than the spare clearance need no check, nor do those beyond the range.
    const Vec3 way = b - a;
    const double total = way.norm();
    const double count = std::max(1.0, std::ceil(total / kMaskedSlack));
    double first = 0;
    double last = count;
    if (total > 0) {
      const double middle = (at_ - a).dot(way) / total;
      const double aside = (a + middle / total * way - at_).norm();
      const double reach = range_ + r + kMaskedSlack;
      const double half = std::sqrt(std::max(0.0, reach * reach - aside * aside));
      first = std::max(0.0, std::floor((middle - half) / total * count));
      last = std::min(count, std::ceil((middle + half) / total * count));
    }
    for (double n = first; n <= last;) {
      const double spare =
          do_clearance(a + n / count * way) - (r - kLengthTolerance + kMaskedSlack / 2);
      if (spare < 0) {
        return true;
      }
      n += total > 0 ? std::max(1.0, std::floor(spare / total * count)) : count + 1;
    }
    return false;
  }

  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    const double distance = do_clearance(p);
    if (distance <= reach) {
      const Vec3 out = p - at_;
      const double length = out.norm();
      const Vec3 normal = length > 0 ? Vec3(out / length) : Vec3(0, 0, 1);
      sink({p - normal * distance, distance, normal, 0});
    }
  }

  void do_rasterize(VoxelGrid& grid) const override {
    if (ground_ == nullptr) {
      ball_.rasterize(grid);
      return;
    }
    const GridSpec& spec = grid.spec();
    const double reach =
        spec.inflation +
        (spec.rule == GridSpec::Rule::centre ? kLengthTolerance : spec.cell.norm() / 2);
    VoxelGrid ball(spec);
    ball_.rasterize(ball);
    for (int j = 0; j < spec.counts[1]; ++j) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        // A line of sight rises with its end: hidden points lie below visible ones.
        int low = 0;
        int high = spec.counts[2];
        while (low < high) {
          const int middle = (low + high) / 2;
          if (to_covered(spec.centre({i, j, middle})) <= reach) {
            high = middle;
          } else {
            low = middle + 1;
          }
        }
        for (int k = low; k < spec.counts[2]; ++k) {
          if (ball.blocked(i, j, k)) {
            grid.block_run(i, i, j, k);
          }
        }
      }
    }
  }

  bool do_meets(const SweptVolume& volume) const override {
    return ball_.meets(volume) && (ground_ == nullptr || Environment::do_meets(volume));
  }
  double do_over_approximation() const override { return ground_ != nullptr ? kMaskedSlack : 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Drawing> do_drawing() const override {
    return kit::drawing_of(ball_.shapes(), Drawn::Role::threat);
  }
  std::string note() const {
    std::string note = "range " + std::to_string(std::lround(range_)) + " m";
    if (ground_ != nullptr) {
      note += ", masked by '" + ground_layer_.id + "'";
    } else if (ground_layer_.environment) {
      note += ", not masked: '" + ground_layer_.id + "' has holes or an unknown slope in range";
    }
    return note;
  }

  static constexpr double kMaskedSlack = 1;  // metres

  Vec3 at_;
  double range_;
  kit::ObstacleSet ball_;
  const Ground* ground_ = nullptr;  ///< null: no masking
  Layer ground_layer_;
  Box area_;  ///< of the ground, unbounded in z
  double steepness_ = 1;
  LayerInfo info_;
};
}  // namespace
}  // namespace altiplan::radar

ALTIPLAN_PLUGIN(Environment, "radar", altiplan::radar::Radar, altiplan::radar::Params,
                "radar coverage: a range or the radar equation, with terrain masking")
