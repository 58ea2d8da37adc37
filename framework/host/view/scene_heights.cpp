// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/check.hpp"
#include "altiplan/ground.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr double kFine = 0.5;  ///< metres: less is invisible
constexpr int kLevels = 24;    ///< at which allowed heights are looked for

using Span = std::array<double, 2>;  ///< heights

/// Where a layer is solid above or below a place, from `low` to `high`; by steps in which its
/// clearance cannot change sign.
std::vector<Span> solid_heights(const Environment& layer, Vec3 p, double low, double high) {
  std::vector<Span> spans;
  bool was_solid = false;
  p.z() = low;
  while (p.z() < high) {
    const double clearance = layer.clearance(p);
    const bool is_solid = clearance < 0;
    if (is_solid && !was_solid) {
      spans.push_back({p.z(), high});
    } else if (!is_solid && was_solid) {
      spans.back()[1] = p.z();
    }
    was_solid = is_solid;
    p.z() += std::isfinite(clearance) ? std::max(std::abs(clearance), kFine) : high - low;
  }
  return spans;
}

/// Heights allowed at a place, the interval at or nearest to `height`; none where no level is.
class AllowedHeights {
 public:
  AllowedHeights(const Request& request, double low, double high)
      : request_(request), low_(low), high_(high) {}

  std::optional<Span> around(Vec3 p) const {
    if (!is_allowed(p)) {
      const auto level = nearest_level(p);
      if (!level) {
        return std::nullopt;
      }
      p.z() = *level;
    }
    return Span{end_of(p, low_), end_of(p, high_)};
  }

 private:
  double level(int n) const { return low_ + (high_ - low_) * n / kLevels; }
  bool is_allowed(const Vec3& p) const { return point_problem(p, request_).empty(); }

  std::optional<double> nearest_level(const Vec3& p) const {
    std::optional<double> best;
    for (int n = 0; n <= kLevels; ++n) {
      const double z = level(n);
      if ((!best || std::abs(z - p.z()) < std::abs(*best - p.z())) &&
          is_allowed({p.x(), p.y(), z})) {
        best = z;
      }
    }
    return best;
  }

  /// The last height allowed on the way from p to `limit`.
  double end_of(const Vec3& p, double limit) const {
    double allowed = p.z();
    double refused = limit;
    const double step = std::copysign((high_ - low_) / kLevels, limit - p.z());
    while (allowed != limit) {
      const double next = std::abs(limit - allowed) <= std::abs(step) ? limit : allowed + step;
      if (!is_allowed({p.x(), p.y(), next})) {
        refused = next;
        break;
      }
      allowed = next;
    }
    while (allowed != limit && std::abs(refused - allowed) > kFine) {
      const double middle = (allowed + refused) / 2;
      (is_allowed({p.x(), p.y(), middle}) ? allowed : refused) = middle;
    }
    return allowed;
  }

  const Request& request_;
  double low_;
  double high_;
};

/// Lowest and highest of the numbers.
void widen(Span& range, const Json& values) {
  for (const Json& value : values) {
    if (value.is_number()) {
      range[0] = std::min(range[0], value.get<double>());
      range[1] = std::max(range[1], value.get<double>());
    }
  }
}

Json spans_json(const std::vector<Span>& spans) {
  Json json = Json::array();
  for (const auto& [low, high] : spans) {
    json.push_back({rounded(low), rounded(high)});
  }
  return json;
}
}  // namespace

void add_heights(Json& profile, const Request& request) {
  Span range{kInfinity, -kInfinity};
  widen(range, profile.at("altitude"));
  widen(range, profile.at("ground"));
  const double above = std::max(100.0, 0.4 * (range[1] - range[0]));
  range = {std::max(range[0], request.volume.min.z()),
           std::min(range[1] + above, request.volume.max.z())};
  const AllowedHeights allowed(request, range[0], range[1]);
  Json low = Json::array();
  Json high = Json::array();
  for (const Json& at : profile.at("at")) {
    const auto span =
        allowed.around({at[0].get<double>(), at[1].get<double>(), at[2].get<double>()});
    low.push_back(span && (*span)[0] > range[0] ? rounded((*span)[0]) : Json(nullptr));
    high.push_back(span && (*span)[1] < range[1] ? rounded((*span)[1]) : Json(nullptr));
  }
  profile["lowest"] = std::move(low);
  profile["highest"] = std::move(high);
  Json solids = Json::object();
  for (const Layer& layer : request.world->layers()) {
    if (layer.environment->ground() != nullptr) {
      continue;
    }
    Json spans = Json::array();
    bool has_any = false;
    for (const Json& at : profile.at("at")) {
      spans.push_back(spans_json(solid_heights(
          *layer.environment, {at[0].get<double>(), at[1].get<double>(), 0}, range[0], range[1])));
      has_any = has_any || !spans.back().empty();
    }
    if (has_any) {
      solids[layer.id] = std::move(spans);
    }
  }
  profile["solid"] = std::move(solids);
}
}  // namespace altiplan::host
