// SPDX-License-Identifier: Apache-2.0
// Explains why no step is flown. Like a step it allocates nothing.
#include <algorithm>
#include <cstdio>

#include "altiplan/world.hpp"
#include "field_pilot.hpp"

namespace apf {
namespace {

/// Cosine: directions farther apart than 45 degrees are different sides.
constexpr double kOtherSide = 0.7;

/// An obstacle that pushes, its distance and its direction.
struct Pushing {
  std::string_view id;
  double distance = kInfinity;
  Vec3 away{0, 0, 0};
};

/// A sentence in a preallocated buffer.
class Words {
 public:
  explicit Words(std::span<char> to) : to_(to) {}
  void add(const char* text) { add("%s", text); }
  template <class Value, class... Values>
  void add(const char* format, const Value& value, const Values&... values) {
    const int length = std::snprintf(&to_[size_], to_.size() - size_, format, value, values...);
    size_ = std::min(size_ + std::size_t(std::max(0, length)), to_.size() - 1);
  }
  std::string_view text() const { return {to_.data(), size_}; }

 private:
  std::span<char> to_;
  std::size_t size_ = 0;
};

/// "'pier' (12.0 m off)"
void name(const Pushing& pushing, Words& words) {
  words.add("'%.*s' (%.1f m off)", int(pushing.id.size()), pushing.id.data(), pushing.distance);
}
}  // namespace

std::string_view FieldPilot::why_trapped(const Observation& seen) {
  const auto nearest = [&](const auto& counts) {
    Pushing found;
    const auto take = [&](const Pushing& one) {
      if (one.distance < found.distance && counts(one)) {
        found = one;
      }
    };
    seen.world->near(here_, p_.influence_m + required_,
                     ground_influence_ + std::max(room_of_ground(), required_),
                     [&](const Layer& layer, const Nearby& nearby) {
                       take({layer.id, nearby.distance, nearby.normal});
                     });
    for (const SensedObstacle& moving : moving_) {
      const Vec3 away = here_ - moving.position;
      const double distance = away.norm() - moving.radius;
      if (distance <= p_.influence_m) {
        take({moving.id, distance, away.normalized()});
      }
    }
    return found;
  };
  const Pushing first = nearest([](const Pushing&) { return true; });
  const Pushing other =
      nearest([&](const Pushing& one) { return one.away.dot(first.away) < kOtherSide; });
  Words words(why_);
  words.add("a local minimum of the field");
  if (first.id.empty()) {
    words.add(" with nothing within influence_m (%g m)", p_.influence_m);
    if (p_.turn_limit) {
      words.add(", where max_turn_deg (%g) makes it circle", p_.max_turn_deg);
    }
  } else if (other.id.empty()) {
    words.add(" before ");
    name(first, words);
  } else {
    words.add(" between ");
    name(first, words);
    words.add(" and ");
    name(other, words);
  }
  words.add(": many steps, hardly any progress");
  return words.text();
}

std::string_view FieldPilot::why_no_heading(const Observation& seen) {
  struct Count {
    std::string_view layer;
    int headings = 0;
  };
  std::array<Count, 8> layers{};
  int outside = 0;
  int unknown = 0;
  int tried = 0;
  for (int i = 1; has_prospect(i); ++i, ++tried) {
    const Vec3& to = prospects_[std::size_t(i)].to;
    if (!request_.volume.contains(to, kLengthTolerance)) {
      ++outside;
    } else if (!seen.world->ground_below(here_, to)) {
      ++unknown;
    } else if (const Layer* met = seen.world->blocked_by(here_, to, required_)) {
      const auto count = std::find_if(layers.begin(), layers.end() - 1, [&](const Count& one) {
        return one.layer.empty() || one.layer == met->id;
      });
      *count = {met->id, count->headings + 1};
    }
  }
  std::sort(layers.begin(), layers.end(),
            [](const Count& a, const Count& b) { return a.headings > b.headings; });
  Words words(why_);
  words.add("no heading is free of obstacles for one step of %.3g m: of %d tried", step_, tried);
  for (const Count& count : layers) {
    if (count.headings > 0) {
      words.add(", %d come too near to '%.*s'", count.headings, int(count.layer.size()),
                count.layer.data());
    }
  }
  if (outside > 0) {
    words.add(", %d leave the volume", outside);
  }
  if (unknown > 0) {
    words.add(", %d are over ground of unknown height", unknown);
  }
  return words.text();
}
}  // namespace apf
