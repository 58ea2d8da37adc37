// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// The programs that make films. Throws Error naming the Debian package of a missing one.
struct FilmMakers {
  FilmMakers();
  std::filesystem::path chromium;
  std::filesystem::path ffmpeg;
};

/// The default length of a film of a scene with a flight: a thirtieth of the flight, but 20 to 120
/// s, and no longer than the flight itself.
double film_seconds(const Json& scene);

/// Called after each frame with the number of frames done and of all.
using FilmProgress = std::function<void(std::size_t done, std::size_t all)>;

/// The bytes of a film (MP4, H.264, 1,280 x 720 pixels, 25 frames per second) of the first flight
/// of a page, seen from behind the vehicle. Throws Error if a program fails.
std::string film(const FilmMakers& makers, const std::string& page, double seconds,
                 const FilmProgress& progress);
}  // namespace altiplan::host
