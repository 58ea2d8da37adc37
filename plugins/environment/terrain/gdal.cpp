// SPDX-License-Identifier: Apache-2.0
#include "gdal.hpp"

#include <dlfcn.h>

#include <charconv>
#include <cmath>

#include "altiplan/error.hpp"

namespace gdal {
namespace {

Api open() {
  const char* soname = ALTIPLAN_GDAL_SONAME;
  void* library = dlopen(soname, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw altiplan::Error(std::string("GDAL, which reads elevation models, cannot be opened: ") +
                          dlerror());
  }
  Api api{};
  const auto take = [&](auto& function, const char* name) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr) {
      throw altiplan::Error(std::string(soname) + " lacks the function " + name);
    }
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
  };
#define ALTIPLAN_GDAL_TAKE(name) take(api.name, #name);
  ALTIPLAN_GDAL_FUNCTIONS(ALTIPLAN_GDAL_TAKE)
#undef ALTIPLAN_GDAL_TAKE
  api.GDALRegister_GTiff();
  api.GDALRegister_SRTMHGT();
  api.GDALRegister_AAIGrid();
  api.GDALRegister_DTED();
  api.GDALRegister_ENVI();
  // File blocks are read once each: GDAL's default cache of 5 % of the machine's memory would be
  // wasted.
  api.GDALSetCacheMax64(16 << 20);
  return api;
}
}  // namespace

const Api& api() {
  static const Api kApi = open();
  return kApi;
}

Quiet::Quiet() {
  api().CPLErrorReset();
  api().CPLPushErrorHandler(api().CPLQuietErrorHandler);
}

Quiet::~Quiet() { api().CPLPopErrorHandler(); }

std::string last_error() {
  const std::string text = api().CPLGetLastErrorMsg();
  return text.empty() ? "no reason given" : with_own_names(text);
}

Reference copy(OGRSpatialReferenceH reference) {
  Reference made(api().OSRClone(reference));
  api().OSRSetAxisMappingStrategy(made.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return made;
}

Reference reference(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  int code = 0;
  const char* end = crs.data() + crs.size();
  if (crs.compare(0, kPrefix.size(), kPrefix) != 0 ||
      std::from_chars(crs.data() + kPrefix.size(), end, code).ptr != end || code <= 0) {
    return nullptr;
  }
  const Quiet quiet;
  Reference made(api().OSRNewSpatialReference(nullptr));
  if (api().OSRImportFromEPSG(made.get(), code) != OGRERR_NONE &&
      api().OSRImportFromEPSG(made.get(), code) != OGRERR_NONE) {
    return nullptr;  // a database that could not be read is not the cause of a second failure
  }
  api().OSRSetAxisMappingStrategy(made.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return made;
}

Transform::Transform(const Reference& from, const Reference& to) {
  const Quiet quiet;
  transform_.reset(api().OCTNewCoordinateTransformation(from.get(), to.get()));
  if (!transform_) {
    throw altiplan::Error(std::string("no transformation from ") + api().OSRGetName(from.get()) +
                          " to " + api().OSRGetName(to.get()) + ": " + last_error());
  }
}

std::array<double, 2> Transform::operator()(double x, double y) const {
  const Quiet quiet;
  std::array<double, 2> p{x, y};
  if (!api().OCTTransform(transform_.get(), 1, &p[0], &p[1], nullptr) || !std::isfinite(p[0]) ||
      !std::isfinite(p[1])) {
    throw altiplan::Error("the point (" + std::to_string(x) + ", " + std::to_string(y) +
                          ") is outside the requested coordinate system");
  }
  return p;
}
}  // namespace gdal
