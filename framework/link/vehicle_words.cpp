// SPDX-License-Identifier: Apache-2.0
#include "link/vehicle_words.hpp"

#include <map>

namespace altiplan::link {
namespace {

using Names = std::map<unsigned, std::string>;

std::string name_in(const Names& names, unsigned number, const std::string& otherwise) {
  const auto found = names.find(number);
  return found == names.end() ? otherwise + std::to_string(number) : found->second;
}

/// COPTER_MODE and PLANE_MODE of ardupilotmega.xml.
const Names kCopterModes{
    {0, "STABILIZE"},   {1, "ACRO"},          {2, "ALT_HOLD"},   {3, "AUTO"},
    {4, "GUIDED"},      {5, "LOITER"},        {6, "RTL"},        {7, "CIRCLE"},
    {9, "LAND"},        {11, "DRIFT"},        {13, "SPORT"},     {14, "FLIP"},
    {15, "AUTOTUNE"},   {16, "POSHOLD"},      {17, "BRAKE"},     {18, "THROW"},
    {19, "AVOID_ADSB"}, {20, "GUIDED_NOGPS"}, {21, "SMART_RTL"}, {22, "FLOWHOLD"},
    {23, "FOLLOW"},     {24, "ZIGZAG"},       {25, "SYSTEMID"},  {26, "AUTOROTATE"},
    {27, "AUTO_RTL"},   {28, "TURTLE"}};
const Names kPlaneModes{{0, "MANUAL"},
                        {1, "CIRCLE"},
                        {2, "STABILIZE"},
                        {3, "TRAINING"},
                        {4, "ACRO"},
                        {5, "FLY_BY_WIRE_A"},
                        {6, "FLY_BY_WIRE_B"},
                        {7, "CRUISE"},
                        {8, "AUTOTUNE"},
                        {10, "AUTO"},
                        {11, "RTL"},
                        {12, "LOITER"},
                        {13, "TAKEOFF"},
                        {14, "AVOID_ADSB"},
                        {15, "GUIDED"},
                        {16, "INITIALIZING"},
                        {17, "QSTABILIZE"},
                        {18, "QHOVER"},
                        {19, "QLOITER"},
                        {20, "QLAND"},
                        {21, "QRTL"},
                        {22, "QAUTOTUNE"},
                        {23, "QACRO"},
                        {24, "THERMAL"},
                        {25, "LOITER_ALT_QLAND"},
                        {26, "AUTOLAND"}};

/// PX4's main modes, and the sub-modes of AUTO (px4_custom_mode.h).
const Names kPx4Modes{{1, "MANUAL"}, {2, "ALTCTL"},   {3, "POSCTL"},     {4, "AUTO"},
                      {5, "ACRO"},   {6, "OFFBOARD"}, {7, "STABILIZED"}, {8, "RATTITUDE"}};
const Names kPx4AutoModes{{1, "READY"}, {2, "TAKEOFF"}, {3, "LOITER"},        {4, "MISSION"},
                          {5, "RTL"},   {6, "LAND"},    {8, "FOLLOW_TARGET"}, {9, "PRECLAND"}};
}  // namespace

bool is_fixed_wing(const Heartbeat& heartbeat) {
  constexpr std::uint8_t kFixedWing = 1;
  constexpr std::uint8_t kFirstVtol = 19;
  constexpr std::uint8_t kLastVtol = 25;
  return heartbeat.type == kFixedWing ||
         (heartbeat.type >= kFirstVtol && heartbeat.type <= kLastVtol);
}

std::string type_in_words(const Heartbeat& heartbeat) {
  static const Names kTypes{
      {0, "vehicle"},    {1, "fixed wing"}, {2, "quadrotor"},    {3, "coaxial helicopter"},
      {4, "helicopter"}, {7, "airship"},    {10, "rover"},       {11, "boat"},
      {12, "submarine"}, {13, "hexarotor"}, {14, "octorotor"},   {15, "tricopter"},
      {19, "VTOL"},      {20, "VTOL"},      {21, "VTOL"},        {22, "VTOL"},
      {23, "VTOL"},      {24, "VTOL"},      {29, "dodecarotor"}, {35, "decarotor"}};
  return name_in(kTypes, heartbeat.type, "vehicle of type ");
}

std::string autopilot_in_words(const Heartbeat& heartbeat) {
  static const Names kAutopilots{
      {0, "generic autopilot"}, {kArduPilot, "ArduPilot"}, {kPx4, "PX4"}};
  return name_in(kAutopilots, heartbeat.autopilot, "autopilot ");
}

std::string mode_in_words(const Heartbeat& heartbeat) {
  const unsigned mode = heartbeat.custom_mode;
  if (heartbeat.autopilot == kArduPilot) {
    return name_in(is_fixed_wing(heartbeat) ? kPlaneModes : kCopterModes, mode, "mode ");
  }
  if (heartbeat.autopilot == kPx4) {
    const unsigned main = mode >> 16 & 0xff;
    const unsigned sub = mode >> 24;
    const std::string name = name_in(kPx4Modes, main, "mode ");
    return sub == 0 ? name : name + "." + name_in(kPx4AutoModes, sub, "");
  }
  return "mode " + std::to_string(mode);
}
}  // namespace altiplan::link
