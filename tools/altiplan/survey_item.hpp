// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "survey_flights.hpp"

namespace altiplan::cli {

/// Writes the survey of an area as an item that QGroundControl lays again, with lines of its own,
/// as survey.plan beside the route, where that passes and shows as much. Returns what became of it.
std::string write_survey_item(const std::filesystem::path& folder, const SurveyArguments& arguments,
                              const host::SurveyWish& wish, const host::FirstRoute& first,
                              const Surveyed& surveyed);
}  // namespace altiplan::cli
