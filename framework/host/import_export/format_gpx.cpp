// SPDX-License-Identifier: Apache-2.0
#include "host/base/xml_text.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/map_parts.hpp"

namespace altiplan::host {

std::string gpx_text(const MissionText& text) {
  const Decimals& decimals = text.decimals;
  std::string out = kXml;
  out +=
      "<gpx version=\"1.1\" creator=\"altiplan\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<rte>\n  <name>" +
      xml_text(text.mission.name) +
      "</name>\n  <desc>ele is in metres above mean sea level</desc>\n";
  for (std::size_t n = 0; n < text.mission.items.size(); ++n) {
    const formats::MissionItem& item = text.mission.items[n];
    const std::string time = iso_time(text, n);
    out += "  <rtept lat=\"" + rounded_text(item.at.lat, decimals.degrees) + "\" lon=\"" +
           rounded_text(item.at.lon, decimals.degrees) + "\"><ele>" +
           rounded_text(item.at.altitude_m, decimals.metres) + "</ele>" +
           (time.empty() ? "" : "<time>" + time + "</time>") + "</rtept>\n";
  }
  return out + "</rte>\n</gpx>\n";
}

}  // namespace altiplan::host
