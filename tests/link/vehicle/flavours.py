# SPDX-License-Identifier: Apache-2.0
"""How the autopilots differ: their numbers for modes, their reading of the mission protocol, their
failsafes. Sources: the developer guide's page of the mission protocol with its section of
implementations, MissionItemProtocol.cpp of ArduPilot and mavlink_mission.cpp of PX4."""
from dataclasses import dataclass

from constants import FLAG_AUTO, FLAG_CUSTOM, FLAG_GUIDED, FLAG_STABILIZE

# Modes inside the vehicle; each flavour has numbers for them.
MANUAL, AUTO, GUIDED, HOLD, RTL, LAND, TAKEOFF, POSITION = (
    "MANUAL", "AUTO", "GUIDED", "HOLD", "RTL", "LAND", "TAKEOFF", "POSITION")

BASE_FLAGS = {MANUAL: 0, AUTO: FLAG_AUTO | FLAG_GUIDED | FLAG_STABILIZE,
              GUIDED: FLAG_GUIDED | FLAG_STABILIZE, HOLD: FLAG_STABILIZE,
              RTL: FLAG_AUTO | FLAG_STABILIZE, LAND: FLAG_AUTO | FLAG_STABILIZE,
              TAKEOFF: FLAG_AUTO | FLAG_STABILIZE, POSITION: FLAG_STABILIZE}


def px4_mode(main, sub=0):
    return main << 16 | sub << 24


# custom_mode of each mode; the first mode of a number is what the number sets.
ARDUCOPTER = {MANUAL: 0, AUTO: 3, GUIDED: 4, HOLD: 5, RTL: 6, LAND: 9}
BRAKE = 17  # of ArduCopter: holds too, whatever the sticks do
ARDUPLANE = {MANUAL: 0, AUTO: 10, RTL: 11, HOLD: 12, TAKEOFF: 13, GUIDED: 15}
PX4 = {MANUAL: px4_mode(1), POSITION: px4_mode(3), GUIDED: px4_mode(6), TAKEOFF: px4_mode(4, 2), HOLD: px4_mode(4, 3),
       AUTO: px4_mode(4, 4), RTL: px4_mode(4, 5), LAND: px4_mode(4, 6)}


@dataclass(frozen=True)
class Flavour:
    name: str
    autopilot: int  # MAV_AUTOPILOT
    storage: str  # "atomic", or "overwrite" as items come
    home_is_item_0: bool
    request: str  # the message that asks for an item
    resend_after: float  # s without the item
    give_up_after: float  # s without any item
    out_of_order: str  # "request" again, "ignore", or "nak" and go on
    idle_item: str  # "acknowledge" the last one again, or "error"
    cancels_uploads: bool  # by MISSION_ACK of OPERATION_CANCELLED
    other_partner: str  # MAV_MISSION_RESULT for a competing transfer
    partial_upload: bool
    list_first: bool  # items only after MISSION_REQUEST_LIST
    opaque_ids: bool
    arms_in_auto: bool
    stream_needed: bool  # GUIDED wants a stream of set-points and leaves without


# The text itself: 250 ms for items, five retries, errors only where it has them.
GENERIC = Flavour("generic", 0, "atomic", False, "MISSION_REQUEST_INT", 0.25, 1.5, "request",
                  "acknowledge", True, "DENIED", True, False, True, True, False)
ARDUPILOT = Flavour("ardupilot", 3, "overwrite", True, "MISSION_REQUEST", 1.0, 8.0, "nak",
                    "error", False, "DENIED", True, False, False, False, False)
PX4_FLAVOUR = Flavour("px4", 12, "atomic", False, "MISSION_REQUEST_INT", 0.25, 5.0, "ignore",
                      "acknowledge", False, "ERROR", False, True, True, True, True)
FLAVOURS = {flavour.name: flavour for flavour in (GENERIC, ARDUPILOT, PX4_FLAVOUR)}


def mode_numbers(flavour, kind):
    if flavour.name == "px4":
        return PX4
    if flavour.name == "ardupilot":
        return ARDUCOPTER if kind == "copter" else ARDUPLANE
    return None


def mode_of(flavour, kind, base_mode, custom_mode):
    """The mode that SET_MODE or DO_SET_MODE asks for, or None."""
    numbers = mode_numbers(flavour, kind)
    if numbers is None:
        wanted = base_mode & (FLAG_AUTO | FLAG_GUIDED | FLAG_STABILIZE)
        if wanted & FLAG_AUTO:
            return AUTO
        return GUIDED if wanted & FLAG_GUIDED else HOLD if wanted else MANUAL
    if numbers is ARDUCOPTER and custom_mode == BRAKE:
        custom_mode = numbers[HOLD]
    for mode, number in numbers.items():
        if number == custom_mode and base_mode & FLAG_CUSTOM:
            return mode
    return None


COMMON = {"NAVL1_PERIOD": 17.0, "NAVL1_DAMPING": 0.75, "DISARM_DELAY": 10.0, "SYSID_THISMAV": 1.0}
COPTER = {"WPNAV_SPEED": 10.0, "WPNAV_SPEED_UP": 2.5, "WPNAV_SPEED_DN": 1.5, "WPNAV_RADIUS": 2.0,
          "GUID_TIMEOUT": 3.0, "RTL_ALT": 15.0}
PLANE = {"AIRSPEED_CRUISE": 22.0, "AIRSPEED_MIN": 15.0, "AIRSPEED_MAX": 30.0, "WP_RADIUS": 60.0,
         "WP_LOITER_RAD": 80.0, "ROLL_LIMIT_DEG": 45.0, "TECS_CLMB_MAX": 5.0, "TECS_SINK_MAX": 5.0,
         "RTL_ALT": 100.0}
# What is done when nothing commands any more, by the defaults of each autopilot; integers are of
# its integer types.
FAILSAFES = {("px4", "copter"): {"COM_OF_LOSS_T": 1.0, "COM_OBL_RC_ACT": 0, "NAV_DLL_ACT": 0},
             ("px4", "plane"): {"COM_OF_LOSS_T": 1.0, "COM_OBL_RC_ACT": 0, "NAV_DLL_ACT": 0},
             ("ardupilot", "copter"): {"FS_GCS_ENABLE": 0},
             ("ardupilot", "plane"): {"FS_GCS_ENABL": 0, "FS_LONG_ACTN": 0}}


def parameters(flavour, kind):
    """In metres, seconds and degrees whatever the units of the autopilot whose names they have."""
    own = COPTER if kind == "copter" else PLANE
    return dict(sorted({**COMMON, **own, **FAILSAFES.get((flavour.name, kind), {})}.items()))
