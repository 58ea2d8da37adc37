// SPDX-License-Identifier: Apache-2.0
//
// The features of published airspace in JSON, whose format some of them tell.
#include <algorithm>
#include <map>

#include "airspace_parts.hpp"
#include "json_node.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using Format = Airspace::Format;

bool has_any(const Json& object, std::initializer_list<const char*> keys) {
  return object.is_object() && std::any_of(keys.begin(), keys.end(),
                                           [&](const char* key) { return object.contains(key); });
}

std::optional<Format> format_of_feature(const Json& feature) {
  static const Json kNone;
  const auto part = [&](const char* key) -> const Json& {
    return has_any(feature, {key}) ? feature[key] : kNone;
  };
  const Json& geometry = part("geometry");
  const Json& properties = part("properties");
  if (geometry.is_array() || has_any(feature, {"uomDimensions", "applicability"})) {
    return Format::ed269;
  }
  if (has_any(properties, {"restriction"}) && has_any(properties, {"geometry", "applicability"})) {
    return Format::ed269;  // within GeoJSON
  }
  if (has_any(geometry, {"layer", "extent"}) ||
      has_any(properties, {"limitedApplicability", "restrictionConditions", "zoneAuthority"})) {
    return Format::ed318;
  }
  if (has_any(properties, {"CEILING", "APT1_ICAO", "APT1_LAANC", "APT1_NAME"}) &&
      has_any(properties, {"MAP_EFF", "APT1_ICAO", "APT1_LAANC", "APT1_NAME", "ARPT_COUNT"})) {
    return Format::faa;
  }
  return std::nullopt;
}

/// True if the text may hold what format_of_feature looks for, or zones that are not GeoJSON: to
/// find out is quicker than to parse it.
bool may_be_airspace(const std::string& text) {
  static constexpr const char* kMarks[] = {"\"uomDimensions\"",
                                           "\"applicability\"",
                                           "\"restriction\"",
                                           "\"layer\"",
                                           "\"extent\"",
                                           "\"limitedApplicability\"",
                                           "\"restrictionConditions\"",
                                           "\"zoneAuthority\"",
                                           "\"CEILING\"",
                                           "\"APT1_",
                                           "\"UASZoneList\"",
                                           "\\u"};
  const auto has = [&](const char* mark) { return text.find(mark) != std::string::npos; };
  constexpr std::string_view kGeometry = "\"geometry\"";
  for (std::size_t at = text.find(kGeometry); at != std::string::npos;
       at = text.find(kGeometry, at + 1)) {
    const std::size_t value = text.find_first_not_of(" \t\r\n:", at + kGeometry.size());
    if (value != std::string::npos && text[value] == '[') {
      return true;  // ED-269's list
    }
  }
  return !has("\"FeatureCollection\"") || std::any_of(std::begin(kMarks), std::end(kMarks), has);
}

/// Reads features as they are parsed, once one of them has told the format.
class FeatureReader {
 public:
  void take(const std::string& key, Json& feature) {
    const std::size_t n = counts_[key]++;
    if (!format_ && is_list(key)) {
      format_ = format_of_feature(feature);
    }
    if (format_ && is_list(key)) {
      read(key, n, feature);
      feature = Json(Json::value_t::discarded);
    }
  }

  /// None if the document is no airspace.
  std::optional<Airspace> finish(const Json& document) {
    // Without marks of a format, but not GeoJSON either.
    const bool is_list_of_zones =
        document.is_object() && !document.contains("type") && counts_.contains("features");
    if (!format_ && !is_list_of_zones && !counts_.contains("UASZoneList")) {
      return std::nullopt;
    }
    format_ = format_.value_or(Format::ed269);
    for (const auto& [key, list] : document.items()) {
      for (std::size_t n = 0; is_list(key) && n < list.size(); ++n) {
        if (!list[n].is_discarded()) {
          read(key, n, list[n]);
        }
      }
    }
    airspace_.format = *format_;
    airspace_.notes = doubts_.notes();
    return std::move(airspace_);
  }

 private:
  static bool is_list(const std::string& key) { return key == "features" || key == "UASZoneList"; }

  void read(const std::string& key, std::size_t n, const Json& json) {
    const JsonNode feature(json, key + "." + std::to_string(n));
    if (!json.is_object()) {
      feature.wrong("a feature");
    }
    read_json_feature(feature, *format_, airspace_, doubts_);
  }

  std::optional<Format> format_;
  std::map<std::string, std::size_t> counts_;  ///< of the items of lists
  Airspace airspace_;
  Doubts doubts_;
};
}  // namespace

std::optional<Airspace> read_airspace_json(const std::string& file, const std::string& text) {
  if (!may_be_airspace(text)) {
    return std::nullopt;
  }
  FeatureReader reader;
  const auto take = [&](const std::string& key, Json& item) {
    try {
      reader.take(key, item);
    } catch (const Error& error) {
      throw Error(file + ": " + error.what());
    }
  };
  const Json document = parse_json(file, text, take);
  try {
    expect_wgs84(document);
    return reader.finish(document);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
}
}  // namespace altiplan::formats
