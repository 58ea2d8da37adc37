// SPDX-License-Identifier: Apache-2.0
#include "altiplan/ground.hpp"

namespace altiplan {

Ground::~Ground() = default;

// Asked at finite positions only, as layers are.
std::optional<double> Ground::height(double x, double y) const {
  return std::isfinite(x) && std::isfinite(y) ? do_height(x, y) : std::nullopt;
}

std::optional<double> Ground::distance(const Vec3& a, const Vec3& b) const {
  return is_finite(a) && is_finite(b) ? do_distance(a, b) : std::nullopt;
}

double Ground::gap(const Vec3& a, const Vec3& b, double enough) const {
  return is_finite(a) && is_finite(b) ? do_gap(a, b, enough) : -kInfinity;
}

double Ground::gap_max(const Vec3& a, const Vec3& b) const {
  return is_finite(a) && is_finite(b) ? do_gap_max(a, b) : kInfinity;
}

double Ground::do_gap_max(const Vec3&, const Vec3&) const { return kInfinity; }
std::optional<double> Ground::do_distance(const Vec3&, const Vec3&) const { return std::nullopt; }
double Ground::do_slope(const Box&) const { return kInfinity; }
bool Ground::do_is_all() const { return false; }
const HeightField* Ground::do_height_field() const { return nullptr; }
}  // namespace altiplan
