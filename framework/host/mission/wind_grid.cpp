// SPDX-License-Identifier: Apache-2.0
#include "host/mission/wind_grid.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/geometry.hpp"
#include "host/base/gdal_programs.hpp"
#include "host/base/json.hpp"

namespace altiplan::host {
namespace {

using Place = std::array<double, 2>;

constexpr double kMaxCells = 4e6;
constexpr std::chrono::seconds kLongest{60};  ///< of GDAL's programs
/// No other formats are opened: some read further files, or the network.
const std::vector<std::string> kInputs{"-if", "GTiff", "-if", "GRIB"};
/// Faster than any wind: a file in other units, or of other things.
constexpr double kFastest = 150;
/// Of a cell: how far its borders may lie off the file's, whose winds are of a cell's whole extent.
constexpr double kAstray = 0.1;

/// A file's bands as GDAL reads them.
class File {
 public:
  File(const std::string& file, const std::vector<int>& bands)
      : file_(file), gdal_("wind.grid", file, kLongest) {
    if (const std::string why = formats::why_unreadable(file); !why.empty()) {
      throw Error(file + ": " + why);
    }
    const Json info = described();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      counts_[axis] = info.at("size").at(axis).get<int>();
    }
    if (double(counts_[0]) * double(counts_[1]) > kMaxCells) {
      refuse("has more than " + std::to_string(std::size_t(kMaxCells)) +
             " cells: cut those of the volume out of it (gdal_translate -projwin)");
    }
    const Json& transform = info.value("geoTransform", Json());
    if (transform.is_null() || transform.at(2) != 0 || transform.at(4) != 0 ||
        !(transform.at(1) > 0 && transform.at(5) < 0)) {
      refuse(
          "has no georeference of a corner and a cell size, from the north: gdalwarp writes one");
    }
    step_ = {transform.at(1).get<double>(), -transform.at(5).get<double>()};
    south_west_ = {transform.at(0).get<double>(),
                   transform.at(3).get<double>() - counts_[1] * step_[1]};
    const Json system = info.value("coordinateSystem", Json::object());
    const std::string wkt = system.value("wkt", "");
    is_geographic_ = wkt.starts_with("GEOG");
    const bool is_local = wkt.starts_with("ENGCRS") && all_within(wkt, "LENGTHUNIT", 1, 1);
    if (!wkt.empty() && !is_geographic_ && !is_local) {
      refuse(
          "is not in longitudes and latitudes, and its directions may not be east and north: "
          "warp it, and turn its vectors");
    }
    if (is_geographic_ && !is_usual(wkt)) {
      refuse(
          "is not in degrees of the Earth from Greenwich: gdalwarp -t_srs EPSG:4326 brings it "
          "there");
    }
    read(info.at("bands"), bands.empty() ? bands_of(info.at("bands")) : bands);
  }

  bool is_geographic() const { return is_geographic_; }
  const Place& step() const { return step_; }
  std::optional<double> valid_s() const { return valid_s_; }
  /// South-west corner of the cell that holds a place.
  Place corner(const Place& place) const {
    Place corner{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double at = std::floor((place[axis] - south_west_[axis]) / step_[axis]);
      corner[axis] = south_west_[axis] + at * step_[axis];
    }
    return corner;
  }
  /// Toward east and north at a place. Throws Error where there is none.
  std::array<float, 2> at(const Place& given) const {
    Place place = given;
    if (is_geographic_) {
      constexpr double kTurn = 360;
      place[0] -= kTurn * std::floor((place[0] - south_west_[0]) / kTurn);
    }
    const double i = std::floor((place[0] - south_west_[0]) / step_[0]);
    const double j = std::floor((place[1] - south_west_[1]) / step_[1]);
    if (!(i >= 0 && j >= 0 && i < counts_[0] && j < counts_[1])) {
      refuse("does not cover the volume: none of its cells lies at " + text(given));
    }
    const std::size_t cell =
        (std::size_t(counts_[1]) - 1 - std::size_t(j)) * std::size_t(counts_[0]) + std::size_t(i);
    const std::array<float, 2> wind{values_[0][cell], values_[1][cell]};
    if (!(std::hypot(double(wind[0]), double(wind[1])) <= kFastest)) {
      refuse("has no wind of up to " + std::to_string(int(kFastest)) + " m/s at " + text(given));
    }
    return wind;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Error(file_ + ": " + why); }
  std::string text(const Place& place) const {
    return (is_geographic_ ? "longitude " : "x ") + std::to_string(place[0]) +
           (is_geographic_ ? ", latitude " : ", y ") + std::to_string(place[1]);
  }

