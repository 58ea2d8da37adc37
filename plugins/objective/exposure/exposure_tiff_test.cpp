// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "altiplan/error.hpp"
#include "exposure_worlds_test.hpp"

namespace altiplan::exposure_tiff_test {
namespace {
using exposure_test::random_values;
using exposure_test::Values;

/// A little-endian TIFF of floats in one strip.
class TiffText {
 public:
  TiffText(const Values& values, std::uint16_t crs_key, std::uint16_t crs, double west,
           double north, double step, const std::string& metadata = "") {
    std::string pixels;
    for (int j = values.rows - 1; j >= 0; --j) {
      for (int i = 0; i < values.columns; ++i) {
        append(pixels, float(std::isnan(values.at(i, j)) ? -9 : values.at(i, j)));
      }
    }
    add<std::uint16_t>(256, 3, {std::uint16_t(values.columns)});
    add<std::uint16_t>(257, 3, {std::uint16_t(values.rows)});
    add<std::uint16_t>(258, 3, {32});
    add<std::uint16_t>(259, 3, {1});
    add<std::uint16_t>(262, 3, {1});
    add<std::uint32_t>(273, 4, {8});
    add<std::uint16_t>(277, 3, {1});
    add<std::uint16_t>(278, 3, {std::uint16_t(values.rows)});
    add<std::uint32_t>(279, 4, {std::uint32_t(pixels.size())});
    add<std::uint16_t>(339, 3, {3});
    add<double>(33550, 12, {step, step, 0});
    add<double>(33922, 12, {0, 0, 0, west, north, 0});
    add<std::uint16_t>(34735, 3, {1, 1, 0, 2, 1025, 0, 1, 1, crs_key, 0, 1, crs});
    if (!metadata.empty()) {
      add<char>(42112, 2, {metadata.c_str(), metadata.c_str() + metadata.size() + 1});
    }
    add<char>(42113, 2, {'-', '9', '\0'});
    data_ = pixels;
    const std::uint32_t directory = std::uint32_t(8 + pixels.size());
    std::string entries;
    std::string beyond;
    append(entries, std::uint16_t(tags_.size()));
    const std::uint32_t after = directory + 2 + 12 * std::uint32_t(tags_.size()) + 4;
    for (const Tag& tag : tags_) {
      append(entries, tag.name);
      append(entries, tag.type);
      append(entries, tag.count);
      if (tag.bytes.size() <= 4) {
        entries += tag.bytes + std::string(4 - tag.bytes.size(), '\0');
      } else {
        append(entries, std::uint32_t(after + beyond.size()));
        beyond += tag.bytes + std::string(tag.bytes.size() % 2, '\0');
      }
    }
    append(entries, std::uint32_t(0));
    text_ = "II";
    append(text_, std::uint16_t(42));
    append(text_, directory);
    text_ += data_ + entries + beyond;
  }
  const std::string& text() const { return text_; }

 private:
  struct Tag {
    std::uint16_t name;
    std::uint16_t type;
    std::uint32_t count;
    std::string bytes;
  };
  template <class T>
  static void append(std::string& text, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    text.append(bytes, sizeof(T));
  }
  template <class T>
  void add(std::uint16_t name, std::uint16_t type, std::vector<T> values) {
    Tag tag{name, type, std::uint32_t(values.size()), ""};
    for (const T value : values) {
      append(tag.bytes, value);
    }
    tags_.push_back(std::move(tag));
  }

