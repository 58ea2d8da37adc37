// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>

#include <array>
#include <memory>
#include <string>
#include <type_traits>

#include "memory_files.hpp"

namespace gdal {

/// The C functions of GDAL that an elevation model needs. The library is opened at the first call
/// of `api()` and stays open: linking it would add 20 to 60 ms to every start of a program.
struct Api {
#define ALTIPLAN_GDAL_FUNCTIONS(X)      \
  X(GDALRegister_GTiff)                 \
  X(GDALRegister_SRTMHGT)               \
  X(GDALRegister_AAIGrid)               \
  X(GDALRegister_DTED)                  \
  X(GDALRegister_ENVI)                  \
  X(GDALOpenEx)                         \
  X(GDALClose)                          \
  X(GDALGetDatasetDriver)               \
  X(GDALGetDriverShortName)             \
  X(GDALGetDataTypeSizeBytes)           \
  X(GDALGetRasterXSize)                 \
  X(GDALGetRasterYSize)                 \
  X(GDALGetRasterCount)                 \
  X(GDALGetRasterBand)                  \
  X(GDALGetGeoTransform)                \
  X(GDALGetSpatialRef)                  \
  X(GDALGetRasterDataType)              \
  X(GDALDataTypeIsComplex)              \
  X(GDALGetRasterNoDataValue)           \
  X(GDALGetMaskFlags)                   \
  X(GDALGetRasterUnitType)              \
  X(GDALGetRasterScale)                 \
  X(GDALGetRasterOffset)                \
  X(GDALGetDataCoverageStatus)          \
  X(GDALRasterIOEx)                     \
  X(GDALGetBlockSize)                   \
  X(GDALSetCacheMax64)                  \
  X(VSIFileFromMemBuffer)               \
  X(VSIFCloseL)                         \
  X(VSIUnlink)                          \
  X(CPLPushErrorHandler)                \
  X(CPLPopErrorHandler)                 \
  X(CPLQuietErrorHandler)               \
  X(CPLErrorReset)                      \
  X(CPLGetLastErrorMsg)                 \
  X(OSRNewSpatialReference)             \
  X(OSRDestroySpatialReference)         \
  X(OSRClone)                           \
  X(OSRImportFromEPSG)                  \
  X(OSRSetAxisMappingStrategy)          \
  X(OSRIsGeographic)                    \
  X(OSRIsProjected)                     \
  X(OSRIsSame)                          \
  X(OSRIsSameGeogCS)                    \
  X(OSRGetLinearUnits)                  \
  X(OSRGetName)                         \
  X(OSRGetAuthorityCode)                \
  X(OSRGetAttrValue)                    \
  X(OSRGetAxesCount)                    \
  X(OSRGetTargetLinearUnits)            \
  X(OCTNewCoordinateTransformation)     \
  X(OCTDestroyCoordinateTransformation) \
  X(OCTTransform)
#define ALTIPLAN_GDAL_MEMBER(name) decltype(&::name) name;
  ALTIPLAN_GDAL_FUNCTIONS(ALTIPLAN_GDAL_MEMBER)
#undef ALTIPLAN_GDAL_MEMBER
};

/// Throws altiplan::Error if the library cannot be opened. Registers only the five drivers above: a
/// VRT may read any file, and others access the network.
const Api& api();

/// Keeps GDAL's messages off stderr; `last_error` reads them. Per thread.
class Quiet {
 public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};
std::string last_error();

struct CloseDataset {
  void operator()(void* dataset) {
    api().GDALClose(dataset);
    files.reset();
  }
  std::shared_ptr<MemoryFiles> files = nullptr;  ///< that it reads, unless it reads from the disk
};
using Dataset = std::unique_ptr<void, CloseDataset>;

struct DestroyReference {
  void operator()(OGRSpatialReferenceH reference) const {
    api().OSRDestroySpatialReference(reference);
  }
};
/// A coordinate system with x east (or longitude) first, regardless of its authority's order.
using Reference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, DestroyReference>;

/// From "EPSG:4326"; null if the form is different or the code unknown.
Reference reference(const std::string& crs);
Reference copy(OGRSpatialReferenceH reference);

/// From one coordinate system to another; one thread at a time. Throws altiplan::Error if there is
/// no transformation between the two, or none for a point.
class Transform {
 public:
  Transform(const Reference& from, const Reference& to);
  std::array<double, 2> operator()(double x, double y) const;

 private:
  struct Destroy {
    void operator()(OGRCoordinateTransformationH transform) const {
      api().OCTDestroyCoordinateTransformation(transform);
    }
  };
  std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>, Destroy> transform_;
};
}  // namespace gdal
