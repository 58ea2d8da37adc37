// SPDX-License-Identifier: Apache-2.0
#include "memory_files.hpp"

#include <atomic>
#include <cctype>
#include <cstdio>

#include "altiplan/formats/input_file.hpp"
#include "gdal.hpp"

namespace gdal {
namespace {

constexpr std::string_view kFolder = "/vsimem/altiplan_";
constexpr std::size_t kDigits = 8;
constexpr std::size_t kLongestWord = 10;  // of a grid's first line

int byte_of(char c) { return static_cast<unsigned char>(c); }

std::string new_prefix() {
  static std::atomic<unsigned> made = 0;
  char number[kDigits + 1];
  std::snprintf(number, sizeof number, "%08u", made++ % 100'000'000);
  return std::string(kFolder) + number;
}

/// GDAL loses the first number of an ESRI ASCII grid where it is nan and begins its line
/// (OSGeo/gdal#9666): it gets a blank before it.
void indent_first_nan(std::string& grid) {
  for (const char* nan : {"\nnan", "\nNaN", "\nNAN"}) {
    if (const std::size_t at = grid.find(nan); at != std::string::npos) {
      grid.insert(at + 1, " ");
      return;
    }
  }
}
}  // namespace

bool is_text_grid(const std::filesystem::path& file) {
  std::string word;
  altiplan::formats::InputFile stream(file.string());
  for (char c = 0; word.size() < kLongestWord && stream.get(c) && std::isalpha(byte_of(c)) != 0;) {
    word += char(std::tolower(byte_of(c)));
  }
  return word == "ncols" || word == "nrows" || word == "xllcorner" || word == "yllcorner" ||
         word == "xllcenter" || word == "yllcenter" || word == "dx" || word == "dy" ||
         word == "cellsize";
}

MemoryFiles::MemoryFiles(const std::vector<std::filesystem::path>& files) : prefix_(new_prefix()) {
  for (const std::filesystem::path& file : files) {
    contents_.push_back(altiplan::formats::read_file(file.string()));
    if (is_text_grid(file)) {
      indent_first_nan(contents_.back());
    }
  }
  for (std::size_t n = 0; n < files.size(); ++n) {  // now that their addresses are final
    names_.push_back(name_of(files[n]));
    constexpr int kOurs = 0;  // not to be freed by GDAL
    VSILFILE* const made = api().VSIFileFromMemBuffer(names_.back().c_str(),
                                                      reinterpret_cast<GByte*>(contents_[n].data()),
                                                      contents_[n].size(), kOurs);
    if (made != nullptr) {
      api().VSIFCloseL(made);
    }
  }
}

MemoryFiles::~MemoryFiles() {
  for (const std::string& name : names_) {
    api().VSIUnlink(name.c_str());
  }
}

std::string with_own_names(std::string message) {
  for (std::size_t at = 0; (at = message.find(kFolder, at)) != std::string::npos;) {
    message.erase(at, kFolder.size() + kDigits);
  }
  return message;
}
}  // namespace gdal
