// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/camera.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include "altiplan/error.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace {

/// As their makers publish them, at the wide end of zooms.
const std::vector<Camera>& cameras() {
  static const std::vector<Camera> kCameras{
      {"canon_s100", {7.6, 5.7}, {4000, 3000}, 5.2, 0},
      {"dji_mavic_3e", {17.3, 13.0}, {5280, 3956}, 12.29, 0.7},
      {"dji_phantom_4_pro", {13.2, 8.8}, {5472, 3648}, 8.8, 2},
      {"dji_zenmuse_p1_35mm", {35.9, 24.0}, {8192, 5460}, 35, 0.7},
      {"flir_duo_pro_r", {10.88, 8.704}, {640, 512}, 19, 1},
      {"gopro_hero_4", {6.17, 4.55}, {4000, 3000}, 2.98, 0},
      {"micasense_rededge", {4.8, 3.6}, {1280, 960}, 5.5, 0},
      {"ricoh_gr_2", {23.7, 15.7}, {4928, 3264}, 18.3, 0},
      {"sony_a6000_16mm", {23.5, 15.6}, {6000, 4000}, 16, 1},
      {"sony_a7r_2_28mm", {35.814, 23.876}, {7952, 5304}, 28, 1},
      {"sony_dsc_qx30u", {7.82, 5.865}, {5184, 3888}, 4.3, 2},
      {"sony_rx100_2", {13.2, 8.8}, {5472, 3648}, 10.4, 0},
      {"yuneec_e90", {13.3056, 8.656}, {5472, 3648}, 8.29, 1.3},
  };
  return kCameras;
}

/// Letters and digits alone.
std::string plain(const std::string& name) {
  std::string text;
  for (const unsigned char c : name) {
    if (std::isalnum(c) != 0) {
      text += char(std::tolower(c));
    }
  }
  return text;
}

Camera read_camera(const std::filesystem::path& file) {
  const Value value = load_yaml(file);
  Camera camera;
  camera.name = file.stem().string();
  const ParamReport report = bind(camera, &value);
  if (!report.problems.empty()) {
    throw ConfigError(report.problems);
  }
  return camera;
}
}  // namespace

void Camera::describe(Fields& f) {
  f("sensor_mm", sensor_mm).unit("mm").range(0.1, 1000).doc("width and height").required();
  f("image_px", image_px).range(1, 1e6).doc("pixels across and along the flight").required();
  f("focal_mm", focal_mm)
      .unit("mm")
      .range(0.1, 10'000)
      .doc("focal length, not as of 35 mm film")
      .required();
  f("min_interval_s", min_interval_s)
      .unit("s")
      .range(0, 3600)
      .doc("shortest time between two photos; 0: not known");
}

Camera camera_of(const std::string& name_or_file) {
  const std::string extension = std::filesystem::path(name_or_file).extension().string();
  if (extension == ".yaml" || extension == ".yml") {
    return read_camera(name_or_file);
  }
  const std::string wanted = plain(name_or_file);
  std::vector<Camera> found;
  std::string names;
  for (const Camera& camera : cameras()) {
    const std::string known = plain(camera.name);
    if (known == wanted) {
      return camera;
    }
    if (!wanted.empty() && known.find(wanted) != known.npos) {
      found.push_back(camera);
    }
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  if (found.size() != 1) {
    throw Error("--camera: expected a camera's name (" + names +
                ") or a .yaml file with sensor_mm, image_px and focal_mm, found '" + name_or_file +
                "'" + (found.empty() ? "" : ", which " + std::to_string(found.size()) + " have"));
  }
  return found.front();
}
}  // namespace altiplan::host