  std::vector<Tag> tags_;
  std::string data_;
  std::string text_;
};

/// The objective of a file, in a world of that frame.
std::unique_ptr<Objective> made(const std::string& text, const Frame& frame) {
  const testing::TempFolder folder;
  const std::string file = folder.write("field.tif", text).string();
  return testing::make_objective("exposure", "{file: '" + file + "', elsewhere: 0}", frame);
}

Values some_values() {
  SplitMix64 random(1);
  return random_values(random, true);
}

TEST(ExposureTiff, DegreesAreAGridInAGeographicFrame) {
  const Values values = some_values();
  const Frame frame = Frame::geographic(10, 50, 50);
  // Cells of a thousandth of a degree, the corner of the south-western one at the origin.
  const TiffText tiff(values, 2048, 4326, 10, 50 + values.rows * 1e-3, 1e-3);
  const auto objective = made(tiff.text(), frame);
  const Request request = testing::request_in({}, {0, 0, 0}, {1, 0, 0}, {{0, 0, 0}, {9, 9, 9}});
  for (int j = 0; j < values.rows; ++j) {
    for (int i = 0; i < values.columns; ++i) {
      const auto [x, y] = frame.to_local(10 + (i + 0.5) * 1e-3, 50 + (j + 0.5) * 1e-3);
      const double up = objective->cost(Leg::straight({x, y, 0}, {x, y, 10}), 0, request);
      if (!std::isnan(values.at(i, j))) {  // beside a void the cell on the other side decides
        EXPECT_TRUE(std::abs(up - 10 * values.at(i, j)) < 1e-3 || up == 0) << i << " " << j;
      }
    }
  }
}

TEST(ExposureTiff, WithoutASystemItIsInTheWorldsMetres) {
  const Values values = some_values();
  constexpr std::uint16_t kModel = 1024;
  constexpr std::uint16_t kUserDefined = 32767;
  const double west = values.south_west.x() - values.step / 2;
  const double north = values.south_west.y() + (values.rows - 0.5) * values.step;
  const TiffText tiff(values, kModel, kUserDefined, west, north, values.step);
  const auto from_tiff = made(tiff.text(), Frame());
  const auto from_text = exposure_test::objective_of(values, ", elsewhere: 0");
  SplitMix64 random(2);
  const Request request = testing::request_in({}, {0, 0, 0}, {1, 0, 0}, {{0, 0, 0}, {9, 9, 9}});
  for (int n = 0; n < 50; ++n) {
    const Leg leg = Leg::straight({150 * random.uniform(), 120 * random.uniform(), 3},
                                  {150 * random.uniform(), 120 * random.uniform(), 8});
    EXPECT_EQ(from_tiff->cost(leg, 0, request), from_text->cost(leg, 0, request));
  }
  const TiffText projected(values, kModel, 1, west, north, values.step);
  EXPECT_THROW(made(projected.text(), Frame()), ParameterError);  // in a system without a number
}

TEST(ExposureTiff, WhatIsNoGridInTheFrameIsRefused) {
  const auto refusal = [](const std::string& text, const Frame& frame) -> std::string {
    try {
      made(text, frame);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "";
  };
  const Values values = some_values();
  // A system of metres, in which north is not that of the frame.
  const TiffText utm(values, 3072, 32632, 700000, 5600000, 5000);
  EXPECT_NE(refusal(utm.text(), Frame::geographic(12, 50, 50)).find("gdalwarp"), std::string::npos);
  EXPECT_NE(refusal(utm.text(), Frame()).find("no place on the Earth"), std::string::npos);
  const TiffText own(values, 3072, 32767, 0, 0, 10);
  EXPECT_NE(refusal(own.text(), Frame()).find("none of EPSG's"), std::string::npos);
  const TiffText scaled(
      values, 2048, 4326, 10, 51, 1e-3,
      "<GDALMetadata>\n  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">10</Item>"
      "\n</GDALMetadata>\n");
  EXPECT_NE(refusal(scaled.text(), Frame::geographic(10, 50, 50)).find("scale or an offset"),
            std::string::npos);
  EXPECT_NE(refusal("no TIFF", Frame()).find("is no TIFF file"), std::string::npos);
  std::string cut = utm.text();
  cut.resize(40);
  EXPECT_NE(refusal(cut, Frame()), "");
}
}  // namespace
}  // namespace altiplan::exposure_tiff_test
