// SPDX-License-Identifier: Apache-2.0
// Models that are read without GDAL: the same to the bit as GDAL reads them, which a sidecar file
// that says nothing makes it do.
#include <cstdlib>

#include "altiplan/height_field.hpp"
#include "terrain_files_test.hpp"

namespace altiplan::terrain_plain_test {
namespace {
namespace fs = std::filesystem;

bool is_gdal_open() {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find("libgdal") != std::string::npos) {
      return true;
    }
  }
  return false;
}

constexpr int kWithout = 10;
constexpr int kWith = 11;

class PlainModels : public MadeFiles {
 protected:
  /// Reads the file in a fresh process, which ends with this code.
  void expect_ending(const fs::path& file, const std::string& more, int code) const {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto read_and_end = [&] {
      make_environment("terrain", file_yaml(file, more));
      fs::remove_all(folder_);  // that process's own
      std::_Exit(is_gdal_open() ? kWith : kWithout);
    };
    EXPECT_EXIT(read_and_end(), ::testing::ExitedWithCode(code), "") << file << " " << more;
  }

  /// The same file where a sidecar makes GDAL read it.
  fs::path with_sidecar(const fs::path& file) const {
    fs::create_directories(folder_ / "beside");
    const fs::path copy = folder_ / "beside" / file.filename();
    fs::copy_file(file, copy, fs::copy_options::overwrite_existing);
    write("beside/" + file.filename().string() + ".aux.xml",
          "<PAMDataset><Metadata><MDI key=\"A\">1</MDI></Metadata></PAMDataset>");
    return copy;
  }

  void expect_same(const fs::path& file, const std::string& more = "") const {
    const Made plain = make_environment("terrain", file_yaml(file, more));
    const Made by_gdal = make_environment("terrain", file_yaml(with_sidecar(file), more));
    EXPECT_EQ(plain->info().notes, by_gdal->info().notes) << file;
    const HeightField& a = *plain->ground()->height_field();
    const HeightField& b = *by_gdal->ground()->height_field();
    EXPECT_EQ(a.origin(), b.origin());
    EXPECT_EQ(a.spacing(), b.spacing());
    ASSERT_EQ(a.columns(), b.columns());
    ASSERT_EQ(a.rows(), b.rows());
    int different = 0;
    for (int j = 0; j < a.rows(); ++j) {
      for (int i = 0; i < a.columns(); ++i) {
        different += a.post(i, j) == b.post(i, j) ? 0 : 1;
      }
    }
    EXPECT_EQ(different, 0) << file;
  }

  /// Of the shipped model, by GDAL's own program; empty if that is missing.
  fs::path translated(const std::string& name, const std::string& options) const {
    const fs::path from = testing::configs() / "data/jacksboro_fault.tif";
    const fs::path to = folder_ / name;
    const std::string command = "gdal_translate -q " + options + " '" + from.string() + "' '" +
                                to.string() + "' 2>/dev/null";
    return std::system(command.c_str()) == 0 ? to : fs::path();
  }
};

struct Kind {
  std::string name;
  std::string options;
  bool plain;
  std::string more = {};
};

std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

class Kinds : public PlainModels, public ::testing::WithParamInterface<Kind> {};

TEST_P(Kinds, AreReadAsGdalReadsThem) {
  const Kind& kind = GetParam();
  const fs::path file = translated(kind.name, kind.options);
  if (file.empty()) {
    GTEST_SKIP() << "no gdal_translate (Debian: gdal-bin)";
  }
  fs::remove(folder_ / (kind.name + ".aux.xml"));
  expect_ending(file, kind.more, kind.plain ? kWithout : kWith);
  if (kind.plain) {
    expect_same(file, kind.more);
  }
}

