// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/formats/polygon.hpp"
#include "altiplan/frame.hpp"

/// \file Polygons in longitude and latitude, with straight edges in these, anywhere on the Earth.
namespace altiplan::formats {

/// A ring all of whose edges run the short way around the Earth: its longitudes run on beyond the
/// 180th meridian, from the first corner on. A ring around a pole is closed along it.
ALTIPLAN_API Ring continuous(Ring ring);

/// A ring as its file means it. An edge over more than 180 degrees of longitude runs the short way
/// in rings that are then 20 degrees wide and high on the ground at most, or lead around a pole; as
/// it is written (RFC 7946, 3.1.9) in masks of the world, which reach 60 degrees north and south,
/// and in rings that are drawn counter-clockwise (3.1.6) whose other reading is wider than 100
/// degrees. Others have two readings, and stay as they are written.
ALTIPLAN_API Ring unfolded(const Ring& ring);
/// Likewise, its holes on the turn of the Earth of its outline.
ALTIPLAN_API Polygon unfolded(Polygon polygon);
/// True if its outline or a hole has two readings.
ALTIPLAN_API bool has_two_readings(const Polygon& polygon);

/// What a polygon, unfolded, covers in a frame, as far as its surroundings reach: 20 degrees about
/// the origin, or less if the frame's projection is undefined there. Edges are where they are in
/// longitude and latitude to a millimetre near the origin, to 1e-7 of the distance from it. Several
/// polygons if the 180th meridian, or the one opposite to the origin, cuts it; none if it lies
/// elsewhere. Zones that were cut along the 180th meridian overlap by a centimetre there unless
/// they are to stay in. Of an outline with two readings both are covered; none if it is to stay in.
/// Holes that have two are covered.
ALTIPLAN_API std::vector<Polygon> in_frame(const Polygon& polygon, const Frame& frame,
                                           bool keeps_in = false);

/// True if all positions lie in the frame's surroundings: in_frame leaves nothing out between them.
ALTIPLAN_API bool are_in_frame(const std::vector<Point2>& positions, const Frame& frame);

/// A frame for positions, one or more, that no other frame holds: true about their middle, its
/// origin at their south-west.
ALTIPLAN_API Frame frame_around(const std::vector<Point2>& positions);

/// Radius in the frame of a circle about a position that holds all of the circle on the ground, or
/// that lies within it for a zone to stay in.
ALTIPLAN_API double radius_in(const Frame& frame, const Point2& centre, double radius_m,
                              bool keeps_in);
}  // namespace altiplan::formats
