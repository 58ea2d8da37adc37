// SPDX-License-Identifier: Apache-2.0
// Published airspace: how fast a file is read, and places asked for at given times.
#include <algorithm>

#include "altiplan/formats/airspace_index.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

using formats::AirspaceIndex;

struct Question {
  AirspaceIndex::Place place;
  double time = 0;
};

/// Around the zones, up to 6,000 m, within ten years.
std::vector<Question> questions(const std::vector<formats::Zone>& zones, std::size_t count) {
  Box box = Box::empty();
  for (const formats::Zone& zone : zones) {
    for (const formats::ZoneVolume& volume : zone.volumes) {
      for (const formats::Point2& corner : volume.polygon.outline) {
        box = box.united({{corner[0], corner[1], -100}, {corner[0], corner[1], 6000}});
      }
    }
  }
  constexpr double kFrom = 1.6e9;  // September 2020
  constexpr double kYears = 3.2e8;
  RandomStream random(1);
  std::vector<Question> all;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 p = random.in(box);
    const double time = kFrom + kYears * random.uniform();
    all.push_back({{p.x(), p.y(), p.z(), 1500 * random.uniform()}, time});
  }
  return all;
}

Json measure(const std::string& file, std::size_t count) {
  const std::string text = formats::read_file(file);
  double before = thread_s();
  const auto airspace = formats::read_airspace(file, text);
  if (!airspace) {
    throw Error(file + ": expected published airspace");
  }
  const double read_s = thread_s() - before;
  const AirspaceIndex index(airspace->zones);
  const std::vector<Question> all = questions(index.zones(), count);
  before = thread_s();
  const auto closed = std::count_if(all.begin(), all.end(), [&](const Question& question) {
    return index.find(question.place, question.time) != nullptr;
  });
  const double asked_s = thread_s() - before;
  return {{"file", file.substr(file.find_last_of('/') + 1)},
          {"bytes", text.size()},
          {"zones", airspace->zones.size()},
          {"read_ms", 1e3 * read_s},
          {"questions_per_s", double(count) / asked_s},
          {"in_a_zone", double(closed) / double(count)}};
}
}  // namespace

void add_airspace(Subcommands& all) {
  const auto files = std::make_shared<std::vector<std::string>>();
  const auto count = std::make_shared<std::size_t>(1'000'000);
  CLI::App& command = all.add("airspace", "read published airspace, ask which zone holds a place",
                              [=](const Given&) {
                                Json rows = Json::array();
                                for (const std::string& file : *files) {
                                  rows.push_back(measure(file, *count));
                                }
                                return Json{{"files", rows}};
                              });
  command.add_option("files", *files, "published airspace, as for the layer zones")->required();
  command.add_option("--questions", *count, "questions of each file")->capture_default_str();
}
}  // namespace altiplan::bench
