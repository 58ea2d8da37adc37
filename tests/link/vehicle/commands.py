# SPDX-License-Identifier: Apache-2.0
"""COMMAND_LONG and COMMAND_INT, https://mavlink.io/en/services/command.html: each command is done
and answered by COMMAND_ACK; what is unknown is answered as unsupported."""
import math

import flavours
import geodesy
import messages
from constants import FLAG_CUSTOM, RELATIVE, TERRAIN, Command, Result

FORCE = 21196  # param2 of arming without checks
CHANGE_MODE = 1  # flag of DO_REPOSITION
LONG_ONLY_INT = (Command.DO_REPOSITION,)  # of ArduPilot: degrees in floats are too coarse


HIGHEST = 1e5  # m


def whole(value):
    """Of a parameter that is a number of something; -1 if it cannot be."""
    return int(value) if abs(value) < 2 ** 31 else -1


class Commands:
    def __init__(self, node, pilot, flavour):
        self.node, self.pilot, self.flavour = node, pilot, flavour

    def handle(self, message):
        number = message.command
        name = Command(number).name.lower() if number in set(Command) else None
        handler = getattr(self, "do_" + name, None) if name else None
        if handler is None:
            result = Result.UNSUPPORTED
        elif message.name == "COMMAND_LONG" and self.wants_int(number):
            result = Result.UNSUPPORTED
        else:
            result = handler(message)
        if self.flavour.name == "px4" and number == Command.DO_SET_MODE:
            self.acknowledge(message, Result.ACCEPTED)  # the receiver; the commander's answer follows
        self.acknowledge(message, result)
        if number == Command.PREFLIGHT_REBOOT_SHUTDOWN and result == Result.ACCEPTED:
            self.node.reboot(2.0, False)

    def acknowledge(self, message, result):
        self.node.send("COMMAND_ACK", {
            "command": message.command, "result": int(result), "target_system": message.system,
            "target_component": message.component})

    def wants_int(self, number):
        return self.flavour.name == "ardupilot" and number in LONG_ONLY_INT

    @staticmethod
    def done(success, otherwise=Result.FAILED):
        return Result.ACCEPTED if success else otherwise

    def place(self, message):
        """Position of the command, or None if there is no such place; NaN and the integer for
        "unknown" are where the vehicle is."""
        pilot, here = self.pilot, self.pilot.body.position
        if message.name == "COMMAND_LONG":
            lat, lon, alt = message.param5, message.param6, message.param7
            frame = 3 if self.flavour.name == "ardupilot" else 0
        else:
            unknown = 2 ** 31 - 1
            lat, lon = (math.nan if v == unknown else v / 1e7 for v in (message.x, message.y))
            alt, frame = message.z, message.frame
        lat = here.lat if math.isnan(lat) else lat
        lon = here.lon if math.isnan(lon) else lon
        if abs(lat) > 90 or abs(lon) > 180 or abs(alt) > HIGHEST:
            return None
        if math.isnan(alt):
            return geodesy.Position(lat, lon, here.alt)
        if frame in RELATIVE:
            alt += pilot.home.alt
        elif frame in TERRAIN:
            alt += pilot.terrain_height(lat, lon)
        return geodesy.Position(lat, lon, alt)

    def do_component_arm_disarm(self, message):
        force = message.param2 == FORCE
        if message.param1 == 1:
            return self.done(self.pilot.arm(force))
        return self.done(self.pilot.disarm(force))

    def do_do_set_mode(self, message):
        base, custom = whole(message.param1), whole(message.param2)
        if self.flavour.name == "px4":
            # PX4 has main and sub mode in a parameter each.
            custom = flavours.px4_mode(custom, whole(message.param3))
        if self.flavour.name == "ardupilot" and not base & FLAG_CUSTOM:
            return Result.DENIED
        mode = flavours.mode_of(self.flavour, self.pilot.kind, base, custom)
        return self.done(self.pilot.set_mode(mode))

    def do_nav_takeoff(self, message):
        is_long, ardupilot = message.name == "COMMAND_LONG", self.flavour.name == "ardupilot"
        if ardupilot and not is_long and message.frame not in RELATIVE:
            return Result.DENIED
        height = message.param7 if is_long else message.z
        if self.flavour.name == "px4":
            height -= self.pilot.home.alt
        if not 0 < height < HIGHEST:
            height = 10.0
        return self.done(self.pilot.take_off(height))

    def do_nav_land(self, message):
        return self.done(self.pilot.set_mode(flavours.LAND))

    def do_nav_return_to_launch(self, message):
        return self.done(self.pilot.set_mode(flavours.RTL))

    def do_nav_loiter_unlim(self, message):
        return self.done(self.pilot.set_mode(flavours.HOLD))

    def do_mission_start(self, message):
        """ArduPilot knows no first and last item, and a plane that refuses does not say so."""
        pilot, ardupilot = self.pilot, self.flavour.name == "ardupilot"
        first = whole(message.param1)
        if ardupilot and (message.param1 or message.param2):
            return Result.DENIED
        if first > 0 and not pilot.auto.set_current(first):
            return Result.FAILED
        if not pilot.set_mode(flavours.AUTO) and not (ardupilot and pilot.kind == "plane"):
            return Result.FAILED
        pilot.started = True
        return Result.ACCEPTED

    def do_do_set_mission_current(self, message):
        if message.param2 == 1:
            self.pilot.auto.restart()
        if message.param1 >= 0 and not self.node.set_current(whole(message.param1)):
            return Result.DENIED
        return Result.ACCEPTED

    def do_do_change_speed(self, message):
        self.pilot.change_speed(message.param2)
        return Result.ACCEPTED

    def do_do_reposition(self, message):
        """ArduPilot flies to it in GUIDED, PX4 in hold."""
        pilot = self.pilot
        mode = flavours.HOLD if self.flavour.name == "px4" else flavours.GUIDED
        ardupilot, target = self.flavour.name == "ardupilot", self.place(message)
        if target is None or not (pilot.armed or ardupilot):
            return Result.DENIED
        if pilot.mode != mode:
            if not whole(message.param2) & CHANGE_MODE:
                return Result.FAILED if ardupilot and pilot.kind == "plane" else Result.DENIED
            if not pilot.set_mode(mode):
                return Result.DENIED
        if message.param1 > 0 and not ardupilot:
            pilot.change_speed(message.param1)
        radius = message.param3 if math.isfinite(message.param3) else 0.0
        yaw = math.radians(message.param4) if math.isfinite(message.param4) else None
        pilot.guided.go_to(target, radius, yaw if pilot.kind == "copter" else None)
        if mode == flavours.HOLD:
            pilot.hold = pilot.guided.wanted
        return Result.ACCEPTED

    def do_do_pause_continue(self, message):
        mode = flavours.AUTO if message.param1 == 1 else flavours.HOLD
        return self.done(self.pilot.set_mode(mode))

    def do_do_set_home(self, message):
        here = self.pilot.body.position
        home = here if message.param1 == 1 else self.place(message)
        if home is None:
            return Result.DENIED
        self.pilot.home = home
        self.pilot.home_was_set = True
        self.node.telemetry.send("HOME_POSITION")
        return Result.ACCEPTED

    def do_get_home_position(self, message):
        self.node.telemetry.send("HOME_POSITION")
        return Result.ACCEPTED

    def do_set_message_interval(self, message):
        known = messages.BY_NUMBER.get(whole(message.param1))
        if known is None or not self.node.telemetry.can_send(known.name):
            return Result.DENIED
        interval = message.param2
        rate = 0.0 if interval < 0 else 1e6 / interval if interval > 0 else \
            self.node.telemetry.default_rates().get(known.name, 0)
        self.node.telemetry.rates[known.name] = rate
        self.node.telemetry.due.pop(known.name, None)
        return Result.ACCEPTED

    def do_request_message(self, message):
        known = messages.BY_NUMBER.get(whole(message.param1))
        if known is None or not self.node.telemetry.can_send(known.name):
            return Result.FAILED if self.flavour.name == "ardupilot" else Result.DENIED
        self.node.telemetry.send(known.name)
        return Result.ACCEPTED

    def do_request_autopilot_capabilities(self, message):
        self.node.telemetry.send("AUTOPILOT_VERSION")
        return Result.ACCEPTED

    def do_request_protocol_version(self, message):
        self.node.telemetry.send("PROTOCOL_VERSION")
        return Result.ACCEPTED

    def do_preflight_reboot_shutdown(self, message):
        allowed = message.param1 == 1 and not self.pilot.armed
        return self.done(allowed, Result.DENIED)
