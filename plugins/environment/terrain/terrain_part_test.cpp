// SPDX-License-Identifier: Apache-2.0
// Large models: the part read around the volume gives the same results as the whole model.
#include <cstdlib>

#include "altiplan/check.hpp"
#include "altiplan/height_field.hpp"
#include "altiplan/random.hpp"
#include "terrain_files_test.hpp"

namespace altiplan::terrain_part_test {
namespace {

constexpr int kColumns = 2600;
constexpr int kRows = 2100;
constexpr double kStep = 10;
constexpr int kNoHeight = 30000;  ///< impossible on the Earth: reading it rejects the file
constexpr int kVoid = -9999;

const Box kVolume{{9003, 8001, 0}, {12007, 10509, 900}};

/// Hills with an occasional cliff or spike; rows from the south.
std::int16_t height(int i, int j) {
  const double hills = 300 + 150 * std::sin(i * 0.02) * std::cos(j * 0.017) + 40 * std::sin(i + j);
  const unsigned hash = unsigned(i) * 2654435761U ^ unsigned(j) * 40503U;
  return std::int16_t(hills + ((hash >> 7) % 97 == 0 ? 200 : 0) + ((i / 60 + j / 70) % 5) * 30);
}

class PartOfAModel : public MadeFiles {
 protected:
  using Change = std::function<void(std::vector<std::int16_t>&)>;

  static std::size_t at(int i, int j) {  // rows of the file run from the north
    return std::size_t(kRows - 1 - j) * kColumns + std::size_t(i);
  }

  std::filesystem::path model(const std::string& name, const Change& change = {}) const {
    std::vector<std::int16_t> heights(std::size_t(kColumns) * kRows);
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        heights[at(i, j)] = height(i, j);
      }
    }
    if (change) {
      change(heights);
    }
    write(name + ".hdr", "ENVI\nsamples = " + std::to_string(kColumns) +
                             "\nlines = " + std::to_string(kRows) +
                             "\nbands = 1\nheader offset = 0\nfile type = ENVI Standard\n"
                             "data type = 2\ninterleave = bsq\nbyte order = 0\n"
                             "data ignore value = -9999\n"
                             "map info = {UTM, 1, 1, 400000, 5400000, 10, 10, 32, North, WGS-84}");
    return write(name + ".img", {reinterpret_cast<const char*>(heights.data()),
                                 heights.size() * sizeof heights[0]});
  }
  /// A model that cannot be read as a whole.
  std::filesystem::path half_damaged(const std::string& name) const {
    return model(name, [](auto& heights) { heights[at(3, kRows - 2)] = kNoHeight; });
  }

  static Made part_of(const std::filesystem::path& file, const std::string& more = "",
                      const Box& volume = kVolume) {
    const World nothing;
    Site site;
    site.before = &nothing;
    site.volume = volume;
    site.vehicle.radius_m = 2;
    return make_environment("terrain", file_yaml(file, more), site);
  }
  static Made whole_of(const std::filesystem::path& file, const std::string& more = "") {
    return part_of(file, more, Box{});
  }
};

Vec3 leg_end(RandomStream& random, const Box& box, const Vec3& from) {
  const Vec3 offset = random.uniform(0, 600) * Vec3(random.normal(), random.normal(), 0.1);
  return Vec3(from + offset).cwiseMax(box.min).cwiseMin(box.max);
}

/// Compares everything except clearance, whose bound is the tighter the less is read.
void expect_same_answers(const Environment& part, const Environment& whole, const Box& box,
                         double reach, int count) {
  RandomStream random(11);
  int blocked = 0;
  for (int n = 0; n < count; ++n) {
    Vec3 a = random.in(box);
    if (n % 4 == 0) {  // on a line of posts
      a.x() = kStep * std::round(a.x() / kStep);
    }
    const Vec3 b = n % 7 == 0 ? a : leg_end(random, box, a);
    const double r = reach * random.uniform(0, 1) * random.uniform(0, 1);
    ASSERT_EQ(part.ground()->height(a.x(), a.y()), whole.ground()->height(a.x(), a.y())) << n;
    ASSERT_EQ(part.ground()->gap(a, b), whole.ground()->gap(a, b)) << n;
    ASSERT_EQ(part.ground()->gap_max(a, b), whole.ground()->gap_max(a, b)) << n;
    const Box around = leg_box(a, b).grown(r);
    ASSERT_EQ(part.ground()->slope(around), whole.ground()->slope(around)) << n;
    ASSERT_EQ(part.blocked(a, b, r), whole.blocked(a, b, r)) << n;
    blocked += part.blocked(a, b, r) ? 1 : 0;
    std::vector<Nearby> near[2];
    part.near(a, reach, [&](const Nearby& nearby) { near[0].push_back(nearby); });
    whole.near(a, reach, [&](const Nearby& nearby) { near[1].push_back(nearby); });
    ASSERT_EQ(near[0].size(), near[1].size()) << n;
    for (std::size_t k = 0; k < near[0].size(); ++k) {
      ASSERT_EQ(near[0][k].point, near[1][k].point) << n;
    }
  }
  EXPECT_GT(blocked, count / 10);
  EXPECT_LT(blocked, count * 9 / 10);
}

