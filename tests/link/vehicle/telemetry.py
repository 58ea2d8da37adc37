# SPDX-License-Identifier: Apache-2.0
"""What the vehicle reports of itself, each message at its own rate of simulated time; the heartbeat
keeps to the time of the link, which is not sped up."""
import math

import geodesy
import plans
from constants import (FENCE, FLAG_ARMED, FLAG_CUSTOM, MISSION, RALLY, STATE_ACTIVE, STATE_STANDBY,
                       Frame)
from flavours import AUTO, BASE_FLAGS, GUIDED, mode_numbers

RATES = {"SYS_STATUS": 1, "GLOBAL_POSITION_INT": 5, "LOCAL_POSITION_NED": 5, "ATTITUDE": 5,
         "VFR_HUD": 4, "MISSION_CURRENT": 1, "GPS_RAW_INT": 1, "EXTENDED_SYS_STATE": 1,
         "HOME_POSITION": 0.2, "SYSTEM_TIME": 1, "NAV_CONTROLLER_OUTPUT": 2,
         "POSITION_TARGET_GLOBAL_INT": 2}
# Unasked, ArduPlane sends each of these once a second, ArduCopter none; HOME_POSITION comes when it
# changes.
ARDUPILOT_STREAMS = ("SYS_STATUS", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "ATTITUDE",
                     "VFR_HUD", "MISSION_CURRENT", "GPS_RAW_INT", "SYSTEM_TIME",
                     "NAV_CONTROLLER_OUTPUT", "POSITION_TARGET_GLOBAL_INT", "WIND")
