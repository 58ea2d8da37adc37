// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "airspace_parts.hpp"
#include "xml_parts.hpp"

/// \file Surfaces of AIXM: GML with curves, and with pieces of borders.
namespace altiplan::formats {

/// Elements of that name below the node, none within another of them.
void find_all(const pugi::xml_node& node, std::string_view name, std::vector<pugi::xml_node>& to);
/// The feature's identifier, without "urn:uuid:".
std::string identifier(const pugi::xml_node& feature);
/// What an element's xlink:href refers to, likewise.
std::string reference(const pugi::xml_node& node);

/// A border's vertices between two positions, in that direction. Throws Error if it is closed, or
/// too far from them.
Outline along_border(const std::vector<Point2>& border, const Point2& from, const Point2& to);

/// Polygons that cover the patches of a surface.
std::vector<Polygon> read_surface(const pugi::xml_node& projection,
                                  const std::map<std::string, pugi::xml_node>& borders,
                                  const std::string& zone, Doubts& doubts);
}  // namespace altiplan::formats
