// SPDX-License-Identifier: Apache-2.0
// What the readers make of a file of airspace, and which of its zones hold the places of the
// standard input, one per line ("longitude latitude height ground time", ground may be nan), for
// airspace_peer_test.py.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "altiplan/error.hpp"
#include "altiplan/formats/airspace_index.hpp"
#include "altiplan/formats/input_file.hpp"

namespace {
using namespace altiplan;
using formats::ZoneLimit;

std::string limit_text(const ZoneLimit& limit) {
  constexpr const char* kNames[] = {"none", "ground", "sea", "standard"};
  char text[64];
  std::snprintf(text, sizeof text, "%s %.3f", kNames[int(limit.datum)], limit.metres);
  return text;
}

void print(const formats::Airspace& airspace) {
  constexpr const char* kNames[] = {"keep_out", "ask", "inform"};
  std::cout << "format\t" << formats::format_name(airspace.format) << "\n";
  for (const formats::Zone& zone : airspace.zones) {
    std::cout << "zone\t" << zone.id << "\t" << zone.name << "\t" << zone.type << "\t"
              << kNames[int(zone.restriction)] << "\t" << zone.periods.size() << "\n";
    for (const formats::ZoneVolume& volume : zone.volumes) {
      std::cout << "volume\t" << limit_text(volume.lower) << "\t" << limit_text(volume.upper)
                << "\t" << volume.polygon.outline.size() << "\t" << volume.polygon.holes.size()
                << "\n";
    }
  }
  for (const std::string& note : airspace.notes) {
    std::cout << "note\t" << note << "\n";
  }
  std::cout << "end\n";
}

void answer(const formats::AirspaceIndex& index) {
  std::string lon, lat, z, ground, time;
  while (std::cin >> lon >> lat >> z >> ground >> time) {
    formats::AirspaceIndex::Place place{std::stod(lon), std::stod(lat), std::stod(z),
                                        std::stod(ground)};
    if (std::isnan(*place.ground_m)) {
      place.ground_m.reset();
    }
    std::string found;
    index.visit(place, std::stod(time), std::stod(time), [&](const formats::Zone& zone) {
      found += (found.empty() ? "" : " ") + std::to_string(&zone - index.zones().data());
      return true;
    });
    std::cout << (found.empty() ? "-" : found) << "\n";
  }
}
}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string file = argc > 1 ? argv[1] : "";
    const std::string text = formats::read_file(file);
    const auto start = std::chrono::steady_clock::now();
    const auto airspace = formats::read_airspace(file, text);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    std::cerr << "read in " << spent.count() << " s\n";
    if (!airspace) {
      throw Error(file + ": is no airspace");
    }
    print(*airspace);
    answer(formats::AirspaceIndex(airspace->zones));
    return 0;
  } catch (const Error& error) {
    std::cout << "error\t" << error.what() << "\n";
    return 1;
  }
}