ONLY_GUIDED = ("POSITION_TARGET_GLOBAL_INT",)
POSITION_ONLY, VELOCITY_ONLY = 0xFF8, 0xFC7  # type masks
SENSORS = 0x2F  # gyroscope, accelerometer, magnetometer, absolute pressure, GPS
FIX_3D = 3
# Capabilities: PARAM_FLOAT, MISSION_INT, COMMAND_INT, set-points in both frames, MISSION_FENCE,
# MISSION_RALLY, MAVLINK2; TERRAIN where it is asked for.
CAPABILITIES = 0x2 | 0x4 | 0x8 | 0x80 | 0x100 | 0x4000 | 0x8000 | 0x2000
CAPABILITY_TERRAIN = 0x200
# Groups of REQUEST_DATA_STREAM.
STREAMS = {1: ("GPS_RAW_INT",), 2: ("SYS_STATUS", "MISSION_CURRENT", "NAV_CONTROLLER_OUTPUT"),
           6: ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"), 10: ("ATTITUDE",), 11: ("VFR_HUD",)}
MISSION_STATES = {"none": 1, "not_started": 2, "active": 3, "paused": 4, "complete": 5}


class Telemetry:
    def __init__(self, node, flavour, kind):
        self.node, self.flavour, self.kind = node, flavour, kind
        self.rates = self.default_rates()
        self.due = {}
        self.heartbeat_due = 0.0

    def step(self):
        if self.node.now >= self.heartbeat_due - 1e-9:
            self.heartbeat_due = max(self.heartbeat_due + 1.0, self.node.now)
            self.send("HEARTBEAT")
        time = self.node.pilot.time
        for name, rate in self.rates.items():
            if rate > 0 and time >= self.due.get(name, 0.0) - 1e-9:
                self.due[name] = max(self.due.get(name, 0.0) + 1 / rate, time)
                if name not in ONLY_GUIDED or self.node.pilot.mode == GUIDED:
                    self.send(name)

    def send(self, name):
        self.node.send(name, getattr(self, name.lower())())

    def can_send(self, name):
        return hasattr(self, name.lower())

    def default_rates(self):
        if self.flavour.name != "ardupilot":
            return {**RATES, "WIND_COV" if self.flavour.name == "px4" else "WIND": 1}
        rate = 1 if self.kind == "plane" else 0
        return {name: rate for name in ARDUPILOT_STREAMS}

    def set_stream(self, group, rate):
        for name in STREAMS.get(group, self.rates if group == 0 else ()):
            self.rates[name] = rate

    def heartbeat(self):
        pilot = self.node.pilot
        numbers = mode_numbers(self.flavour, self.kind)
        flags = BASE_FLAGS[pilot.mode] | (FLAG_ARMED if pilot.armed else 0)
        return {"type": 2 if self.kind == "copter" else 1, "autopilot": self.flavour.autopilot,
                "base_mode": flags | (FLAG_CUSTOM if numbers else 0),
                "custom_mode": numbers[pilot.mode] if numbers else 0,
                "system_status": STATE_ACTIVE if pilot.armed else STATE_STANDBY,
                "mavlink_version": 3}

    def sys_status(self):
        return {"onboard_control_sensors_present": SENSORS,
                "onboard_control_sensors_enabled": SENSORS,
                "onboard_control_sensors_health": SENSORS, "load": 200, "voltage_battery": 12600,
                "current_battery": -1, "battery_remaining": 90}

    def stamped(self, **fields):
        return {"time_boot_ms": self.node.pilot.boot_ms(), **fields}

    def global_position_int(self):
        pilot = self.node.pilot
        here, velocity = pilot.body.position, pilot.body.velocity
        return self.stamped(
            lat=round(here.lat * 1e7), lon=round(here.lon * 1e7), alt=round(here.alt * 1000),
            relative_alt=round((here.alt - pilot.home.alt) * 1000), vx=round(velocity[0] * 100),
            vy=round(velocity[1] * 100), vz=round(-velocity[2] * 100),
            hdg=round(math.degrees(pilot.body.yaw) % 360 * 100) % 36000)

    def local_position_ned(self):
        pilot = self.node.pilot
        north, east, up = geodesy.vector(pilot.home, pilot.body.position)
        velocity = pilot.body.velocity
        return self.stamped(x=north, y=east, z=-up, vx=velocity[0], vy=velocity[1],
                            vz=-velocity[2])

    def attitude(self):
        body = self.node.pilot.body
        return self.stamped(roll=body.roll, pitch=body.pitch, yaw=body.yaw,
                            rollspeed=body.rates[0], pitchspeed=body.rates[1],
                            yawspeed=body.rates[2])

    def vfr_hud(self):
        pilot = self.node.pilot
        return {"airspeed": pilot.body.airspeed, "groundspeed": pilot.body.ground_speed(),
                "heading": round(math.degrees(pilot.body.yaw) % 360) % 360,
                "throttle": 50 if pilot.armed else 0, "alt": pilot.body.position.alt,
                "climb": pilot.body.velocity[2]}

    def wind(self):
        north, east = self.node.pilot.body.wind
        comes_from = math.degrees(math.atan2(-east, -north)) if north or east else 0.0
        return {"direction": comes_from, "speed": math.hypot(north, east)}

    def wind_cov(self):
        north, east = self.node.pilot.body.wind
        return {"time_usec": self.node.pilot.boot_ms() * 1000, "wind_x": north, "wind_y": east}

    def gps_raw_int(self):
        pilot = self.node.pilot
        here, velocity = pilot.body.position, pilot.body.velocity
        ready = pilot.time - pilot.booted_at >= pilot.ready_after
        course = math.degrees(math.atan2(velocity[1], velocity[0])) % 360
        return {"time_usec": pilot.boot_ms() * 1000, "fix_type": FIX_3D if ready else 1,
                "lat": round(here.lat * 1e7), "lon": round(here.lon * 1e7),
                "alt": round(here.alt * 1000), "eph": 100, "epv": 100,
                "vel": round(pilot.body.ground_speed() * 100), "cog": round(course * 100) % 36000,
                "satellites_visible": 12 if ready else 0}

    def extended_sys_state(self):
        return {"vtol_state": 0, "landed_state": 1 if self.node.pilot.body.on_ground else 2}

    def home_position(self):
        pilot = self.node.pilot
        return {"latitude": round(pilot.home.lat * 1e7), "longitude": round(pilot.home.lon * 1e7),
                "altitude": round(pilot.home.alt * 1000), "q": [1.0, 0.0, 0.0, 0.0]}

    def gps_global_origin(self):
        return {name: value for name, value in self.home_position().items()
                if name in ("latitude", "longitude", "altitude")}

    def system_time(self):
        return self.stamped(time_unix_usec=0)

    def nav_controller_output(self):
        pilot = self.node.pilot
        body, target = pilot.body, pilot.goal.target
        fields = {"nav_roll": math.degrees(body.roll), "nav_pitch": math.degrees(body.pitch),
                  "nav_bearing": round(math.degrees(body.yaw)), "xtrack_error": body.crosstrack}
        if target is not None:
            north, east, up = geodesy.vector(body.position, target)
            fields.update(target_bearing=round(math.degrees(math.atan2(east, north))), alt_error=up,
                          wp_dist=min(65535, round(math.hypot(north, east))))
        return fields

    def position_target_global_int(self):
        """What GUIDED flies to."""
        goal = self.node.pilot.goal
        frame = {"coordinate_frame": int(Frame.GLOBAL_INT)}
        if goal.target is None:
            north, east, up = goal.velocity
            return self.stamped(type_mask=VELOCITY_ONLY, vx=north, vy=east, vz=-up, **frame)
        return self.stamped(type_mask=POSITION_ONLY, lat_int=round(goal.target.lat * 1e7),
                            lon_int=round(goal.target.lon * 1e7), alt=goal.target.alt, **frame)

    def mission_current(self):
        pilot, stored = self.node.pilot, self.node.missions.plans
        # Home is not counted where it is an item; ArduPilot does not say "unknown" nor "paused".
        ardupilot, state = self.flavour.name == "ardupilot", self.mission_state()
        total = max(0, len(stored[MISSION]) - (1 if self.flavour.home_is_item_0 else 0))
        fields = {"seq": pilot.current_item(),
                  "total": total if stored[MISSION] or ardupilot else 65535,
                  "mission_state": MISSION_STATES["not_started" if ardupilot and state == "paused"
                                                  else state],
                  "mission_mode": 1 if pilot.mode == AUTO else 0 if ardupilot else 2}
        if self.flavour.opaque_ids:
            for field, kind in (("mission_id", MISSION), ("fence_id", FENCE),
                                ("rally_points_id", RALLY)):
                fields[field] = plans.opaque_id(stored[kind])
        return fields

    def mission_state(self):
        pilot = self.node.pilot
        if len(pilot.mission_items()) <= pilot.auto.first() or self.node.faults.infeasible():
            return "none"
        if pilot.auto.finished:
            return "complete"
        if pilot.mission_runs():
            return "active"
        return "paused" if pilot.auto.index is not None else "not_started"

    def autopilot_version(self):
        terrain = CAPABILITY_TERRAIN if self.node.terrain.enabled else 0
        return {"capabilities": CAPABILITIES | terrain, "flight_sw_version": 0x040600FF, "uid": 1}

    def protocol_version(self):
        return {"version": 200, "min_version": 200, "max_version": 200}
