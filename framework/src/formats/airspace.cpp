// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/airspace.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "airspace_parts.hpp"
#include "last_read.hpp"

namespace altiplan::formats {
namespace {

using Datum = ZoneLimit::Datum;

// "No upper limit", in metres or feet, and as a flight level.
constexpr double kUnlimited = 99999;
constexpr double kUnlimitedLevel = 999;
// No limit lies deeper, metres.
constexpr double kLowest = -1000;
// The geoid lies between 106 m below the ellipsoid and 86 m above it.
constexpr double kGeoid = 110;

std::optional<double> metres_per(const std::string& unit) {
  static const std::map<std::string, double> kUnits{{"M", 1}, {"FT", kFoot}, {"FL", kFlightLevel}};
  const auto found = kUnits.find(upper_case(unit));
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

bool is_one_of(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return text == word; });
}

ZoneLimit limit_of(const LimitText& text, bool upper, const std::string& zone, Doubts& doubts) {
  const char* const side = upper ? "upper" : "lower";
  const auto unknown = [&](const std::string& why) {
    doubts.add("no known " + std::string(side) + " limit (" + why + "), closed " +
                   (upper ? "upwards" : "downwards"),
               zone);
    return ZoneLimit{};
  };
  if (!text.value || !std::isfinite(*text.value)) {
    return unknown(text.found.empty() ? "none given" : "'" + printable(text.found) + "'");
  }
  const std::string unit = upper_case(text.unit);
  const std::string reference = upper_case(text.reference);
  const std::optional<double> scale = metres_per(unit);
  if (!scale) {
    return unknown("unit '" + printable(text.unit) + "'");
  }
  if (upper && *text.value >= (unit == "FL" ? kUnlimitedLevel : kUnlimited)) {
    return {};
  }
  if (!upper && *text.value == 0) {
    return {};  // the surface, whatever the reference
  }
  const double metres = *text.value * *scale;
  if (metres < kLowest || metres >= kUnlimited) {
    return unknown("'" + printable(text.found) + "'");
  }
  if (unit == "FL" || reference == "STD") {
    return {Datum::standard, metres};
  }
  if (is_one_of(reference, {"AGL", "SFC", "GND"})) {
    return {Datum::ground, metres};
  }
  if (is_one_of(reference, {"AMSL", "MSL"})) {
    return {Datum::sea, metres};
  }
  if (is_one_of(reference, {"WGS84", "W84"})) {
    doubts.add("limit above the ellipsoid, widened by 110 m for sea level", zone);
    return {Datum::sea, metres + (upper ? kGeoid : -kGeoid)};
  }
  return unknown("reference '" + printable(text.reference) + "'");
}

// Words of ED-269 and ED-318, classes and types of AIXM and OpenAir.
constexpr const char* kKeepOut = " PROHIBITED P R GP TFR OFR ";
constexpr const char* kAsk =
    " REQ_AUTHORISATION REQ_AUTHORIZATION CONDITIONAL USPACE UASFM "
    "D_OTHER Q TRA TSA TRAFR MTA MTR MATZ ALERT WARNING N ADIZ CBA RCA "
    "A B C D CTR CTA TMA UTA LTA ATZ HTZ AWY TMZ RMZ TIZ TIA CTR_P CTA_P TMA_P ATZ_P CLASS PART ";
constexpr const char* kInform =
    " NO_RESTRICTION E F G W FIR UIR OCA FIS ACCSEC GSEC VFRR VFRSEC TRZ ASRA SECTOR SECTOR_C ";

bool lists(const char* words, const std::string& word) {
  return std::string_view(words).find(" " + word + " ") != std::string_view::npos;
}
}  // namespace

void Doubts::add(const std::string& what, const std::string& zone) {
  auto found = std::find_if(found_.begin(), found_.end(),
                            [&](const auto& entry) { return entry.first == what; });
  if (found == found_.end()) {
    found = found_.insert(found_.end(), {what, {}});
  }
  if (found->second.empty() || found->second.back() != zone) {
    found->second.push_back(zone);
  }
}

std::vector<std::string> Doubts::notes() const {
  std::vector<std::string> notes;
  for (const auto& [what, zones] : found_) {
    notes.push_back(what + ": " + names_text(zones));
  }
  return notes;
}

ZoneLimit lower_limit(const LimitText& text, const std::string& zone, Doubts& doubts) {
  return limit_of(text, false, zone, doubts);
}

ZoneLimit upper_limit(const LimitText& text, const std::string& zone, Doubts& doubts) {
  return limit_of(text, true, zone, doubts);
}

void settle(ZoneVolume& volume, const std::string& zone, Doubts& doubts) {
  const bool same = volume.lower.datum == volume.upper.datum;
  const bool empty =
      same && volume.lower.datum != Datum::none && !(volume.lower.metres < volume.upper.metres);
  const bool below_ground = volume.upper.datum == Datum::ground && !(volume.upper.metres > 0);
  if (empty || below_ground) {
    doubts.add("lower limit not below the upper one, closed at all heights", zone);
    volume.lower = {};
    volume.upper = {};
  }
}