  std::string gdal(const char* program, const std::vector<std::string>& options,
                   const std::string& output) const {
    std::vector<std::string> arguments{program};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), kInputs.begin(), kInputs.end());
    arguments.push_back(std::filesystem::absolute(file_));
    if (!output.empty()) {
      arguments.push_back(output);
    }
    return gdal_.run(std::move(arguments));
  }

  Json described() const {
    // The keys of a GeoTIFF have its unit, which a code that it names as well may hide.
    const std::string printed =
        gdal("gdalinfo", {"-json", "--config", "GTIFF_SRS_SOURCE", "GEOKEYS"}, {});
    try {
      return parse_json(printed);
    } catch (const Json::exception&) {  // it writes nan
      refuse("has a georeference, or values, that gdalinfo cannot describe");
    }
  }

  /// Whether a coordinate system has parts NAME["name",number,...], all with numbers so large.
  static bool all_within(const std::string& wkt, const std::string& name, double from, double to) {
    const std::string opens = name + "[\"";
    std::size_t at = wkt.find(opens);
    bool within = at != wkt.npos;
    for (; at != wkt.npos; at = wkt.find(opens, at + 1)) {
      const std::size_t comma = wkt.find("\",", at + opens.size());
      const double number = comma == wkt.npos ? NAN : std::strtod(wkt.c_str() + comma + 2, nullptr);
      within = within && number >= from && number <= to;
    }
    return within;
  }

  /// Whether longitudes and latitudes are in degrees, from Greenwich, on an ellipsoid (GRIB: or a
  /// sphere) of the Earth's size.
  static bool is_usual(const std::string& wkt) {
    return all_within(wkt, "PRIMEM", 0, 0) &&
           all_within(wkt, "ANGLEUNIT", radians(1) - 1e-9, radians(1) + 1e-9) &&
           all_within(wkt, "ELLIPSOID", 6.36e6, 6.39e6);
  }

  /// Throws Error unless a band holds plain metres a second.
  void expect_plain(const Json& band) const {
    const std::string name = "band " + std::to_string(band.at("band").get<int>());
    if (band.value("scale", 1.0) != 1 || band.value("offset", 0.0) != 0) {
      refuse(name + " has a scale or an offset: gdal_translate -unscale writes plain values");
    }
    if (band.value("type", "").starts_with("C")) {
      refuse(name + " holds complex numbers, expected metres a second");
    }
    const Json mask = band.value("mask", Json::object()).value("flags", Json::array());
    if (std::find(mask.begin(), mask.end(), "PER_DATASET") != mask.end()) {
      refuse(name + " has a mask of cells without values: gdal_translate -mask none drops it");
    }
    const std::string unit = band.value("unit", "");
    constexpr std::array kUnits{"", "m/s", "[m/s]", "m s-1", "m s**-1", "metre/second"};
    if (std::find(kUnits.begin(), kUnits.end(), unit) == kUnits.end()) {
      refuse(name + " is in '" + unit + "', expected m/s");
    }
  }

  /// "ELEMENT", "SHORT_NAME" (the height) or "VALID_TIME" of a band of GRIB; "" of others.
  static std::string grib(const Json& band, const std::string& key) {
    return band.value("metadata", Json::object())
        .value("", Json::object())
        .value("GRIB_" + key, "");
  }
  static std::string element(const Json& band) { return grib(band, "ELEMENT"); }

  /// Throws Error unless both bands are of one height and one hour, which is kept.
  void expect_together(const Json& east, const Json& north) {
    for (const char* key : {"SHORT_NAME", "VALID_TIME"}) {
      if (grib(east, key) != grib(north, key)) {
        refuse("the bands are of two " + std::string(key[0] == 'S' ? "heights" : "hours") + ", " +
               grib(east, key) + " and " + grib(north, key));
      }
    }
    if (const std::string valid = grib(east, "VALID_TIME"); !valid.empty()) {
      valid_s_ = std::strtod(valid.c_str(), nullptr);
    }
  }

  std::vector<int> bands_of(const Json& bands) const {
    std::vector<int> found;
    for (const char* name : {"UGRD", "VGRD"}) {
      for (const Json& band : bands) {
        if (element(band) == name) {
          found.push_back(band.at("band").get<int>());
        }
      }
    }
    if (found.empty() && bands.size() == 2 && element(bands.at(0)).empty()) {
      return {1, 2};
    }
    if (found.size() != 2) {
      refuse(bands.size() < 2
                 ? "has one band, expected two: winds toward east and north"
                 : "has " + std::to_string(bands.size()) +
                       " bands: give bands, the numbers of those toward east and north of one "
                       "height and hour (gdalinfo lists them)");
    }
    return found;
  }

  void read(const Json& bands, const std::vector<int>& numbers) {
    std::vector<std::string> options{"-q",      "-of", "ENVI",          "-ot",
                                     "Float32", "-co", "INTERLEAVE=BSQ"};
    if (numbers[0] == numbers[1]) {
      refuse("bands are the same twice, expected those toward east and north");
    }
    for (std::size_t n = 0; n < 2; ++n) {
      if (std::size_t(numbers[n]) > bands.size()) {
        refuse("has no band " + std::to_string(numbers[n]));
      }
      const Json& band = bands.at(std::size_t(numbers[n]) - 1);
      expect_plain(band);
      const std::string name = element(band);
      if (!name.empty() && name != (n == 0 ? "UGRD" : "VGRD")) {
        refuse("band " + std::to_string(numbers[n]) + " is " + name + ", expected " +
               (n == 0 ? "UGRD, toward east" : "VGRD, toward north"));
      }
      options.insert(options.end(), {"-b", std::to_string(numbers[n])});
    }
    expect_together(bands.at(std::size_t(numbers[0]) - 1), bands.at(std::size_t(numbers[1]) - 1));
    gdal("gdal_translate", options, gdal_.in_folder("wind.bin"));
    const std::string bytes = formats::read_file(gdal_.in_folder("wind.bin"));
    const std::size_t cells = std::size_t(counts_[0]) * std::size_t(counts_[1]);
    if (bytes.size() != 2 * cells * sizeof(float)) {
      refuse("is damaged");
    }
    for (std::size_t n = 0; n < 2; ++n) {
      values_[n].resize(cells);
      std::memcpy(values_[n].data(), bytes.data() + n * cells * sizeof(float),
                  cells * sizeof(float));
      const Json none = bands.at(std::size_t(numbers[n]) - 1).value("noDataValue", Json());
      if (none.is_number()) {
        std::replace(values_[n].begin(), values_[n].end(), none.get<float>(), NAN);
      }
    }
  }

  std::string file_;
  GdalPrograms gdal_;
  std::array<int, 2> counts_{};
  Place step_{};
  Place south_west_{};
  bool is_geographic_ = false;
  std::optional<double> valid_s_;
  std::array<std::vector<float>, 2> values_;  ///< rows from the north
};

