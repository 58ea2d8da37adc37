// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "altiplan/earth.hpp"
#include "altiplan/error.hpp"
#include "altiplan/map_system.hpp"

namespace altiplan {
namespace {

constexpr const char* kGrid = "egm96_15.gtx";

/// Where PROJ keeps its data.
std::filesystem::path grid_file() {
  for (const char* variable : {"PROJ_DATA", "PROJ_LIB"}) {
    if (const char* folder = std::getenv(variable)) {
      const std::filesystem::path file = std::filesystem::path(folder) / kGrid;
      if (std::filesystem::exists(file)) {
        return file;
      }
    }
  }
  return std::filesystem::path(ALTIPLAN_PROJ_DATA) / kGrid;
}

/// A grid of NOAA's VDatum (.gtx): latitude and longitude of the south-west post, steps, rows,
/// columns, and the heights row by row from there, all with their highest byte first.
class GeoidGrid {
 public:
  GeoidGrid() {
    std::ifstream in(grid_file(), std::ios::binary);
    south_ = number<double, std::uint64_t>(in);
    west_ = number<double, std::uint64_t>(in);
    step_lat_ = number<double, std::uint64_t>(in);
    step_lon_ = number<double, std::uint64_t>(in);
    rows_ = number<std::int32_t, std::uint32_t>(in);
    columns_ = number<std::int32_t, std::uint32_t>(in);
    constexpr int kMax = 10'000;
    const bool is_whole = in && rows_ > 1 && columns_ > 1 && rows_ <= kMax && columns_ <= kMax &&
                          std::abs(columns_ * step_lon_ - 360) < 1e-6;
    for (int n = 0; is_whole && n < rows_ * columns_; ++n) {
      heights_.push_back(number<float, std::uint32_t>(in));
    }
    if (!is_whole || !in) {
      throw Error(std::string("cannot bring heights above the ellipsoid to sea level without the "
                              "geoid: expected the grid ") +
                  kGrid + " in " + grid_file().parent_path().string() +
                  " (Debian: proj-data), or convert the file (gdalwarp -t_srs EPSG:4326+5773)");
    }
  }

  double height(double lon, double lat) const {
    const double east = std::fmod(std::fmod(lon - west_, 360) + 360, 360) / step_lon_;
    const double north = std::clamp((lat - south_) / step_lat_, 0.0, double(rows_ - 1));
    const int j = std::min(int(north), rows_ - 2);
    const int i = int(east) % columns_;
    const double u = east - std::floor(east);
    const double v = north - j;
    const auto at = [&](int column, int row) {
      return double(
          heights_[std::size_t(row) * std::size_t(columns_) + std::size_t(column % columns_)]);
    };
    return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
           v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
  }

 private:
  template <class Number, class Bits>
  static Number number(std::ifstream& in) {
    unsigned char bytes[sizeof(Bits)] = {};
    in.read(reinterpret_cast<char*>(bytes), sizeof bytes);
    Bits bits = 0;
    for (const unsigned char byte : bytes) {
      bits = Bits(bits << 8 | byte);
    }
    return std::bit_cast<Number>(bits);
  }

  double south_, west_, step_lat_, step_lon_;
  std::int32_t rows_, columns_;
  std::vector<float> heights_;
};
}  // namespace

double geoid_height(double lon, double lat) {
  static const GeoidGrid kGeoid;
  return kGeoid.height(lon, lat);
}
}  // namespace altiplan
