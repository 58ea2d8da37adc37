// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <random>

#include "altiplan/error.hpp"
#include "host/output/base64.hpp"
#include "host/output/png.hpp"
#include "host/output/screenshot.hpp"
#include "host/output/viewer_page.hpp"

namespace altiplan::host {
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

TEST(ViewerPage, HoldsTheScene) {
  const Json scene{{"message", "</script><!-- \xF1 & é"}, {"n", 1.5}};
  const std::string page = viewer_page(scene);
  const std::string begin = "<script id=\"scene\" type=\"application/json\">";
  const std::size_t at = page.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::string text =
      page.substr(at + begin.size(), page.find("</script>", at) - at - begin.size());
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(Json::parse(text).at("message"), "</script><!-- \xEF\xBF\xBD & é");
  EXPECT_EQ(page.find("/*SCENE*/"), std::string::npos);
  EXPECT_EQ(page.substr(page.size() - 8, 7), "</html>") << "all of the page";
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
  EXPECT_EQ(said("/bin/true", 10'000), "'/bin/true' did not draw the page");
  EXPECT_EQ(said("/nowhere", 10'000), "cannot start '/nowhere': No such file or directory");
  const std::string sleeper = ::testing::TempDir() + "/sleeper";
  std::FILE* script = std::fopen(sleeper.c_str(), "w");
  ASSERT_NE(script, nullptr);
  std::fputs("#!/bin/sh\nsleep 600 & sleep 600\n", script);
  std::fclose(script);
  std::filesystem::permissions(sleeper, std::filesystem::perms::owner_all);
  EXPECT_EQ(said(sleeper.c_str(), 100), "'" + sleeper + "' did not draw the page within 0 s");
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
}  // namespace altiplan::host
