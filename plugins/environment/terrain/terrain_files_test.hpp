// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "support/support.hpp"

namespace altiplan {

using testing::make_environment;
using Made = std::unique_ptr<Environment>;

inline std::string file_yaml(const std::filesystem::path& file, const std::string& more = "") {
  return "{file: '" + file.string() + "'" + (more.empty() ? "" : ", " + more) + "}";
}

/// The plugin's message for a file that it rejects; "" if it accepts it.
inline std::string refusal(const std::filesystem::path& file, const std::string& more = "",
                           const Site& site = {}) {
  try {
    make_environment("terrain", file_yaml(file, more), site);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

/// Files in a temporary folder.
class MadeFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("altiplan_terrain_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// 5 x 4 posts 100 m apart in UTM 32 N, rows from the north.
  std::filesystem::path grid(const std::string& rows, const std::string& header = "") const {
    write("made.prj",
          "PROJCS[\"UTM32\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
          "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
          "0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER["
          "\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER["
          "\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER["
          "\"false_northing\",0],UNIT[\"metre\",1]]");
    return write("made.asc",
                 "ncols 5\nnrows 4\nxllcorner 500000\nyllcorner 5000000\n"
                 "cellsize 100\n" +
                     header + rows);
  }
  static constexpr const char* kFlat =
      "10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n";
  std::filesystem::path folder_;
};
}  // namespace altiplan
