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

using Span = std::array<double, 2>;  ///< heights, m

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
      // What begins at the lowest height is touched there, not entered.
      spans.push_back({p.z() <= low + kFine ? low : p.z(), high});
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

/// The spans of both, merged where they overlap.
std::vector<Span> united(std::vector<Span> spans, const std::vector<Span>& more) {
  spans.insert(spans.end(), more.begin(), more.end());
  std::sort(spans.begin(), spans.end());
  std::vector<Span> merged;
  for (const Span& span : spans) {
    if (!merged.empty() && span[0] <= merged.back()[1]) {
      merged.back()[1] = std::max(merged.back()[1], span[1]);
    } else {
      merged.push_back(span);
    }
  }
  return merged;
}

Vec3 point_of(const Json& at) {
  return {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
}

/// The shown heights of a profile: from the lowest place or ground, or the volume's floor where
/// there is no ground, to some way above the highest.
Span shown_heights(const Json& profile, const Box& volume) {
  Span range{kInfinity, -kInfinity};
  widen(range, profile.at("ground"));
  const bool has_ground = range[0] <= range[1];
  widen(range, profile.at("altitude"));
  const double above = std::max(100.0, 0.4 * (range[1] - range[0]));
  return {has_ground ? std::max(range[0], volume.min.z()) : volume.min.z(),
          std::min(range[1] + above, volume.max.z())};
}
}  // namespace

void SolidProfile::add(const World& world, const Vec3& p, const Vec3& ahead) {
  const Vec3 aside = Vec3(-ahead.y(), ahead.x(), 0).normalized();  // zero where it only climbs
  for (const Layer& layer : world.layers()) {
    if (layer.environment->ground() != nullptr) {
      continue;
    }
    const Environment& environment = *layer.environment;
    std::vector<Span> below = solid_heights(environment, p, heights_[0], heights_[1]);
    std::vector<Span> beside = below;
    for (const double share : {-1.0, -0.5, 0.5, 1.0}) {
      beside = united(beside, solid_heights(environment, p + share * beside_m_ * aside, heights_[0],
                                            heights_[1]));
    }
    if (!beside.empty()) {
      layers_[layer.id][count_] = {spans_json(below), spans_json(beside)};
    }
  }
  ++count_;
}

void SolidProfile::write(Json& profile) const {
  profile["beside_m"] = rounded(beside_m_);
  for (const std::size_t list : {0, 1}) {
    Json& lists = profile[list == 0 ? "solid" : "beside"] = Json::object();
    for (const auto& [layer, samples] : layers_) {
      Json spans(count_, Json::array());
      bool has_any = false;
      for (const auto& [sample, both] : samples) {
        spans[sample] = both[list];
        has_any = has_any || !both[list].empty();
      }
      if (has_any) {
        lists[layer] = std::move(spans);
      }
    }
  }
}

SolidProfile solid_profile(const Json& profile, const Box& volume) {
  constexpr double kMaxBeside = 25;      // metres
  constexpr double kBesideShare = 0.02;  // of the volume's longer side
  const Vec3 size = volume.max - volume.min;
  return {shown_heights(profile, volume),
          std::min(kMaxBeside, kBesideShare * std::max(size.x(), size.y()))};
}

void add_heights(Json& profile, const Request& request) {
  const Span range = shown_heights(profile, request.volume);
  const AllowedHeights allowed(request, range[0], range[1]);
  Json low = Json::array();
  Json high = Json::array();
  SolidProfile solids = solid_profile(profile, request.volume);
  const Json& places = profile.at("at");
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Vec3 at = point_of(places[n]);
    const auto span = allowed.around(at);
    low.push_back(span && (*span)[0] > range[0] ? rounded((*span)[0]) : Json(nullptr));
    high.push_back(span && (*span)[1] < range[1] ? rounded((*span)[1]) : Json(nullptr));
    solids.add(*request.world, at,
               point_of(places[std::min(n + 1, places.size() - 1)]) -
                   point_of(places[n == 0 ? 0 : n - 1]));
  }
  profile["lowest"] = std::move(low);
  profile["highest"] = std::move(high);
  solids.write(profile);
}
}  // namespace altiplan::host