INSTANTIATE_TEST_SUITE_P(
    PlainModels, Kinds,
    ::testing::Values(
        Kind{"stored.tif", "", true}, Kind{"big.tif", "-co BIGTIFF=YES -co ENDIANNESS=BIG", true},
        Kind{"lzw.tif", "-co COMPRESS=LZW -co PREDICTOR=2", true},
        Kind{"tiles.tif", "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32 -co COMPRESS=ZSTD",
             true},
        Kind{"reals.tif", "-ot Float32 -co COMPRESS=DEFLATE -co PREDICTOR=3", true},
        Kind{"naturals.tif", "-ot UInt16 -a_nodata 0", true},
        Kind{"points.tif", "-mo AREA_OR_POINT=Point", true},
        Kind{"voids.tif", "", true, "crs: EPSG:4326, nodata: 300, voids: neighbours"},
        Kind{"filled.tif", "-a_nodata 300", true, "voids: fill_m, fill_m: 12"},
        Kind{"doubles.tif", "-ot Float64", false},
        Kind{"scaled.tif", "-a_scale 0.5 -a_offset 3", false},
        Kind{"datum.tif", "-a_srs EPSG:4267", false},
        Kind{"utm.tif", "-a_srs EPSG:32616 -a_ullr 700000 4060000 740000 4020000", false},
        Kind{"heights.tif", "-a_srs EPSG:4326+5773", false}, Kind{"envi.img", "-of ENVI", false}),
    [](const auto& kind) { return fs::path(kind.param.name).stem().string(); });

std::string srtm() {
  constexpr std::size_t kSide = 1201;
  std::string bytes(2 * kSide * kSide, '\0');
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    const auto height = std::int16_t(int(k * 7919 % 4001) - 300);
    bytes[2 * k] = char(height >> 8);
    bytes[2 * k + 1] = char(height & 0xff);
  }
  return bytes;
}

TEST_F(PlainModels, SrtmTilesAreReadAsGdalReadsThem) {
  const fs::path file = write("S23W068.hgt", srtm());
  expect_ending(file, "", kWithout);
  expect_same(file);
  expect_same(write("N00E006.hgt", srtm()));
  EXPECT_SAYS(refusal(write("N01E007.hgt", srtm().substr(1))), "N01E007.hgt: ");
}

TEST_F(PlainModels, SidecarsAreLeftToGdal) {
  const fs::path file = write("S23W068.hgt", srtm());
  expect_ending(with_sidecar(file), "", kWith);
  const std::string statistics =
      R"(<PAMDataset><PAMRasterBand band="1"><Metadata><MDI key="STATISTICS_MEAN">5</MDI></Metadata>)";
  const auto beside = [&](const std::string& more) {
    write("S23W068.hgt.aux.xml", statistics + more + "</PAMRasterBand></PAMDataset>");
  };
  beside("");
  expect_ending(file, "", kWithout);
  expect_same(file);
  beside("<NoDataValue>7</NoDataValue>");
  expect_ending(file, "", kWith);
}

TEST_F(PlainModels, MasksAreNotTakenForHeights) {
  for (const char* inside : {"YES", "NO"}) {
    const fs::path file =
        translated(std::string("masked_") + inside + ".tif",
                   std::string("--config GDAL_TIFF_INTERNAL_MASK ") + inside + " -mask 1");
    if (file.empty()) {
      GTEST_SKIP() << "no gdal_translate (Debian: gdal-bin)";
    }
    EXPECT_SAYS(refusal(file),
                file.filename().string() + ": marks posts without a height by a mask");
    EXPECT_SAYS(refusal(file, "voids: neighbours"), "by a mask");
  }
}

TEST_F(PlainModels, DamagedOnesAreRefusedAsByGdal) {
  std::ifstream whole(testing::configs() / "data/jacksboro_fault.tif", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  int refused = 0;
  for (std::size_t size = 8; size < bytes.size(); size += bytes.size() / 23) {
    const fs::path file = write("cut.tif", bytes.substr(0, size));
    const auto after_name = [](const std::string& said) {
      return said.substr(std::min(said.rfind("cut.tif"), said.size()));
    };
    const std::string said = after_name(refusal(file));
    EXPECT_EQ(said, after_name(refusal(with_sidecar(file)))) << size;
    refused += said.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 20);
}
}  // namespace
}  // namespace altiplan::terrain_plain_test
