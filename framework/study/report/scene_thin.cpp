// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include "host/base/base64.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {
namespace {

constexpr int kMaxPosts = 140;  // on the longer side
constexpr std::size_t kMaxSamples = 240;
constexpr float kHeightSteps = 8;  // per metre; finer heights would not compress

std::vector<float> floats(const std::string& text) {
  const std::vector<std::byte> bytes = host::from_base64(text);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

void thin_ground(host::Json& scene) {
  host::Json& ground = scene.at("ground");
  if (ground.is_null()) {
    return;
  }
  const int nx = ground.at("nx").get<int>();
  const int ny = ground.at("ny").get<int>();
  const int every = (std::max(nx, ny) - 1) / kMaxPosts + 1;
  if ((nx - 1) / every < 1 || (ny - 1) / every < 1) {
    return;  // a strip with few posts
  }
  const std::vector<float> heights = floats(ground.at("heights").get<std::string>());
  std::vector<float> kept;
  for (int j = 0; j < ny; j += every) {
    for (int i = 0; i < nx; i += every) {
      const float height = heights[std::size_t(j) * std::size_t(nx) + std::size_t(i)];
      kept.push_back(std::round(height * kHeightSteps) / kHeightSteps);
    }
  }
  if (every > 1) {
    if (ground.at("of").is_null()) {
      ground["of"] = {nx, ny};
    }
    ground["nx"] = (nx - 1) / every + 1;
    ground["ny"] = (ny - 1) / every + 1;
    ground["dx"] = ground.at("dx").get<double>() * every;
    ground["dy"] = ground.at("dy").get<double>() * every;
    scene["notes"].push_back("the report shows the ground at one in " +
                             std::to_string(every * every) + " posts");
  }
  ground["heights"] = host::base64_of(kept);
}

/// Adds the sample with the lowest value.
void keep_min(const host::Json& values, std::set<std::size_t>& kept) {
  std::optional<std::size_t> min_at;
  for (std::size_t at = 0; at < values.size(); ++at) {
    if (values[at].is_number() && (!min_at || values[at] < values[*min_at])) {
      min_at = at;
    }
  }
  if (min_at) {
    kept.insert(*min_at);
  }
}

host::Json heights_over_ground(const host::Json& profile) {
  host::Json heights = host::Json::array();
  for (std::size_t at = 0; at < profile.at("ground").size(); ++at) {
    const host::Json& ground = profile.at("ground")[at];
    heights.push_back(ground.is_null() ? ground
                                       : host::Json(profile.at("altitude")[at].get<double>() -
                                                    ground.get<double>()));
  }
  return heights;
}

/// Every n-th sample, the last, the lowest and nearest ones, and, within the limit, all with a
/// turn.
void thin_profile(host::Json& profile) {
  if (profile.is_null()) {
    return;
  }
  const std::size_t count = profile.at("s").size();
  if (count <= kMaxSamples) {
    return;
  }
  const host::Json& turns = profile.at("turn");
  const auto corners = std::size_t(std::count_if(
      turns.begin(), turns.end(), [](const host::Json& turn) { return !turn.is_null(); }));
  const bool keep_corners = corners <= kMaxSamples / 2;
  const std::size_t every = (count - 1) / (kMaxSamples - (keep_corners ? corners : 0)) + 1;
  std::set<std::size_t> kept{count - 1};
  for (std::size_t at = 0; at < count; ++at) {
    if (at % every == 0 || (keep_corners && !turns[at].is_null())) {
      kept.insert(at);
    }
  }
  keep_min(heights_over_ground(profile), kept);
  for (const host::Json& clearances : profile.at("to")) {
    keep_min(clearances, kept);
  }
  const auto thin = [&](host::Json& values) {
    host::Json some = host::Json::array();
    for (const std::size_t at : kept) {
      some.push_back(std::move(values[at]));
    }
    values = std::move(some);
  };
  for (auto& [key, values] : profile.items()) {
    if (values.is_array()) {
      thin(values);
    }
  }
  for (const char* of_layers : {"to", "solid"}) {
    if (profile.contains(of_layers)) {
      for (host::Json& values : profile.at(of_layers)) {
        thin(values);
      }
    }
  }
}
}  // namespace

void thin_scene(host::Json& scene) {
  thin_ground(scene);
  for (host::Json& result : scene.at("results")) {
    thin_profile(result.at("profile"));
    if (!result.at("flight").is_null()) {
      thin_profile(result.at("flight").at("profile"));
    }
  }
}

void drop_times(host::Json& json) {
  if (json.is_object()) {
    host::Json kept = host::Json::object();
    for (auto& [key, value] : json.items()) {
      if (!key.ends_with("time_s") && key != "first_route_s") {
        kept[key] = std::move(value);
      }
    }
    json = std::move(kept);
  }
  if (json.is_structured()) {
    for (host::Json& part : json) {
      drop_times(part);
    }
  }
}
}  // namespace altiplan::study::report