/// Places of the file and of the frame, and how directions turn between them.
class Places {
 public:
  Places(const File& file, const Frame& frame) : is_same_(!file.is_geographic()), frame_(frame) {
    if (!is_same_ && !frame.has_position()) {
      throw Error(
          "it is in longitudes and latitudes, but the world has no place on the Earth: give "
          "frame, or a layer with one");
    }
  }
  Place local(const Place& of_file) const {
    return is_same_ ? of_file : frame_.to_local(of_file[0], of_file[1]);
  }
  Place of_file(const Place& local) const {
    return is_same_ ? local : frame_.to_lonlat(local[0], local[1]);
  }
  std::array<float, 2> turned(const std::array<float, 2>& wind, const Place& at) const {
    if (is_same_) {
      return wind;
    }
    constexpr double kAside = 1e-4;  // degrees
    const Place here = frame_.to_local(at[0], at[1]);
    const Place east = frame_.to_local(at[0] + kAside, at[1]);
    const double length = std::hypot(east[0] - here[0], east[1] - here[1]);
    const double x = (east[0] - here[0]) / length;
    const double y = (east[1] - here[1]) / length;
    return {float(wind[0] * x - wind[1] * y), float(wind[0] * y + wind[1] * x)};
  }

 private:
  bool is_same_;
  const Frame& frame_;
};

