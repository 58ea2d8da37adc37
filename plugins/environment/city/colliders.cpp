// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "altiplan/formats/input_file.hpp"
#include "buildings.hpp"

namespace altiplan::city {
namespace {

/// Parses and removes the number at the beginning of the text, after blanks.
std::optional<double> take_number(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) {
    return std::nullopt;
  }
  text.remove_prefix(std::size_t(end - text.data()));
  return value;
}

bool take(std::string_view& text, std::string_view word) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  if (!text.starts_with(word)) {
    return false;
  }
  text.remove_prefix(word.size());
  return true;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == text.npos; }

/// Latitude and longitude of "lat0 37.79, lon0 -122.39".
std::optional<std::array<double, 2>> origin_of(std::string_view line) {
  if (!take(line, "lat0")) {
    return std::nullopt;
  }
  const auto lat = take_number(line);
  if (!lat || !take(line, ",") || !take(line, "lon0")) {
    return std::nullopt;
  }
  const auto lon = take_number(line);
  if (!lon || !is_blank(line) || std::abs(*lat) > 90 || std::abs(*lon) > 180) {
    return std::nullopt;
  }
  return std::array<double, 2>{*lat, *lon};
}

/// Six numbers separated by commas.
std::optional<std::array<double, 6>> box_of(std::string_view line) {
  std::array<double, 6> numbers{};
  for (std::size_t n = 0; n < 6; ++n) {
    const auto value = n == 0 || take(line, ",") ? take_number(line) : std::nullopt;
    if (!value) {
      return std::nullopt;
    }
    numbers[n] = *value;
  }
  return is_blank(line) ? std::optional(numbers) : std::nullopt;
}
}  // namespace

Buildings read_colliders(const std::string& file, const Site& site) {
  formats::InputFile stream(file);
  std::string line;
  int number = 0;
  const auto next = [&] {
    ++number;
    return bool(std::getline(stream, line));
  };
  const auto refuse = [&](const std::string& expected) {
    throw Error(file + ":" + std::to_string(number) + ": expected " + expected + ", found " +
                excerpt(line));
  };
  next();
  const auto origin = origin_of(line);
  if (!origin) {
    refuse("'lat0 DEGREES, lon0 DEGREES'");
  }
  next();
  if (!line.starts_with("posX,posY,posZ,halfSizeX,halfSizeY,halfSizeZ")) {
    refuse("the columns 'posX,posY,posZ,halfSizeX,halfSizeY,halfSizeZ'");
  }
  const auto [lat, lon] = *origin;
  Buildings buildings;
  std::array<double, 2> home{0, 0};
  if (site.frame.has_position()) {
    home = site.frame.to_local(lon, lat);
  } else {
    buildings.frame = Frame::local({lon, lat});
  }
  while (next()) {
    if (is_blank(line)) {
      continue;
    }
    const auto box = box_of(line);
    if (!box) {
      refuse("six numbers separated by commas");
    }
    const auto& [north, east, up, half_north, half_east, half_up] = *box;
    if (!(half_north > 0 && half_east > 0 && half_up > 0)) {
      refuse("half sizes above 0");
    }
    const Vec3 centre(home[0] + east, home[1] + north, up);
    const Vec3 half(half_east, half_north, half_up);
    buildings.list.push_back(
        {"line " + std::to_string(number), BoxShape{{centre - half, centre + half}}});
  }
  if (buildings.list.empty()) {
    throw Error(file + ": contains no box");
  }
  buildings.notes = {std::to_string(buildings.list.size()) + " boxes"};
  return buildings;
}
}  // namespace altiplan::city
