// SPDX-License-Identifier: Apache-2.0
// The terrain's reader of elevation models. The first byte chooses the format, the second how voids
// are treated and whether the world has a frame already; where a format has a file beside it
// (ENVI's header, the .prj of an ASCII grid), the text up to the first NUL is that file.
#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "environment/terrain/model.hpp"
#include "fuzz/memory_file.hpp"

namespace {

struct Format {
  const char* name;
  const char* beside;
};
constexpr Format kFormats[] = {{"n36w085.tif", nullptr},
                               {"n36w085.hgt", nullptr},
                               {"n36w085.asc", "n36w085.prj"},
                               {"n36w085.dt0", nullptr},
                               {"n36w085.img", "n36w085.hdr"}};
constexpr std::uintmax_t kBytesOfHgt = 1201 * 1201 * 2;
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) {
    return 0;
  }
  static const altiplan::fuzz::MemoryFolder kFolder;
  const Format& format = kFormats[data[0] % std::size(kFormats)];
  const std::uint8_t options = data[1];
  std::string_view bytes = altiplan::fuzz::text_of(data + 2, size - 2);
  if (format.beside != nullptr) {
    const std::string_view beside = bytes.substr(0, bytes.find('\0'));
    kFolder.write(format.beside, beside);
    bytes.remove_prefix(std::min(bytes.size(), beside.size() + 1));
  }
  terrain::Params params;
  const std::filesystem::path file = kFolder.write(format.name, bytes);
  if (std::string_view(format.name) == "n36w085.hgt") {
    std::filesystem::resize_file(file, kBytesOfHgt);  // GDAL takes no other size
  }
  params.file.text = file.string();
  params.max_posts = 1 << 16;
  params.voids = static_cast<terrain::Voids>(options % 3);
  params.fill_m = 100;
  if ((options & 4) != 0) {
    params.crs = "EPSG:4326";
  }
  if ((options & 8) != 0) {
    params.band = 1;
  }
  const altiplan::World nothing;
  altiplan::Site site;
  site.before = &nothing;
  if ((options & 16) != 0) {
    site.frame = altiplan::Frame::geographic(-85, 36, 36.5);
  }
  try {
    terrain::Model(params, site);
  } catch (const altiplan::Error&) {
  }
  return 0;
}
