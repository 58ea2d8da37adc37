// SPDX-License-Identifier: Apache-2.0
// The parser of MAVLink, and the mission protocol with what it finds. The bits of the first byte
// choose signing and where the bytes are cut.
#include "fuzz/memory_file.hpp"
#include "link/mission_transfer.hpp"

namespace {

using altiplan::link::Address;
using altiplan::link::MissionDownload;
using altiplan::link::MissionUpload;
using altiplan::link::Packet;
using altiplan::link::Parser;
using altiplan::link::PlanType;
using altiplan::link::Signer;
using altiplan::link::Time;

constexpr Address kStation{255, 190};
constexpr Address kVehicle{1, 1};

void hear_all(std::string_view bytes, bool is_signed, std::size_t piece) {
  Signer signer({}, 0, [] { return altiplan::link::kSigningMinute; });
  Parser parser(is_signed ? &signer : nullptr);
  MissionUpload upload(PlanType::mission, kStation, kVehicle,
                       std::vector<altiplan::link::MissionItemInt>(3));
  MissionDownload download(PlanType::fence, kStation, kVehicle);
  Time now{0};
  upload.start(now);
  download.start(now);
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    parser.feed(bytes.substr(at, piece));
    while (const std::optional<Packet> packet = parser.next()) {
      upload.take(now, *packet);
      download.take(now, *packet);
    }
    now += Time(100);
    upload.tick(now);
    download.tick(now);
  }
  parser.end();
  while (parser.next()) {
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) {
    hear_all(altiplan::fuzz::text_of(data + 1, size - 1), (data[0] & 1) != 0, data[0] / 2 + 1U);
  }
  return 0;
}