TEST_F(PartOfAModel, AnswersAsTheWholeWithinTheVolume) {
  const Made whole = whole_of(model("sound"));
  EXPECT_NE(refusal(half_damaged("damaged")), "");
  const Made part = part_of(folder_ / "damaged.img");
  EXPECT_SAYS(part->info().notes[0], "2600 x 2100 posts");
  EXPECT_SAYS(part->info().notes[0], "of them read, around the volume");
  EXPECT_EQ(whole->info().notes[0].find("of them"), std::string::npos);
  EXPECT_LT(part->ground()->height_field()->columns() * part->ground()->height_field()->rows(),
            500'000);
  EXPECT_EQ(part->bounds().min, whole->bounds().min);
  EXPECT_EQ(part->bounds().max, whole->bounds().max);
  expect_same_answers(*part, *whole, kVolume, 60, 2000);
  expect_same_answers(*part, *whole, kVolume, 800, 300);
  // So far only the part was read: beyond it the damage shows.
  try {
    part->ground()->height(30, 20000);
    FAIL() << "the whole was not read";
  } catch (const Error& error) {
    EXPECT_SAYS(std::string(error.what()), "30000 at column 3, row 1");
  }
}

TEST_F(PartOfAModel, AnswersAsTheWholeBeyondTheVolume) {
  const auto file = model("sound");
  const Made whole = whole_of(file);
  const Made part = part_of(file);
  expect_same_answers(*part, *whole, {{-500, -500, 0}, {26500, 21500, 900}}, 400, 500);
  const Box field{{0, 0, 0}, {26000, 21000, 900}};
  RandomStream random(4);
  for (int n = 0; n < 4000; ++n) {
    const Vec3 p = random.in(field);
    const Vec3 q = p + 300 * Vec3(random.normal(), random.normal(), random.normal());
    const double clearance = part->clearance(p);
    EXPECT_LE(std::abs(part->clearance(q) - clearance), (q - p).norm() * (1 + 1e-9) + 1e-9);
    whole->near(p, 5000, [&](const Nearby& nearby) {
      EXPECT_LE(clearance, std::max(nearby.distance, 0.0) + 1e-6) << p.transpose();
    });
  }
}

TEST_F(PartOfAModel, TheJudgeSaysTheSame) {
  const Made whole = whole_of(model("sound"));
  half_damaged("damaged");
  std::shared_ptr<const Environment> layers[] = {part_of(folder_ / "damaged.img"),
                                                 whole_of(folder_ / "sound.img")};
  RandomStream random(8);
  int sound = 0;
  constexpr int kRoutes = 200;
  for (int n = 0; n < kRoutes; ++n) {
    Route route{random.in({{9100, 8100, 500}, {11900, 10400, 890}})};
    for (int k = 0; k < 4; ++k) {
      route.push_back(leg_end(random, kVolume, route.back()));
    }
    std::string said[2];
    for (int k = 0; k < 2; ++k) {
      Request request =
          testing::request_in(testing::world_of(layers[k]), route.front(), route.back(), kVolume);
      request.vehicle.radius_m = 2;
      request.limits.min_clearance = 20;
      request.limits.min_ground_clearance = 30;
      for (const Violation& violation : check(route, request).violations) {
        said[k] += violation.constraint + " at " + std::to_string(violation.at) + "\n";
      }
    }
    EXPECT_EQ(said[0], said[1]);
    sound += said[0].empty() ? 1 : 0;
  }
  EXPECT_GT(sound, kRoutes / 10);
  EXPECT_LT(sound, kRoutes * 9 / 10);
}

TEST_F(PartOfAModel, GridsAreTheSame) {
  const Made whole = whole_of(model("sound"));
  half_damaged("damaged");
  const Made part = part_of(folder_ / "damaged.img");
  GridSpec spec;
  spec.origin = kVolume.min;
  spec.cell = {35, 25, 20};
  spec.counts = {85, 100, 45};
  spec.inflation = 12;
  VoxelGrid of_part(spec);
  VoxelGrid of_whole(spec);
  part->rasterize(of_part);
  whole->rasterize(of_whole);
  EXPECT_TRUE(VoxelGrid::diff(of_part, of_whole).empty());
  EXPECT_GT(of_part.blocked_count(), spec.cell_count() / 10);
}

TEST_F(PartOfAModel, VoidsAreThoseOfThePartOrAskForTheWhole) {
  const auto elsewhere = model("elsewhere", [](auto& heights) { heights[at(9, 9)] = kVoid; });
  EXPECT_SAYS(refusal(elsewhere), "1 of 5460000 posts");
  EXPECT_SAYS(part_of(elsewhere)->info().notes[0], "no voids");
  const auto within = model("within", [](auto& heights) {
    for (int j = 700; j < 1500; ++j) {  // out of the part: its filling comes from both sides
      heights[at(1000, j)] = heights[at(1001, j)] = heights[at(1002, j)] = kVoid;
    }
  });
  try {
    part_of(within);
    FAIL() << "voids were taken";
  } catch (const Error& error) {
    EXPECT_SAYS(std::string(error.what()), "2400 of 5460000 posts");
  }
  const Made filled = part_of(within, "voids: neighbours");
  EXPECT_SAYS(filled->info().notes[0], "2400 voids filled from their neighbours");
  expect_same_answers(*filled, *whole_of(within, "voids: neighbours"), kVolume, 60, 300);
  const Made flat = part_of(within, "voids: fill_m, fill_m: 7");
  EXPECT_SAYS(flat->info().notes[0], "of them read");
  EXPECT_EQ(flat->ground()->height(10010, 9000), 7.0);
  expect_same_answers(*flat, *whole_of(within, "voids: fill_m, fill_m: 7"), kVolume, 60, 300);
}

TEST_F(PartOfAModel, MaxPostsCountsWhatIsRead) {
  const auto file = model("sound");
  EXPECT_SAYS(refusal(file, "max_posts: 1000000"),
              "declares 2600 x 2100 posts, more than max_posts (1000000)");
  const Made part = part_of(file, "max_posts: 1000000");
  EXPECT_TRUE(part->ground()->height(10000, 9000));
  try {
    part->ground()->height(30, 30);
    FAIL() << "more posts than allowed";
  } catch (const Error& error) {
    EXPECT_SAYS(std::string(error.what()), "beyond the part around the volume");
  }
  try {
    part_of(file, "max_posts: 100000");
    FAIL() << "more posts than allowed";
  } catch (const Error& error) {
    EXPECT_SAYS(std::string(error.what()), "of them about the volume, more than max_posts");
  }
}

TEST_F(PartOfAModel, OfOneThatIsTooLargeThePartAboutAMissionIsRead) {
  const auto file = model("sound");
  const Made whole = whole_of(file);
  const World nothing;
  Site site;
  site.before = &nothing;
  const auto [lon, lat] = whole->info().frame->to_lonlat(300, 400);
  site.about = {{lon, lat}};
  const std::string few = file_yaml(file, "max_posts: 5000000");  // of 5,460,000
  const Made part = make_environment("terrain", few, site);
  const auto [x, y] = part->info().frame->to_local(lon, lat);
  EXPECT_NEAR(*part->ground()->height(x, y), *whole->ground()->height(300, 400), 0.5);
  site.about.clear();
  EXPECT_THROW(make_environment("terrain", few, site), Error);
}

TEST_F(PartOfAModel, TilesAndStripsOfATiffAreTheSame) {
  const auto raw = model("sound");
  const Made whole = whole_of(raw);
  for (const std::string layout : {"TILED=YES", "TILED=NO"}) {
    const auto file = folder_ / (layout + ".tif");
    const std::string call = "gdal_translate -q -co COMPRESS=DEFLATE -co " + layout + " '" +
                             raw.string() + "' '" + file.string() + "'";
    if (std::system(call.c_str()) != 0) {
      GTEST_SKIP() << "no gdal_translate";
    }
    expect_same_answers(*part_of(file), *whole, kVolume, 60, 300);
    const Made all = whole_of(file);
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        ASSERT_EQ(all->ground()->height_field()->post(i, j), height(i, j)) << i << ' ' << j;
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::terrain_part_test
