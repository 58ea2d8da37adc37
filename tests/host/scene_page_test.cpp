// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <random>

#include "altiplan/error.hpp"
#include "host/base/base64.hpp"
#include "host/view/chromium.hpp"
#include "host/view/png.hpp"
#include "host/view/viewer_page.hpp"

namespace altiplan::host::scene_page_test {
namespace {

std::string coded(std::string_view text) {
  return base64(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(Base64, IsThatOfTheStandard) {
  const std::pair<const char*, const char*> cases[] = {// RFC 4648, section 10
                                                       {"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : cases) {
    EXPECT_EQ(coded(plain), text);
  }
}

TEST(Base64, ComesBack) {
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 70; ++size) {
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) {
      byte = std::byte(random() & 255);
    }
    EXPECT_EQ(from_base64(base64(bytes)), bytes);
  }
  for (const char* wrong : {"Zg=", "Z", "Zm9v Zg=", "Zm9*", "====", "Z=g=", "=Zg="}) {
    EXPECT_THROW(from_base64(wrong), Error) << wrong;
  }
}

/// The scene that the page holds.
Json scene_in(const std::string& page) {
  const std::string begin = "<script id=\"scene\" type=\"application/json\">";
  const std::size_t at = page.find(begin) + begin.size();
  const std::string text = page.substr(at, page.find("</script>", at) - at);
  EXPECT_EQ(text.find('<'), std::string::npos);
  return Json::parse(text);
}

TEST(ViewerPage, HoldsTheScene) {
  const Json scene{{"message", "</script><!-- \xF1 & é"}, {"n", 1.5}};
  const std::string page = viewer_page(scene);
  EXPECT_EQ(scene_in(page).at("message"), "</script><!-- \xEF\xBF\xBD & é");
  EXPECT_EQ(page.find("/*SCENE*/"), std::string::npos);
  EXPECT_EQ(page.substr(page.size() - 8, 7), "</html>") << "all of the page";
}

/// A list as tools/viewer/src/packed.js unpacks it.
Json unpacked(const Json& list) {
  const std::vector<std::byte> bytes = from_base64(list.at("packed").get<std::string>());
  std::size_t at = 0;
  const auto read = [&] {
    std::uint64_t token = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = std::uint64_t(bytes.at(at++));
      token |= (byte & 127) << shift;
      if (byte < 128) {
        return token;
      }
    }
  };
  std::vector<std::uint64_t> tokens;
  while (at < bytes.size()) {
    const std::uint64_t token = read();
    tokens.resize(tokens.size() + (token == 1 ? read() : 1), token == 1 ? tokens.back() : token);
  }
  const auto per = list.at("per").get<std::size_t>();
  const auto count = list.at("count").get<std::size_t>();
  EXPECT_EQ(tokens.size(), count * std::max<std::size_t>(per, 1));
  Json result = Json::array();
  std::int64_t last = 0;
  std::int64_t step = 0;
  for (std::size_t n = 0; n < tokens.size(); ++n) {
    if (n % count == 0) {
      last = step = 0;
    }
    Json value = nullptr;
    if (tokens[n] != 0) {
      const auto half = std::int64_t((tokens[n] - 1) / 2);
      const std::int64_t now = last + step + (tokens[n] % 2 == 1 ? -half : half);
      step = list.at("order") == 2 ? now - last : 0;
      last = now;
      value = double(now) / 1000;
    }
    if (per > 0 && n < count) {
      result.push_back(Json::array());
    }
    (per > 0 ? result[n % count] : result).push_back(value);
  }
  return result;
}

TEST(ViewerPage, PacksLongListsToTheLastBit) {
  std::mt19937_64 random(3);
  Json scene;
  for (const std::int64_t most : {1L, 100L, 100'000L, 30'000'000'000L}) {
    Json numbers;
    Json points;
    Json even;
    for (int n = 0; n < 200; ++n) {
      const auto any = [&] {
        return double(std::int64_t(random() % (2 * most + 1)) - most) / 1000;
      };
      numbers.push_back(n % 50 == 7 ? Json(nullptr) : Json(any()));
      points.push_back({any(), any(), n % 50 == 9 ? Json(nullptr) : Json(any())});
      even.push_back(std::round(double(n) * double(most) / 7) / 1000);
    }
    scene["numbers " + std::to_string(most)] = numbers;
    scene["points " + std::to_string(most)] = points;
    scene["even " + std::to_string(most)] = even;
  }
  scene["same"] = std::vector<double>(1000, 2.5);
  scene["nothing"] = std::vector<std::nullptr_t>(1000);
  const Json shown = scene_in(viewer_page(scene));
  for (const auto& [key, list] : scene.items()) {
    EXPECT_EQ(unpacked(shown.at(key)), list) << key;
  }
  const auto size_of = [&](const char* key) {
    return shown.at(key).at("packed").get<std::string>().size();
  };
  EXPECT_LT(size_of("even 100000"), 200 * 4 / 3 + 16);
  EXPECT_LT(size_of("same"), 16);
  EXPECT_LT(size_of("nothing"), 16);
}

TEST(ViewerPage, LeavesOtherListsAsTheyAre) {
  Json scene;
  for (int n = 0; n < 70; ++n) {
    scene["fine"].push_back(n / 7.0);
    scene["texts"].push_back("a");
    scene["mixed"].push_back(n % 2 == 0 ? Json(1) : Json{1, 2});
    scene["uneven"].push_back(n % 2 == 0 ? Json{1, 2, 3} : Json{1, 2});
    scene["deep"].push_back(Json{Json{1}, Json{2}});
    scene["huge"].push_back(1e300);
    scene["empty"].push_back(Json::array());
  }
  scene["short"] = {1, 2, 3};
  EXPECT_EQ(scene_in(viewer_page(scene)), scene);
}

TEST(Png, HoldsThePixels) {
  const std::vector<std::uint8_t> pixels{1, 2, 3, 255, 9, 8, 7, 255, 4, 4, 4, 0, 200, 0, 0, 255};
  const std::string file = png(2, 2, pixels);
  EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const std::size_t data = file.find("IDAT") + 4;
  std::string rows(18, '\0');
  uLongf size = rows.size();
  ASSERT_EQ(
      uncompress(reinterpret_cast<Bytef*>(rows.data()), &size,
                 reinterpret_cast<const Bytef*>(file.data() + data), uLong(file.size() - data)),
      Z_OK);
  std::vector<std::uint8_t> back;
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_EQ(rows[9 * row], 1) << "the filter: from the pixel on the left";
    for (std::size_t i = 0; i < 8; ++i) {
      const int left = i < 4 ? 0 : back[8 * row + i - 4];
      back.push_back(std::uint8_t(left + rows[9 * row + 1 + i]));
    }
  }
  EXPECT_EQ(back, pixels);
  EXPECT_THROW(png(2, 3, pixels), Error);
}

TEST(Screenshot, AProgramThatHangsOrDrawsNothingIsSaid) {
  const auto said = [](const char* program, int milliseconds) {
    try {
      screenshot(program, "<html></html>", "", std::chrono::milliseconds(milliseconds));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said("/bin/true", 10'000), "'/bin/true' did not render the page");
  EXPECT_EQ(said("/nowhere", 10'000), "cannot start '/nowhere': No such file or directory");
  const std::string sleeper = ::testing::TempDir() + "/sleeper";
  std::FILE* script = std::fopen(sleeper.c_str(), "w");
  ASSERT_NE(script, nullptr);
  std::fputs("#!/bin/sh\nsleep 600 & sleep 600\n", script);
  std::fclose(script);
  std::filesystem::permissions(sleeper, std::filesystem::perms::owner_all);
  EXPECT_EQ(said(sleeper.c_str(), 100), "'" + sleeper + "' did not render the page within 0 s");
}

TEST(Screenshot, TheNamedChromiumIsTheOnlyOne) {
  ::setenv("ALTIPLAN_CHROMIUM", "/bin/true", 1);
  EXPECT_EQ(find_chromium(), "/bin/true");
  for (const char* wrong : {"", "/nowhere", "/etc/passwd", "/tmp"}) {
    ::setenv("ALTIPLAN_CHROMIUM", wrong, 1);
    EXPECT_EQ(find_chromium(), std::nullopt) << wrong;
  }
  ::unsetenv("ALTIPLAN_CHROMIUM");
}
}  // namespace
}  // namespace altiplan::host::scene_page_test