Restriction restriction_of(const std::string& type, const std::string& zone, Doubts& doubts) {
  const std::string word = upper_case(type);
  if (lists(kKeepOut, word)) {
    return Restriction::keep_out;
  }
  if (lists(kAsk, word)) {
    return Restriction::ask;
  }
  if (lists(kInform, word)) {
    return Restriction::inform;
  }
  doubts.add("unknown class '" + printable(type) + "', keep out", zone);
  return Restriction::keep_out;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  return result;
}

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto byte = static_cast<unsigned char>(text[n]);
    const std::size_t more = byte < 0x80 ? 0 : byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
    bool whole = byte < 0x80 ? byte >= ' ' : byte >= 0xC2 && byte <= 0xF4 && n + more < text.size();
    for (std::size_t k = 1; k <= more && whole; ++k) {
      whole = (static_cast<unsigned char>(text[n + k]) & 0xC0) == 0x80;
    }
    if (!whole) {
      result += '?';
      continue;
    }
    result += text.substr(n, more + 1);
    n += more;
  }
  return result;
}

std::vector<Point2> corners_of(const std::vector<Zone>& zones) {
  std::vector<Point2> corners;
  for (const Zone& zone : zones) {
    for (const ZoneVolume& volume : zone.volumes) {
      const Ring& outline = volume.polygon.outline;
      corners.insert(corners.end(), outline.begin(), outline.end());
      if (outline.empty()) {
        corners.push_back(volume.centre);
      }
    }
  }
  return corners;
}

std::string Zone::label() const {
  if (id.empty() || name.empty() || id == name) {
    return id.empty() ? name : id;
  }
  return id + " (" + name + ")";
}

namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return char(std::tolower(letter)); });
  return text;
}

/// "; did you mean 'TMA (1/4)', 'TMA (2/4)'?" of zones whose label holds the text, else of the
/// nearest name; without one, the zones that take a permission.
std::string meant(const std::vector<Zone>& zones, const std::string& called) {
  std::vector<std::string> holding;
  std::vector<std::string> asking;
  std::vector<std::string> names;
  for (const Zone& zone : zones) {
    const std::string label = zone.label();
    if (!called.empty() && lower_case(label).find(lower_case(called)) != label.npos) {
      holding.push_back(label);
    }
    if (zone.restriction == Restriction::ask) {
      asking.push_back(label);
    }
    names.insert(names.end(), {zone.id, zone.name, label});
  }
  if (const std::string near = nearest_name(called, names); holding.empty() && !near.empty()) {
    holding.push_back(near);
  }
  return !holding.empty() ? "; did you mean " + names_text(holding) + "?"
         : asking.empty() ? "; none takes a permission"
                          : "; a permission is taken by " + names_text(asking);
}
}  // namespace

std::string permission_problem(const std::vector<Zone>& zones, const std::string& called) {
  std::string closed;
  std::set<std::string> opened;
  for (const Zone& zone : zones) {
    if (zone.is_called(called) && zone.takes_permission()) {
      opened.insert(zone.label());
    } else if (zone.is_called(called)) {
      closed = "no permission opens '" + zone.label() + "'" +
               (zone.type.empty() ? "" : " (" + zone.type + ")") + ": it stays closed";
    }
  }
  if (opened.size() > 1) {
    return "'" + called + "' may be " + names_text({opened.begin(), opened.end()}) +
           ": name each zone that you have a permission for in full";
  }
  return !opened.empty()   ? ""
         : !closed.empty() ? closed
                           : "no zone is called '" + called + "'" + meant(zones, called);
}

std::string format_name(Airspace::Format format) {
  switch (format) {
    case Airspace::Format::ed269:
      return "ED-269";
    case Airspace::Format::ed318:
      return "ED-318";
    case Airspace::Format::aixm:
      return "AIXM 5.1";
    case Airspace::Format::openair:
      return "OpenAir";
    case Airspace::Format::faa:
      return "a UAS facility map";
  }
  return "";
}

double standard_to_sea(double metres, double qnh_hpa) {
  // The standard atmosphere: p = p0 (1 - L h / T0)^(g M / R L), with the QNH as p0.
  constexpr double kT0 = 288.15;
  constexpr double kLapse = 0.0065;
  constexpr double kExponent = 0.190263;
  constexpr double kStandard = 1013.25;
  if (qnh_hpa == kStandard) {
    return metres;
  }
  const double ratio = std::pow(kStandard / qnh_hpa, kExponent);
  return kT0 / kLapse * (1 - ratio * (1 - kLapse * metres / kT0));
}

namespace {
std::optional<Airspace> parse_airspace(const std::string& file, const std::string& text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first == std::string::npos) {
    return std::nullopt;
  }
  if (text[first] == '<') {
    return is_aixm(text) ? std::optional(read_aixm(file, text)) : std::nullopt;
  }
  if (text[first] == '{' || text[first] == '[') {
    return read_airspace_json(file, text);
  }
  return is_openair(text) ? std::optional(read_openair(file, text)) : std::nullopt;
}
}  // namespace

std::shared_ptr<const Airspace> read_airspace(const std::string& file, const std::string& text) {
  // Not freed when the program ends, which takes as long as to read a tenth of it.
  static auto& last = *new LastRead<std::optional<Airspace>>;
  const auto read = last.get(file, text, parse_airspace);
  return *read ? std::shared_ptr<const Airspace>(read, &**read) : nullptr;
}
}  // namespace altiplan::formats
