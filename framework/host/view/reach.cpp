// SPDX-License-Identifier: Apache-2.0
#include "host/view/reach.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "altiplan/check.hpp"
#include "altiplan/energy.hpp"
#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/home_field.hpp"
#include "host/base/base64.hpp"
#include "host/base/words.hpp"
#include "host/energy/way_home.hpp"
#include "host/view/png.hpp"

namespace altiplan::host {
namespace {

using kit::HomeField;

constexpr double kCells = 3e6;
constexpr double kMaxSlope = 0.25;  // of the diagonal of cells: what is steeper is rarely flown
constexpr double kLines = 8;        // of equal energy, at most
constexpr int kPixels = 1200;       // along the longer side

/// Flat enough for the climbs and descents that may be flown.
Vec3 cell_of(const Request& request) {
  const Vec3 size = request.volume.max - request.volume.min;
  const double slope = std::min(kMaxSlope, std::tan(request.limits.max_slope()));
  const double area = size.x() * size.y();
  const double edge = std::max(std::cbrt(area * size.z() / (kCells * std::max(slope, 1e-3))),
                               std::sqrt(area / kCells));
  return {edge, edge, std::max(slope, 1e-3) * edge};
}

/// 1, 2 or 5 times a power of ten.
double round_step(double step) {
  const double power = std::pow(10, std::floor(std::log10(step)));
  const double share = step / power;
  return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

/// Wh home from the best height above each cell, rows from the south.
class Plan {
 public:
  explicit Plan(const HomeField& field) : counts_(field.lattice().spec().counts) {
    wh_.assign(std::size_t(counts_[0]) * std::size_t(counts_[1]), kInfinity);
    for (int k = 0; k < counts_[2]; ++k) {
      for (int j = 0; j < counts_[1]; ++j) {
        for (int i = 0; i < counts_[0]; ++i) {
          double& wh = wh_[index(i, j)];
          wh = std::min(wh, field.at({i, j, k}));
        }
      }
    }
  }
  int columns() const { return counts_[0]; }
  int rows() const { return counts_[1]; }

  /// Between the middles of cells; infinite where one beside it is.
  double at(double x, double y) const {
    const double east = std::clamp(x - 0.5, 0.0, counts_[0] - 1.0);
    const double north = std::clamp(y - 0.5, 0.0, counts_[1] - 1.0);
    const int i = std::min(int(east), std::max(0, counts_[0] - 2));
    const int j = std::min(int(north), std::max(0, counts_[1] - 2));
    const int i1 = std::min(i + 1, counts_[0] - 1);
    const int j1 = std::min(j + 1, counts_[1] - 1);
    const double u = east - i;
    const double v = north - j;
    const auto part = [&](double share, int column, int row) {
      return share > 0 ? share * wh_[index(column, row)] : 0;
    };
    return part((1 - u) * (1 - v), i, j) + part(u * (1 - v), i1, j) + part((1 - u) * v, i, j1) +
           part(u * v, i1, j1);
  }

 private:
  std::size_t index(int i, int j) const {
    return std::size_t(j) * std::size_t(counts_[0]) + std::size_t(i);
  }
  Cell counts_;
  std::vector<double> wh_;
};

/// Lines of equal energy, and a veil where the battery does not reach.
std::string image_of(const Plan& plan, double available_wh, double step_wh) {
  using Color = std::array<std::uint8_t, 4>;
  constexpr Color kFree{};
  constexpr Color kVeil{60, 60, 60, 130};
  constexpr Color kLine{140, 20, 140, 255};
  constexpr int kWide = 2;  // pixels
  const int scale = std::max(1, kPixels / std::max(plan.columns(), plan.rows()));
  const int width = scale * plan.columns();
  const int height = scale * plan.rows();
  std::vector<int> bands;  // of each pixel; -1: out of reach
  bands.reserve(std::size_t(width) * std::size_t(height));
  for (int row = 0; row < height; ++row) {
    for (int i = 0; i < width; ++i) {
      const double wh = plan.at((i + 0.5) / scale, (height - row - 0.5) / scale);
      bands.push_back(wh <= available_wh ? int(wh / step_wh) : -1);
    }
  }
  const auto band = [&](int i, int row) {
    return bands[std::size_t(std::min(row, height - 1)) * std::size_t(width) +
                 std::size_t(std::min(i, width - 1))];
  };
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * bands.size());
  for (int row = 0; row < height; ++row) {
    for (int i = 0; i < width; ++i) {
      const int here = band(i, row);
      const bool is_line = here != band(i + kWide, row) || here != band(i, row + kWide);
      const Color& color = is_line ? kLine : here >= 0 ? kFree : kVeil;
      rgba.insert(rgba.end(), color.begin(), color.end());
    }
  }
  return png(width, height, rgba);
}
/// The field of ways home, whose picture is added.
HomeField add_field(Json& scene, const Request& request, const Vec3& home) {
  const Energy* energy = request.vehicle.energy.get();
  if (energy == nullptr || !std::isfinite(energy->capacity_wh)) {
    throw Error("--reach: the battery is not known: expected vehicle.energy with capacity_wh");
  }
  HomeField field(request, {home}, cell_of(request), HomeField::energy(request, energy->power));
  const double available = energy->available_wh();
  const double step = round_step(available / kLines);
  const Plan plan(field);
  const std::string image = image_of(plan, available, step);
  const Box box = field.lattice().spec().box();
  const std::string name = "of ways home: a line every " + rounded_text(step, 6) + " Wh, to " +
                           rounded_text(available, 2) + " Wh";
  scene["basemap"] = {
      {"name", name},
      {"box", {{box.min.x(), box.min.y()}, {box.max.x(), box.max.y()}}},
      {"image", "data:image/png;base64," + base64(std::as_bytes(std::span(image)))}};
  return field;
}

void add_sign(Json& scene, const Vec3& at) {
  scene["numbered"].push_back({{"number", "point of no return"}, {"at", {at.x(), at.y(), at.z()}}});
}
}  // namespace

void add_reach(Json& scene, const Mission& mission, const Route& route) {
  const Request& request = mission.request;
  const Vec3 home = route.empty() ? request.start.position : route.front();
  const HomeField field = add_field(scene, request, home);
  if (!route.empty()) {
    const auto last =
        point_of_no_return(route, request, [&](const Vec3& p) { return field.from(p); });
    if (last) {
      add_sign(scene, last->place);
    }
  }
}

void add_reach(Json& scene, const Mission& mission, Vec3 home,
               const std::optional<Vec3>& point_of_no_return) {
  constexpr double kStep = 2;  // metres
  while (home.z() < mission.request.volume.max.z() &&
         !leg_ok(std::nullopt, home, home, mission.request)) {
    home.z() += kStep;
  }
  add_field(scene, mission.request, home);
  if (point_of_no_return) {
    add_sign(scene, *point_of_no_return);
  }
}
}  // namespace altiplan::host
