// SPDX-License-Identifier: Apache-2.0
#include "altiplan/map_system.hpp"

#include <dlfcn.h>
#include <proj.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

/// The functions of PROJ, opened at the first use: it links to fifty libraries.
struct Proj {
#define ALTIPLAN_PROJ_FUNCTIONS(X)    \
  X(proj_context_create)              \
  X(proj_context_destroy)             \
  X(proj_log_level)                   \
  X(proj_create)                      \
  X(proj_destroy)                     \
  X(proj_get_type)                    \
  X(proj_get_name)                    \
  X(proj_crs_get_sub_crs)             \
  X(proj_crs_get_coordinate_system)   \
  X(proj_cs_get_axis_count)           \
  X(proj_cs_get_axis_info)            \
  X(proj_create_crs_to_crs_from_pj)   \
  X(proj_normalize_for_visualization) \
  X(proj_errno_reset)                 \
  X(proj_trans)
#define ALTIPLAN_PROJ_MEMBER(name) decltype(&::name) name;
  ALTIPLAN_PROJ_FUNCTIONS(ALTIPLAN_PROJ_MEMBER)
#undef ALTIPLAN_PROJ_MEMBER
};

Proj open_proj() {
  void* library = ::dlopen(ALTIPLAN_PROJ_SONAME, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw Error(std::string("cannot open PROJ, which knows coordinate systems: ") + ::dlerror());
  }
  Proj proj{};
#define ALTIPLAN_PROJ_OPEN(name) \
  proj.name = reinterpret_cast<decltype(&::name)>(::dlsym(library, #name));
  ALTIPLAN_PROJ_FUNCTIONS(ALTIPLAN_PROJ_OPEN)
#undef ALTIPLAN_PROJ_OPEN
  return proj;
}

const Proj& proj() {
  static const Proj kProj = open_proj();
  return kProj;
}

struct DestroyContext {
  void operator()(PJ_CONTEXT* context) const { proj().proj_context_destroy(context); }
};
struct DestroyPj {
  void operator()(PJ* pj) const { proj().proj_destroy(pj); }
};
using Pj = std::unique_ptr<PJ, DestroyPj>;

struct Axis {
  std::string name;
  std::string direction;
  double unit = 1;  ///< metres or radians
  std::string unit_name;
};
}  // namespace

struct MapSystem::Impl {
  std::unique_ptr<PJ_CONTEXT, DestroyContext> context;
  std::string name;
  Pj to_lonlat;
  double unit_m = 0;
  double metres_per_z = 1;
  std::string z_unit = "metre";
  std::string datum;  ///< of the heights, "" if none is named
  bool above_ellipsoid = false;

  std::vector<Axis> axes_of(const PJ* crs) const {
    const Pj system(proj().proj_crs_get_coordinate_system(context.get(), crs));
    std::vector<Axis> axes;
    const int count = system ? proj().proj_cs_get_axis_count(context.get(), system.get()) : 0;
    for (int n = 0; n < count; ++n) {
      const char* axis = nullptr;
      const char* direction = nullptr;
      const char* unit = nullptr;
      double factor = 1;
      proj().proj_cs_get_axis_info(context.get(), system.get(), n, &axis, nullptr, &direction,
                                   &factor, &unit, nullptr, nullptr);
      axes.push_back({axis, direction, factor, unit});
    }
    return axes;
  }

  /// Of a system with an axis upwards.
  void read_heights(const std::vector<Axis>& axes, const std::string& datum_name) {
    const Axis& up = axes.back();
    if (up.direction != "up") {
      throw Error("expected heights, found the axis '" + up.name + "', which runs " + up.direction);
    }
    metres_per_z = up.unit;
    z_unit = up.unit_name;
    datum = datum_name;
  }
};

MapSystem::MapSystem(const std::string& definition) : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.context.reset(proj().proj_context_create());
  PJ_CONTEXT* context = impl.context.get();
  proj().proj_log_level(context, PJ_LOG_NONE);
  const Pj crs(proj().proj_create(context, definition.c_str()));
  const std::string wrong =
      "expected a coordinate system that PROJ knows (EPSG:7415), found '" + definition + "'";
  if (!crs) {
    throw Error(wrong);
  }
  impl.name = proj().proj_get_name(crs.get());
  Pj horizontal;
  const PJ* plane = crs.get();
  if (proj().proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
    horizontal.reset(proj().proj_crs_get_sub_crs(context, crs.get(), 0));
    const Pj vertical(proj().proj_crs_get_sub_crs(context, crs.get(), 1));
    plane = horizontal.get();
    if (vertical) {
      impl.read_heights(impl.axes_of(vertical.get()), proj().proj_get_name(vertical.get()));
    }
  }
  const std::vector<Axis> axes = plane != nullptr ? impl.axes_of(plane) : std::vector<Axis>{};
  const PJ_TYPE type = plane != nullptr ? proj().proj_get_type(plane) : PJ_TYPE_UNKNOWN;
  const bool is_geographic = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
  if (axes.size() < 2 || (!is_geographic && type != PJ_TYPE_PROJECTED_CRS)) {
    throw Error(wrong + ", which is neither geographic nor projected");
  }
  impl.unit_m = is_geographic ? 0 : axes.front().unit;
  if (axes.size() == 3) {
    impl.read_heights(axes, "the ellipsoid");
    impl.above_ellipsoid = true;
  } else if (impl.datum.empty() && !is_geographic) {
    impl.metres_per_z = axes.front().unit;  // a plane's heights are in its unit
    impl.z_unit = axes.front().unit_name;
  }
  const Pj wgs84(proj().proj_create(context, "EPSG:4326"));
  const Pj there(
      wgs84 ? proj().proj_create_crs_to_crs_from_pj(context, plane, wgs84.get(), nullptr, nullptr)
            : nullptr);
  impl.to_lonlat.reset(there ? proj().proj_normalize_for_visualization(context, there.get())
                             : nullptr);
  if (!impl.to_lonlat) {
    throw Error(wrong + ", from which no way leads to WGS 84");
  }
}

MapSystem::~MapSystem() = default;
MapSystem::MapSystem(MapSystem&&) noexcept = default;
MapSystem& MapSystem::operator=(MapSystem&&) noexcept = default;

const std::string& MapSystem::name() const { return impl_->name; }

double MapSystem::unit_m() const { return impl_->unit_m; }

std::string MapSystem::heights() const {
  return "heights in " + impl_->z_unit +
         (impl_->above_ellipsoid ? ", above the ellipsoid: brought to sea level by EGM96"
          : impl_->datum.empty() ? ", without a datum: taken as above sea level"
                                 : ", above the zero of '" + impl_->datum + "'");
}

std::array<double, 3> MapSystem::to_wgs84(const std::array<double, 3>& p) const {
  proj().proj_errno_reset(impl_->to_lonlat.get());
  PJ_COORD given{};
  given.xyzt = {p[0], p[1], 0, HUGE_VAL};
  const PJ_COORD to = proj().proj_trans(impl_->to_lonlat.get(), PJ_FWD, given);
  const double lon = to.xyz.x;
  const double lat = to.xyz.y;
  if (!(std::abs(lat) <= 90 && std::abs(lon) <= 360)) {
    char text[120];
    std::snprintf(text, sizeof text, "(%.9g, %.9g)", p[0], p[1]);
    throw Error(text + std::string(" is no position in ") + impl_->name);
  }
  const double z = p[2] * impl_->metres_per_z;
  return {lon, lat, impl_->above_ellipsoid ? z - geoid_height(lon, lat) : z};
}
}  // namespace altiplan
