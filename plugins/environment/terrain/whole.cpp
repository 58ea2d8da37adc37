// SPDX-License-Identifier: Apache-2.0
#include "whole.hpp"

#include <charconv>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "gdal.hpp"

namespace terrain {
namespace {

using gdal::api;

bool is_number(const std::string& word) {
  double value = 0;
  const char* from = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* to = word.data() + word.size();
  const auto [end, error] = std::from_chars(from, to, value);
  return end == to && error != std::errc::invalid_argument;
}

std::string missing_from_ascii(const std::string& file, std::int64_t posts) {
  altiplan::formats::InputFile stream(file);
  std::int64_t found = 0;
  for (std::string word; stream >> word;) {
    if (std::isalpha(static_cast<unsigned char>(word[0])) != 0 && found == 0 && !is_number(word)) {
      stream >> word;  // of the header: a key and its value
      continue;
    }
    if (!is_number(word)) {
      return "expected a height as number " + std::to_string(found + 1) +
             " after the header, found " + altiplan::excerpt(word);
    }
    ++found;
  }
  return found == posts
             ? ""
             : "expected " + std::to_string(posts) + " heights, found " + std::to_string(found);
}

std::string missing_from_envi(const std::string& file, void* dataset, std::int64_t posts) {
  void* band = api().GDALGetRasterBand(dataset, 1);
  const std::int64_t bytes = posts * api().GDALGetRasterCount(dataset) *
                             api().GDALGetDataTypeSizeBytes(api().GDALGetRasterDataType(band));
  const auto size = std::int64_t(std::filesystem::file_size(file));
  return size >= bytes ? ""
                       : "its header declares " + std::to_string(bytes) +
                             " bytes of heights, it has " + std::to_string(size);
}
}  // namespace

std::string missing_from(const std::string& file, void* dataset) {
  const std::string driver = api().GDALGetDriverShortName(api().GDALGetDatasetDriver(dataset));
  const std::int64_t posts =
      std::int64_t(api().GDALGetRasterXSize(dataset)) * api().GDALGetRasterYSize(dataset);
  return driver == "AAIGrid" ? missing_from_ascii(file, posts)
         : driver == "ENVI"  ? missing_from_envi(file, dataset, posts)
                             : "";
}
}  // namespace terrain