/// Throws Error where borders that are straight in the frame, `step` apart from the file's cell at
/// `corner`, are not about the file's: meridians converge, and parallels bend.
void expect_straight(const std::string& name, const File& file, const Places& places,
                     const Place& corner, const Place& step, const Box& volume) {
  constexpr int kParts = 8;  // what grows away from the cell is seen at the volume's edges
  const Place near = places.local(corner);
  for (int place = 0; place < (kParts + 1) * (kParts + 1); ++place) {
    const std::div_t part = std::div(place, kParts + 1);
    const Vec3 local =
        volume.min + Vec3(part.rem, part.quot, 0).cwiseProduct(volume.max - volume.min) / kParts;
    const Place of_file = places.of_file({local.x(), local.y()});
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double from = of_file[axis] - corner[axis];
      if (axis == 0 && file.is_geographic()) {
        from = std::remainder(from, 360);
      }
      const double off = std::abs(from / file.step()[axis] -
                                  (local[Eigen::Index(axis)] - near[axis]) / step[axis]);
      if (!(step[axis] > 0 && off <= kAstray)) {
        throw Error(name +
                    ": the volume is too large for its cells: their borders are not straight, but "
                    "more than a tenth of a cell off: cut the volume, or give the wind in the "
                    "world's metres");
      }
    }
  }
}
}  // namespace

WindFile read_wind_grid(const std::string& name, const std::vector<int>& bands, const Frame& frame,
                        const Box& volume) {
  const File file(name, bands);
  const Places places(file, frame);
  const Vec3 middle = (volume.min + volume.max) / 2;
  // Borders are those of the file's cell in the middle, and of others as large.
  const Place corner = file.corner(places.of_file({middle.x(), middle.y()}));
  const Place near = places.local(corner);
  const Place step{places.local({corner[0] + file.step()[0], corner[1]})[0] - near[0],
                   places.local({corner[0], corner[1] + file.step()[1]})[1] - near[1]};
  expect_straight(name, file, places, corner, step, volume);
  Place south_west{};
  std::array<int, 2> counts{};
  double cells = 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto at = Eigen::Index(axis);
    const double before = std::ceil((near[axis] - volume.min[at]) / step[axis]);
    south_west[axis] = near[axis] - before * step[axis];
    const double count = std::max(1.0, std::ceil((volume.max[at] - south_west[axis]) / step[axis]));
    cells *= count;
    if (!(cells <= kMaxCells)) {
      throw Error(name + ": has more than " + std::to_string(std::size_t(kMaxCells)) +
                  " cells in the volume");
    }
    counts[axis] = int(count);
  }
  std::vector<std::array<float, 2>> velocities;
  for (int j = 0; j < counts[1]; ++j) {
    for (int i = 0; i < counts[0]; ++i) {
      // Of the edge cells, a place within the volume.
      const Vec3 centre(south_west[0] + (i + 0.5) * step[0], south_west[1] + (j + 0.5) * step[1],
                        0);
      const Vec3 inside = centre.cwiseMax(volume.min).cwiseMin(volume.max);
      const Place at = places.of_file({inside.x(), inside.y()});
      velocities.push_back(places.turned(file.at(at), at));
    }
  }
  return {std::make_shared<WindGrid>(south_west, step, counts, std::move(velocities)),
          file.valid_s()};
}
}  // namespace altiplan::host
