// SPDX-License-Identifier: Apache-2.0
#include "host/view/basemap.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

#include "altiplan/earth.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/base64.hpp"
#include "host/base/gdal_programs.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

/// What every browser takes as one image on the ground.
constexpr double kMaxPixels = 4096;
/// Of a finer image so many a pixel are read along each side, from its overviews if it has any:
/// filtering all of 10^10 takes minutes.
constexpr double kReadPerPixel = 4;
/// Along each side the places that are brought over exactly; GDAL interpolates between them, by
/// thin plate splines.
constexpr int kPlaces = 10;
constexpr const char* kNeeds = "--basemap";
constexpr std::chrono::minutes kLongest{10};  ///< of GDAL's programs, for images of many gigabytes
/// No other formats are opened: some read further files, or the network.
const Texts kInputs{"-if", "GTiff", "-if", "MBTiles"};

/// Brings an image into a frame, by files in a folder of its own.
class Warp {
 public:
  Warp(std::string file, const Frame& frame, const Box& box)
      : file_(std::move(file)), frame_(frame), box_(box), gdal_(kNeeds, file_, kLongest) {}

  /// A WebP over the box, and nothing where the file has none.
  std::vector<std::byte> operator()() {
    const Json info = info_of(fs::absolute(file_), kInputs);
    Texts translate{"gdal_translate", "-q", "-of", "VRT"};
    translate.insert(translate.end(), kInputs.begin(), kInputs.end());
    const Texts bands = colours(info.at("bands"));
    translate.insert(translate.end(), bands.begin(), bands.end());
    const double metres = metres_per_pixel(info);
    if (const double share = kReadPerPixel * own_metres(info) / metres; share < 1) {
      translate.emplace_back("-outsize");
      for (const Json& pixels : info.at("size")) {
        translate.push_back(std::to_string(std::lround(std::ceil(share * pixels.get<double>()))));
      }
    }
    translate.insert(translate.end(), {fs::absolute(file_), in_folder("source.vrt")});
    run(translate);
    write_file(in_folder("place.vrt"), empty_image(metres));
    run({"gdal_translate", "-q", in_folder("place.vrt"), in_folder("warped.tif")});
    run({"gdalwarp", "-q", "-r", "bilinear", "-to", "DST_METHOD=GCP_TPS", in_folder("source.vrt"),
         in_folder("warped.tif")});
    const Json alpha = info_of(in_folder("warped.tif"), {"-mm"}).at("bands").at(3);
    if (alpha.at("computedMax") == 0) {
      throw Error(file_ + ": shows nothing of the scene: it covers " + covered(info));
    }
    run({"gdal_translate", "-q", "-of", "WEBP", "-co", "QUALITY=85", in_folder("warped.tif"),
         in_folder("warped.webp")});
    const std::string bytes = formats::read_file(in_folder("warped.webp"));
    const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
    return {begin, begin + bytes.size()};
  }

 private:
  std::string in_folder(const char* name) const { return gdal_.in_folder(name); }
  std::string run(Texts arguments) const { return gdal_.run(std::move(arguments)); }

