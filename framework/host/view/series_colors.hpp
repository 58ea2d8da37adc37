// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace altiplan::host {

/// The colour of a route or of a pipeline on white and on the dark paper of pages.
struct SeriesColor {
  const char* light;
  const char* dark;
};
/// Distinguishable with every kind of colour vision, from the paper, and from threats and zones
/// (series_colors_test). tools/viewer/src/colors.js has the same.
inline constexpr std::array<SeriesColor, 7> kSeriesColors{{{"#0072b2", "#56b4e9"},
                                                           {"#4f4606", "#dcc875"},
                                                           {"#d556f8", "#d22bfa"},
                                                           {"#4fa394", "#03a388"},
                                                           {"#8a662e", "#8e6736"},
                                                           {"#024c6c", "#18739f"},
                                                           {"#1b2430", "#e6eaef"}}};
}  // namespace altiplan::host
