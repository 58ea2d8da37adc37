// SPDX-License-Identifier: Apache-2.0
#include "host/view/film.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/program.hpp"
#include "host/view/chromium.hpp"

namespace altiplan::host {
namespace {

using Clock = Program::Clock;

constexpr int kPerSecond = 25;
constexpr int kPixelsWide = 1280;
constexpr int kPixelsHigh = 720;
constexpr std::uintmax_t kMaxBytes = 4'000'000'000;
/// Without any progress of a program.
constexpr auto kTimeout = std::chrono::seconds(60);

std::vector<std::string> ffmpeg_arguments(const FilmMakers& makers,
                                          const std::filesystem::path& film) {
  return {makers.ffmpeg.string(), "-nostdin", "-loglevel", "error", "-f", "image2pipe",
          "-framerate", std::to_string(kPerSecond), "-c:v", "mjpeg", "-i", "pipe:0", "-c:v",
          "libx264", "-preset", "veryfast", "-crf", "20",
          // What every player shows, and the index first, so that it plays while it loads.
          "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", film.string()};
}

/// Writes frames into a film.
class Encoder {
 public:
  explicit Encoder(const FilmMakers& makers)
      : program_(ffmpeg_arguments(makers, film()), {.wired = {0}, .errors = errors()}),
        name_(makers.ffmpeg.string()) {}

  void add(const std::string& frame) {
    if (!program_.send(frame, Clock::now() + kTimeout)) {
      fail();
    }
  }
  std::string finish() {
    program_.finish_sending();
    if (program_.ended(Clock::now() + kTimeout) != 0) {
      fail();
    }
    return formats::read_file(film().string(), kMaxBytes);
  }

 private:
  std::filesystem::path film() const { return folder_.path() / "film.mp4"; }
  std::filesystem::path errors() const { return folder_.path() / "errors.txt"; }
  [[noreturn]] void fail() {
    const bool runs = !program_.ended(Clock::now() + std::chrono::milliseconds(100));
    const std::string said = formats::read_file(errors().string());
    throw Error("'" + name_ + "' did not make the film: " +
                (runs           ? "no progress within 60 s"
                 : said.empty() ? "it ended early"
                                : said.substr(0, said.find('\n'))));
  }

  TemporaryFolder folder_;  ///< outlives the program that uses it
  Program program_;
  std::string name_;
};

std::filesystem::path needed(const std::optional<std::filesystem::path>& program,
                             const std::string& what) {
  if (!program) {
    throw Error("--mp4 needs " + what);
  }
  return *program;
}
}  // namespace

FilmMakers::FilmMakers()
    : chromium(needed(find_chromium(),
                      "Chromium: install the Debian package 'chromium', or set "
                      "ALTIPLAN_CHROMIUM to its path")),
      ffmpeg(needed(find_on_path({"ffmpeg"}), "ffmpeg: install the Debian package 'ffmpeg'")) {}

double film_seconds(const Json& scene) {
  constexpr double kFaster = 30;
  constexpr double kShortest = 20;
  constexpr double kLongest = 120;
  for (const Json& result : scene.at("results")) {
    if (const Json& flight = result.at("flight"); !flight.is_null()) {
      const auto lasts = flight.at("track").back().at(0).get<double>();
      return std::max(1.0, std::min(lasts, std::clamp(lasts / kFaster, kShortest, kLongest)));
    }
  }
  throw Error("no result has a flight to film");
}

std::string film(const FilmMakers& makers, const std::string& page, double seconds,
                 const FilmProgress& progress) {
  ShownPage shown(makers.chromium, page, "?film&theme=light", kPixelsWide, kPixelsHigh, kTimeout);
  Encoder encoder(makers);
  const auto frames = std::size_t(std::lround(seconds * kPerSecond));
  shown.run("altiplan.film.begin(" + exact_json_text(seconds) + ")");
  for (std::size_t frame = 0; frame < frames; ++frame) {
    shown.run("altiplan.film.frame(" + exact_json_text(double(frame) / kPerSecond) + ")");
    encoder.add(shown.picture("jpeg"));
    progress(frame + 1, frames);
  }
  return encoder.finish();
}
}  // namespace altiplan::host
