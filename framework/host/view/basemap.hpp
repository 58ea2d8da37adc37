// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>

#include "altiplan/frame.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// An image that pages show on the ground, brought into a scene's frame by the programs of GDAL.
class Basemap {
 public:
  /// A GeoTIFF of bytes, or MBTiles of pictures. Throws InputError, or Error naming the Debian
  /// package of GDAL's programs.
  explicit Basemap(std::string file);

  /// Adds the scene's `basemap` over its ground, or its box (tools/viewer/README.md): a pixel is as
  /// large as the file's, but at most 4,096 are along a side. It is made once for one area.
  /// Thread-safe. Throws Error for a file that is none, has no place on the Earth, or lies beside.
  void add_to(Json& scene, const Frame& frame);

 private:
  std::string file_;
  std::mutex mutex_;  ///< guards what follows
  Json made_;
};
}  // namespace altiplan::host