  Json info_of(const std::string& image, const Texts& options) const {
    Texts arguments{"gdalinfo", "-json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.push_back(image);
    std::string printed;
    try {
      printed = run(arguments);
    } catch (const Error& error) {
      if (std::string(error.what()).find("not recognized as a supported") == std::string::npos) {
        throw;
      }
      throw Error(file_ + ": expected a GeoTIFF image, or MBTiles of PNG or JPEG tiles");
    }
    Json info = parse_json(printed);
    if (options == kInputs && !(info.contains("geoTransform") && info.contains("wgs84Extent"))) {
      throw Error(file_ +
                  ": is nowhere on the Earth: it lacks a coordinate system or its corners "
                  "(gdal_translate -a_srs, -a_ullr)");
    }
    return info;
  }

  /// How gdal_translate makes red, green and blue of the bands, and keeps what is transparent.
  Texts colours(const Json& bands) const {
    std::map<std::string, std::size_t> named;
    for (const Json& band : bands) {
      if (band.at("type") != "Byte") {
        throw Error(file_ + ": expected an image of bytes, found numbers (" +
                    band.at("type").get<std::string>() +
                    "); gdal_translate -ot Byte -scale makes one");
      }
      named.emplace(band.at("colorInterpretation"), band.at("band"));
    }
    if (named.contains("Palette")) {
      return {"-expand", "rgba"};
    }
    const bool has_names =
        named.contains("Red") && named.contains("Green") && named.contains("Blue");
    const std::size_t step = bands.size() >= 3 ? 1 : 0;  // grey otherwise
    Texts arguments;
    std::size_t nth = 1;
    for (const char* colour : {"Red", "Green", "Blue"}) {
      arguments.insert(arguments.end(), {"-b", std::to_string(has_names ? named.at(colour) : nth)});
      nth += step;
    }
    const bool has_alpha = named.contains("Alpha");
    if (has_alpha) {
      arguments.insert(arguments.end(), {"-b", std::to_string(named.at("Alpha"))});
    }
    arguments.insert(arguments.end(),
                     {"-colorinterp", std::string("red,green,blue") + (has_alpha ? ",alpha" : "")});
    return arguments;
  }

  static LonLat corner(const Json& info, std::size_t nth) {
    return info.at("wgs84Extent").at("coordinates").at(0).at(nth).get<LonLat>();
  }

  /// The mean of a pixel along the west side of the file.
  static double own_metres(const Json& info) {
    return geodesic_course(corner(info, 0), corner(info, 1)).metres /
           info.at("size").at(1).get<double>();
  }

  /// The same, but large enough for the box.
  double metres_per_pixel(const Json& info) const {
    const Vec3 size = box_.max - box_.min;
    return std::max(std::max(size.x(), size.y()) / kMaxPixels, own_metres(info));
  }

  static std::string covered(const Json& info) {
    LonLat low = corner(info, 0);
    LonLat high = low;
    for (std::size_t nth = 1; nth < 4; ++nth) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], corner(info, nth)[axis]);
        high[axis] = std::max(high[axis], corner(info, nth)[axis]);
      }
    }
    char text[120];
    std::snprintf(text, sizeof text, "longitude %.3f to %.3f and latitude %.3f to %.3f", low[0],
                  high[0], low[1], high[1]);
    return text;
  }

  /// An image over the box for gdal_translate, with the positions of some of its places.
  std::string empty_image(double metres) const {
    const Vec3 size = box_.max - box_.min;
    const double width = std::clamp(std::ceil(size.x() / metres), 1.0, kMaxPixels);
    const double height = std::clamp(std::ceil(size.y() / metres), 1.0, kMaxPixels);
    const LonLat middle =
        frame_.to_lonlat(box_.min.x() + size.x() / 2, box_.min.y() + size.y() / 2);
    char line[200];
    std::snprintf(line, sizeof line, "<VRTDataset rasterXSize=\"%.0f\" rasterYSize=\"%.0f\">\n",
                  width, height);
    std::string text = line;
    text += "<GCPList Projection=\"EPSG:4326\">\n";
    for (int i = 0; i <= kPlaces; ++i) {
      for (int j = 0; j <= kPlaces; ++j) {
        const double east = double(i) / kPlaces;
        const double south = double(j) / kPlaces;
        const auto [lon, lat] =
            frame_.to_lonlat(box_.min.x() + east * size.x(), box_.max.y() - south * size.y());
        std::snprintf(line, sizeof line,
                      "<GCP Pixel=\"%.17g\" Line=\"%.17g\" X=\"%.17g\" Y=\"%.17g\"/>\n",
                      east * width, south * height, longitude_near(lon, middle[0]), lat);
        text += line;
      }
    }
    text += "</GCPList>\n";
    for (const char* colour : {"Red", "Green", "Blue", "Alpha"}) {
      text += std::string("<VRTRasterBand dataType=\"Byte\"><ColorInterp>") + colour +
              "</ColorInterp></VRTRasterBand>\n";
    }
    return text + "</VRTDataset>\n";
  }

  const std::string file_;
  const Frame& frame_;
  const Box& box_;
  GdalPrograms gdal_;
};

/// The ground of a scene, which begins and ends at posts, or its box.
Box area_of(const Json& scene) {
  const Json ground = scene.value("ground", Json());
  if (ground.is_null()) {
    const auto corner = [&](std::size_t nth) {
      const Json& at = scene.at("box").at(nth);
      return Vec3(at.at(0).get<double>(), at.at(1).get<double>(), 0);
    };
    return {corner(0), corner(1)};
  }
  const auto at = [&](const char* origin, const char* count, const char* spacing) {
    const double low = ground.at(origin);
    return std::array{low,
                      low + (ground.at(count).get<int>() - 1) * ground.at(spacing).get<double>()};
  };
  const auto [west, east] = at("x0", "nx", "dx");
  const auto [south, north] = at("y0", "ny", "dy");
  return {{west, south, 0}, {east, north, 0}};
}
}  // namespace

Basemap::Basemap(std::string file) : file_(std::move(file)) {
  if (const std::string why = formats::why_unreadable(file_); !why.empty()) {
    throw formats::InputError("--basemap " + file_, why);
  }
  GdalPrograms::expect_installed(kNeeds);
}

void Basemap::add_to(Json& scene, const Frame& frame) {
  const std::lock_guard lock(mutex_);
  const Box area = area_of(scene);
  Json box{{area.min.x(), area.min.y()}, {area.max.x(), area.max.y()}};
  if (made_.is_null() || made_.at("box") != box) {
    made_ = {{"name", fs::path(file_).filename().string()},
             {"box", std::move(box)},
             {"image", "data:image/webp;base64," + base64(Warp(file_, frame, area)())}};
  }
  scene["basemap"] = made_;
}
}  // namespace altiplan::host
