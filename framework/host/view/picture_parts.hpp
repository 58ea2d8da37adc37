// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/base64.hpp"
#include "host/base/svg.hpp"
#include "host/base/xml_text.hpp"
#include "host/result/result_json.hpp"
#include "host/view/series_colors.hpp"

// The parts of the top view, one file each. Lengths are pixels from the top left.

namespace altiplan::host::picture {

inline constexpr std::string_view kInk = "#1a2027";
inline constexpr std::string_view kFaint = "#5b6672";
inline constexpr std::string_view kPaper = "#ffffff";

inline std::string_view route_color(std::size_t result) {
  return kSeriesColors[result % kSeriesColors.size()].light;
}
inline std::string_view role_color(std::string_view role) {
  return role == "keep_out"  ? "#cc79a7"
         : role == "keep_in" ? "#009e73"
         : role == "threat"  ? "#d55e00"
                             : "#2f363d";
}

/// Unknown space would hide everything else, and is not drawn.
inline bool is_drawn(const Json& thing) { return thing.at("role") != "unknown"; }

inline constexpr SvgPen kPen{false};
inline std::string pixels(double value) { return kPen.pixels(value); }
/// The beginning of a picture that is so large; `more` are attributes.
std::string open_svg(double width, double height, const std::string& more = "");

struct Area {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

enum class Align { start, middle, end };
std::string text_at(double x, double y, std::string_view text, std::string_view color = kInk,
                    int size = 14, Align align = Align::start, bool bold = false);
std::string line(double x0, double y0, double x1, double y1, std::string_view color,
                 double width = 1);
/// Its paint are attributes, each after a blank.
inline std::string rectangle(const Area& area, const std::string& paint) {
  return kPen.rectangle(area.left, area.top, area.width, area.height, paint);
}
/// Text with a light edge, over anything.
std::string over_all(const std::string& text);

/// The round number (1, 2 or 5 times a power of ten) that divides `length` into about `steps`
/// steps.
double round_step(double length, double steps);
/// With a comma between groups of three digits: "12,500".
std::string grouped(double value);

/// The unit of an axis of lengths up to `greatest` metres.
struct LengthUnit {
  const char* name;
  double metres;
};
inline LengthUnit length_unit(double greatest) {
  constexpr double kLong = 10'000;
  return greatest > kLong ? LengthUnit{"km", 1000} : LengthUnit{"m", 1};
}

/// Decodes numbers that a scene holds as base64.
template <class Value>
std::vector<Value> numbers(const Json& base64_text) {
  const std::vector<std::byte> bytes = from_base64(base64_text.get_ref<const std::string&>());
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
  return values;
}

/// The scene's box seen from above, fitted into an area.
class Map {
 public:
  Map(const Json& box, const Area& room);
  double x(double east) const { return area_.left + (east - west_) * scale_; }
  double y(double north) const { return area_.bottom() - (north - south_) * scale_; }
  double per_metre() const { return scale_; }
  const Area& area() const { return area_; }

 private:
  double west_;
  double south_;
  double scale_;
  Area area_;
};

/// Colour of a height; `share` is 0 for the lowest, 1 for the highest.
std::array<std::uint8_t, 3> height_color(double share);
/// The lowest and the highest ground; none if the scene has no ground.
std::optional<std::array<double, 2>> heights_of(const Json& scene);

std::string relief(const Json& scene, const Map& map);
std::string solids(const Json& scene, const Map& map);
std::string routes(const Json& scene, const Map& map);
/// The body of a result at its closest place; "" if there is none.
std::string closest_body(const Json& scene, const Json& result, std::string_view color,
                         const Map& map);
/// In corners of the map that hold neither the start nor the goal.
std::string scale_and_north(const Json& scene, const Map& map);
std::string legend(const Json& scene, const Area& area);
std::string profiles(const Json& scene, const Area& area);
}  // namespace altiplan::host::picture
