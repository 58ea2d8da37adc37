// SPDX-License-Identifier: Apache-2.0
#include "sampled.hpp"

#include <cmath>
#include <functional>
#include <optional>

#include "altiplan/error.hpp"
#include "altiplan/field.hpp"
#include "altiplan/world.hpp"
#include "raster.hpp"

namespace exposure {
namespace {
using namespace altiplan;

/// The value at a place, if there is one.
using Ask = std::function<std::optional<double>(const Vec3&)>;

/// What planners know: layers that are discovered in flight are left out.
World known_part(const World& all) {
  World known;
  for (const Layer& layer : all.layers()) {
    if (layer.known) {
      known = std::move(known).with(layer);
    }
  }
  return known;
}

const Field& field_of_layer(const World& world, const std::string& id) {
  std::string others;
  for (const Layer& layer : world.layers()) {
    const Field* field = layer.environment->field();
    if (field != nullptr && layer.id == id) {
      return *field;
    }
    others += field != nullptr ? (others.empty() ? "'" : ", '") + layer.id + "'" : "";
  }
  throw ParameterError("layer", "no known layer with a field has the id '" + id +
                                    "'; layers with "
                                    "one: " +
                                    (others.empty() ? "none" : others));
}

Ask asked(const Sampled& sampled, const Site& site, const World& world) {
  if (!sampled.layer.empty()) {
    return
        [&field = field_of_layer(world, sampled.layer)](const Vec3& p) { return field.value(p); };
  }
  if (sampled.of == "clearance") {
    return [&](const Vec3& p) { return std::optional(world.clearance(p)); };
  }
  if (sampled.of == "wind_speed") {
    if (site.wind.is_calm()) {
      throw ParameterError("of", "needs wind, and the scenario has none");
    }
    if (!site.wind.changes.empty()) {
      throw ParameterError("of", "knows one wind, and the scenario's changes");
    }
    return [&](const Vec3& p) { return std::optional(site.wind.at(p).norm()); };
  }
  if (!world.has_ground()) {
    throw ParameterError("of", "needs a layer with ground (terrain)");
  }
  return [&](const Vec3& p) {
    const std::optional<double> ground = world.ground(p.x(), p.y());
    return ground ? std::optional(p.z() - *ground) : std::nullopt;
  };
}

/// Posts from edge to edge of the volume, as far apart as cells or less; level flight has one
/// level.
kit::Posts posts_over(const Box& volume, const Vec3& cell_m) {
  kit::Posts posts;
  double count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = Eigen::Index(axis);
    const double cells = std::ceil((volume.max[at] - volume.min[at]) / cell_m[at]);
    const double posts_along = axis == 2 && cells == 0 ? 1 : std::max(cells, 1.0) + 1;
    count *= posts_along;
    if (!(count <= double(kMaxCells))) {
      throw ParameterError("cell_m", "the volume would have more than " +
                                         std::to_string(kMaxCells) +
                                         " places to ask: give larger cells, or a volume");
    }
    posts.origin[axis] = volume.min[at];
    posts.step[axis] = cells > 0 ? (volume.max[at] - volume.min[at]) / std::max(cells, 1.0) : 1;
    posts.counts[axis] = int(posts_along);
  }
  return posts;
}
}  // namespace

kit::ScalarField Sampled::field(const Site& site, const Price& price, double elsewhere) const {
  const World world = known_part(*site.before);
  const Ask ask = asked(*this, site, world);
  const kit::Posts posts = posts_over(site.volume, cell_m);
  std::vector<float> values;
  values.reserve(std::size_t(posts.counts[0]) * std::size_t(posts.counts[1]) *
                 std::size_t(posts.counts[2]));
  for (int k = 0; k < posts.counts[2]; ++k) {
    for (int j = 0; j < posts.counts[1]; ++j) {
      for (int i = 0; i < posts.counts[0]; ++i) {
        const std::optional<double> value =
            ask({posts.origin[0] + i * posts.step[0], posts.origin[1] + j * posts.step[1],
                 posts.origin[2] + k * posts.step[2]});
        values.push_back(value ? float(price(*value)) : NAN);
      }
    }
  }
  return {posts, std::move(values), elsewhere};
}
}  // namespace exposure
