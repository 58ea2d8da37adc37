// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/height_field.hpp"
#include "host/base/base64.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr double kMaxPosts = 1'000'000;
/// A model slightly above the limit is shown in full: every other post would be a quarter of it.
constexpr double kMaxNativePosts = 1'050'000;
/// Samples on the longer side of a ground without posts.
constexpr double kSamples = 400;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Points at x0 + i dx, y0 + j dy.
struct Posts {
  int nx = 0;
  int ny = 0;
  double x0 = 0;
  double y0 = 0;
  double dx = 0;
  double dy = 0;
};

template <class Height>
Json posts_json(const Posts& posts, Json before, const Height& height) {
  std::vector<float> heights;
  heights.reserve(std::size_t(posts.nx) * std::size_t(posts.ny));
  for (int j = 0; j < posts.ny; ++j) {
    for (int i = 0; i < posts.nx; ++i) {
      const float at = height(i, j);
      heights.push_back(at < float(kClosedGround) ? at : kNone);
    }
  }
  // Not rounded: the error would accumulate with each post.
  return {{"nx", posts.nx},
          {"ny", posts.ny},
          {"x0", posts.x0},
          {"y0", posts.y0},
          {"dx", posts.dx},
          {"dy", posts.dy},
          {"heights", base64_of(heights)},
          {"of", std::move(before)}};
}

/// Posts along an axis that cover low to high: the first, and their number.
struct Window {
  int first = 0;
  int count = 0;
};

Window window(double low, double high, double origin, double spacing, int count) {
  const auto post = [&](double at) { return std::clamp(at, 0.0, double(count - 1)); };
  const int first = int(post(std::floor((low - origin) / spacing)));
  const int last = int(post(std::ceil((high - origin) / spacing)));
  return {first, last - first + 1};
}

std::string ordinal(int n) { return std::to_string(n) + (n == 2 ? "nd" : n == 3 ? "rd" : "th"); }

Json of_field(const HeightField& field, const std::string& id, const Box& box, SceneNotes& notes) {
  const auto [x0, y0] = field.origin();
  const auto [dx, dy] = field.spacing();
  const Window east = window(box.min.x(), box.max.x(), x0, dx, field.columns());
  const Window north = window(box.min.y(), box.max.y(), y0, dy, field.rows());
  const double count = double(east.count) * north.count;
  const int every =
      count <= kMaxNativePosts ? 1 : std::max(2, int(std::ceil(std::sqrt(count / kMaxPosts))));
  const Posts posts{(east.count - 1) / every + 1,
                    (north.count - 1) / every + 1,
                    x0 + east.first * dx,
                    y0 + north.first * dy,
                    every * dx,
                    every * dy};
  if (posts.nx < 2 || posts.ny < 2) {
    return nullptr;  // the box is outside the ground
  }
  if (every > 1) {
    notes.add(id + ": the ground is shown at every " + ordinal(every) + " post");
  }
  return posts_json(
      posts, every > 1 ? Json{east.count, north.count} : Json(nullptr),
      [&](int i, int j) { return field.post(east.first + i * every, north.first + j * every); });
}

Json of_samples(const World& world, const Box& area, double spacing, SceneNotes& notes) {
  const Vec3 size = area.max - area.min;
  if (!(size.x() > 0 && size.y() > 0)) {
    return nullptr;
  }
  spacing = std::max(spacing, std::sqrt(size.x() * size.y() / kMaxPosts));
  const auto steps = [&](double length) {
    return int(std::clamp(std::floor(length / spacing), 1.0, kMaxPosts / 2));
  };
  const Posts posts{steps(size.x()) + 1, steps(size.y()) + 1,        area.min.x(),
                    area.min.y(),        size.x() / steps(size.x()), size.y() / steps(size.y())};
  char text[96];
  std::snprintf(text, sizeof text, "the ground is sampled every %.3g m", posts.dx);
  notes.add(text);
  return posts_json(posts, nullptr, [&](int i, int j) {
    const auto height = world.ground(posts.x0 + i * posts.dx, posts.y0 + j * posts.dy);
    return height ? float(*height) : kNone;
  });
}
}  // namespace

Json ground_json(const World& world, const Box& box, SceneNotes& notes) {
  std::vector<const Layer*> grounds;
  Box area = Box::empty();
  double spacing = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y()) / kSamples;
  for (const Layer& layer : world.layers()) {
    if (const Ground* ground = layer.environment->ground()) {
      grounds.push_back(&layer);
      area = area.united(layer.environment->bounds());
      if (const HeightField* field = ground->height_field()) {
        spacing = std::min({spacing, field->spacing()[0], field->spacing()[1]});
      }
    }
  }
  if (grounds.empty()) {
    return nullptr;
  }
  const HeightField* field = grounds.front()->environment->ground()->height_field();
  if (grounds.size() == 1 && field != nullptr) {
    return of_field(*field, grounds.front()->id, box, notes);
  }
  return of_samples(world, area.intersected(box), spacing, notes);
}
}  // namespace altiplan::host
