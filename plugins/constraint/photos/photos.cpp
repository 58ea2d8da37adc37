// SPDX-License-Identifier: Apache-2.0
//
// A camera that looks straight down from the height h shows h / f of the sensor's width and height,
// f being the focal length: a ground sample distance of h w / (n f), w being the width, n the
// pixels across, and a photo of h w / f across and h l / f along the flight, l being the sensor's
// height. All grow with h: limits of scale and overlap are limits of the height above the ground.
#include <algorithm>
#include <array>
#include <cstdio>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace altiplan::photos {
namespace {

struct Params {
  std::array<double, 2> sensor_mm{0, 0};
  std::array<double, 2> image_px{0, 0};
  double focal_mm = 0;
  std::optional<double> min_gsd_cm;
  std::optional<double> max_gsd_cm;
  std::optional<double> trigger_m;
  std::optional<double> min_overlap;
  std::optional<double> spacing_m;
  std::optional<double> min_sidelap;
  AppliesTo applies_to = AppliesTo::both;

  void describe(Fields& f) {
    f("sensor_mm", sensor_mm)
        .unit("mm")
        .required()
        .greater_than(0)
        .doc("of the camera, which looks straight down: its width, across the flight, and height");
    f("image_px", image_px).required().greater_than(0).doc("pixels across and along the flight");
    f("focal_mm", focal_mm).unit("mm").greater_than(0).required().doc("focal length");
    f("min_gsd_cm", min_gsd_cm).unit("cm").greater_than(0).doc("least that a pixel may show");
    f("max_gsd_cm", max_gsd_cm).unit("cm").greater_than(0).doc("most that a pixel may show");
    f("trigger_m", trigger_m).unit("m").greater_than(0).doc("distance of photos along the flight");
    f("min_overlap", min_overlap)
        .range(0, 0.99)
        .doc(
            "with trigger_m: share of a photo that the next one shows, too, of the ground below "
            "(default 0.75)");
    f("spacing_m", spacing_m).unit("m").greater_than(0).doc("distance of lines side by side");
    f("min_sidelap", min_sidelap)
        .range(0, 0.99)
        .doc(
            "with spacing_m: share of a photo that one of the next line, from the same height, "
            "shows, too, of the ground below (default 0.7)");
    f("applies_to", applies_to,
      {{"both", AppliesTo::both}, {"route", AppliesTo::route}, {"track", AppliesTo::track}})
        .doc(
            "what it restricts: narrower limits for the route than for the track leave a margin "
            "for the flight");
    f.check(min_gsd_cm || max_gsd_cm || trigger_m || spacing_m,
            "expected min_gsd_cm, max_gsd_cm, trigger_m or spacing_m");
    f.check(!min_overlap || trigger_m, "min_overlap: expected with trigger_m, found without it");
    f.check(!min_sidelap || spacing_m, "min_sidelap: expected with spacing_m, found without it");
    f.check(min_gsd_cm.value_or(0) < max_gsd_cm.value_or(1e9),
            "expected min_gsd_cm below max_gsd_cm");
  }

  double overlap() const { return min_overlap.value_or(0.75); }
  double sidelap() const { return min_sidelap.value_or(0.7); }
  double gsd_cm(double height) const {
    return 100 * height * sensor_mm[0] / (image_px[0] * focal_mm);
  }
  double height_of(double cm) const { return cm / gsd_cm(1); }
  /// Share of a photo that another, so far away, shows too; `side` of the sensor lies that way.
  double shared(double distance, std::size_t side, double height) const {
    return 1 - distance * focal_mm / (height * sensor_mm[side]);
  }
  double height_of_shared(double distance, std::size_t side, double share) const {
    return distance * focal_mm / ((1 - share) * sensor_mm[side]);
  }
};

class Photos final : public Constraint {
 public:
  explicit Photos(const Params& params) : params_(params) {
    lowest_ = params.min_gsd_cm ? params.height_of(*params.min_gsd_cm) : -kInfinity;
    overlapping_ = params.trigger_m
                       ? params.height_of_shared(*params.trigger_m, kAlong, params.overlap())
                       : -kInfinity;
    beside_ = params.spacing_m
                  ? params.height_of_shared(*params.spacing_m, kAcross, params.sidelap())
                  : -kInfinity;
    highest_ = params.max_gsd_cm ? params.height_of(*params.max_gsd_cm) : kInfinity;
  }

 private:
  AppliesTo do_applies_to() const override { return params_.applies_to; }

  /// Where there is no ground nothing is known: refused.
  bool do_admits(const Motion& leg) const override {
    if (leg.world == nullptr || !leg.world->has_ground() || !is_finite(leg.from) ||
        !is_finite(leg.to)) {
      return false;
    }
    const double low = std::max({lowest_, overlapping_, beside_}) - kLengthTolerance;
    return leg.world->ground_gap(leg.from, leg.to) >= std::max(low, 0.0) &&
           leg.world->ground_gap_max(leg.from, leg.to) <=
               std::min(highest_ + kLengthTolerance, kFar);
  }

  /// do_admits refuses legs; this adds by how much: the worst of each kind.
  std::vector<Violation> do_violations(const Polyline& route,
                                       const Request& request) const override {
    double low = kInfinity;
    double high = -kInfinity;
    std::size_t low_at = 0;
    std::size_t high_at = 0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const double gap = request.world->ground_gap(route[i], route[i + 1]);
      const double gap_max = request.world->ground_gap_max(route[i], route[i + 1]);
      low_at = gap < low ? i : low_at;
      low = std::min(low, gap);
      high_at = gap_max > high ? i : high_at;
      high = std::max(high, gap_max);
    }
    std::vector<Violation> all;
    const auto add = [&](std::size_t at, double value, double limit, const char* unit,
                         const char* format) {
      char text[160];
      std::snprintf(text, sizeof text, format, value, limit);
      all.push_back({"", at, value, limit, text, "", unit});
    };
    if (low < lowest_ - kLengthTolerance && low > -kFar) {
      add(low_at, params_.gsd_cm(low), *params_.min_gsd_cm, "cm",
          "a pixel shows %.3f cm; at least %.3f cm are required");
    }
    if (high > highest_ + kLengthTolerance && high < kFar) {
      add(high_at, params_.gsd_cm(high), *params_.max_gsd_cm, "cm",
          "a pixel shows %.3f cm; at most %.3f cm are permitted");
    }
    if (low < overlapping_ - kLengthTolerance && low > 0) {
      add(low_at, params_.shared(*params_.trigger_m, kAlong, low), params_.overlap(), "",
          "photos have an overlap of %.3f; at least %.3f is required");
    }
    if (low < beside_ - kLengthTolerance && low > 0) {
      add(low_at, params_.shared(*params_.spacing_m, kAcross, low), params_.sidelap(), "",
          "photos have a side overlap of %.3f; at least %.3f is required");
    }
    return all;
  }

  static constexpr std::size_t kAcross = 0;  ///< sides of the sensor
  static constexpr std::size_t kAlong = 1;
  static constexpr double kFar = 1e7;  ///< metres: beyond it there is no ground
  Params params_;
  double lowest_;  ///< heights above the ground
  double overlapping_;
  double beside_;
  double highest_;
};
}  // namespace
}  // namespace altiplan::photos

ALTIPLAN_PLUGIN(Constraint, "photos", altiplan::photos::Photos, altiplan::photos::Params,
                "Keeps the scale and the overlap of photos of the ground below")
