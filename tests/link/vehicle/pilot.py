# SPDX-License-Identifier: Apache-2.0
"""The autopilot: arming, modes, what each mode gives the airframe as its goal, and failsafes."""
import dataclasses
import math

import flavours
import geodesy
import plans
from airframe import Goal
from auto import Auto
from constants import MISSION, Command, Frame, MissionResult, Severity
from copter import Copter
from flavours import AUTO, GUIDED, HOLD, LAND, MANUAL, POSITION, RTL, TAKEOFF
from guided import Guided
from plane import Plane

IDLE = Goal("idle")
SINK = 0.9  # m/s, of PX4's copter in POSCTL without a radio
# COM_OBL_RC_ACT; others of its values are not modelled.
SETPOINT_LOSS = {0: POSITION, 3: RTL, 4: LAND, 5: HOLD}


class Pilot:
    def __init__(self, options, flavour, node):
        self.flavour, self.kind, self.node = flavour, options.type, node
        self.home = geodesy.Position(*options.home)
        self.ground = self.home.alt  # level everywhere, wherever home is moved
        self.parameters = {**flavours.parameters(flavour, self.kind), **options.parameters}
        airframe = Copter if self.kind == "copter" else Plane
        self.body = airframe(self.home, math.radians(options.heading), options.wind_vector(),
                             self.parameters)
        self.ready_after, self.drift = options.ready_after, options.drift
        self.stiff_after = options.stiff_after
        self.time = 0.0  # of flight simulation, s since boot
        self.booted_at = 0.0
        self.mode, self.armed, self.started = MANUAL, False, False
        self.auto, self.guided = Auto(self), Guided(self)
        self.hold = None
        self.goal = IDLE
        self.landed_for = 0.0
        self.takeoff_target = self.returning = None
        self.home_was_set = False  # by a command; otherwise it is where the vehicle arms

    # What other parts ask and report.

    def boot_ms(self):
        return int((self.time - self.booted_at) * 1000 + 0.5)

    def mission_items(self):
        return self.node.missions.plans[MISSION]

    def current_item(self):
        return self.auto.current() if self.mission_items() else 0

    def mission_runs(self):
        return self.mode == AUTO and self.armed

    def terrain_height(self, lat, lon):
        return self.node.terrain.height(lat, lon)

    def text(self, severity, text):
        self.node.text(severity, text)

    def reached(self, index):
        self.node.log("reached", item=index)
        self.node.send("MISSION_ITEM_REACHED", {"seq": index})

    def current_changed(self):
        """ArduPilot leaves it to the stream."""
        if self.flavour.name != "ardupilot":
            self.node.telemetry.send("MISSION_CURRENT")

    def change_speed(self, speed):
        """-1: as before, -2: the default again."""
        if 0 < speed < math.inf:
            self.body.speed = speed
        elif speed == -2:
            self.body.speed = None

    def plan_changed(self, kind, keeps_index=False):
        if kind != MISSION:
            return
        auto = self.auto
        if keeps_index and auto.set_current(auto.current()):
            pass  # PX4 begins where the old mission was
        elif self.flavour.name != "ardupilot" or auto.current() >= len(self.mission_items()):
            auto.restart()
        elif self.mission_runs() and self.kind == "copter":
            auto.resume()  # the same item of the new plan; a plane completes the old one
        self.node.log("plan", items=len(self.mission_items()), current=self.current_item())
        self.current_changed()

    # Arming and modes.

    def arm(self, force=False):
        problem = None if force else self.arming_problem()
        if problem:
            self.text(Severity.CRITICAL, f"Arm: {problem}")
            return False
        self.armed, self.started, self.landed_for = True, False, 0.0
        if self.body.on_ground and not self.home_was_set:
            self.home = self.body.position
            self.node.telemetry.send("HOME_POSITION")
        self.node.log("armed")
        return True

    def arming_problem(self):
        if self.time - self.booted_at < self.ready_after:
            return "Need Position Estimate"
        if self.kind == "copter" and not self.flavour.arms_in_auto and self.mode in (AUTO, RTL,
                                                                                     LAND):
            return f"{self.mode} mode not armable"
        return None

    def disarm(self, force=False):
        if not (self.body.on_ground or force):
            return False
        self.armed = False
        self.node.log("disarmed")
        if self.flavour.name == "ardupilot" and (self.kind == "copter" or self.mode != AUTO):
            self.auto.restart()
        return True

    def set_mode(self, mode, reason="command"):
        problem = self.mode_problem(mode)
        if problem:
            self.text(Severity.WARNING, f"Mode {mode} refused: {problem}")
            return False
        if mode != self.mode or mode == TAKEOFF:
            self.node.log("mode", mode=mode, before=self.mode, reason=reason)
            self.mode = mode
            self.enter(mode)
            if self.flavour.name == "ardupilot":
                self.node.telemetry.send("HEARTBEAT")
        return True

    def mode_problem(self, mode):
        numbers = flavours.mode_numbers(self.flavour, self.kind)
        if mode is None or (numbers is not None and mode not in numbers):
            return "unknown mode"
        if mode == AUTO:
            return self.mission_problem()
        if mode == GUIDED and self.flavour.stream_needed and not self.guided.stream_is_fresh():
            return "no stream of set-points"
        return None

    def mission_problem(self):
        items = self.mission_items()
        if len(items) <= self.auto.first():
            return "no mission"
        if self.node.faults.infeasible():
            return self.node.faults.infeasible()
        grounded = self.armed and self.body.on_ground
        if self.kind == "copter" and self.flavour.name == "ardupilot" and grounded:
            commands = [item.command for item in items[1:]]
            if commands[0] != Command.NAV_TAKEOFF:
                return "Missing Takeoff Cmd"
        return None

    def enter(self, mode):
        self.hold = self.body.stop_here()
        if mode == AUTO:
            self.auto.resume()
        elif mode == GUIDED:
            self.guided.enter()
        elif mode == RTL:
            self.begin_return()

    def take_off(self, height):
        """By NAV_TAKEOFF as a command."""
        if not self.armed:
            return False
        target = self.home.at(self.home.alt + height)
        arducopter = self.flavour.name == "ardupilot" and self.kind == "copter"
        if arducopter or self.flavour.name == "generic":
            if self.mode != GUIDED and (arducopter or not self.set_mode(GUIDED)):
                return False
            self.guided.take_off(target)
            return True
        self.takeoff_target = target
        return self.set_mode(TAKEOFF)

    # One step of the flight.

    def step(self, dt):
        self.time += dt
        self.guided.watch()
        goal = self.goal_of_mode(dt) if self.armed else IDLE
        self.goal = goal
        self.body.step(dt, goal, self.ground)
        self.after_landing(dt)

    def goal_of_mode(self, dt):
        if self.mode == AUTO:
            return self.auto_goal(dt)
        if self.mode == GUIDED:
            goal = self.guided.goal()
            if self.drift and goal.kind == "velocity":
                north, east, up = goal.velocity
                goal = dataclasses.replace(goal, velocity=(north, east, up + self.drift))
            if self.time > self.guided.entered_at + self.stiff_after and goal.target:
                return Goal("takeoff", goal.target)  # straight on, at that height
            return goal
        if self.mode == TAKEOFF:
            return self.takeoff_goal()
        if self.body.on_ground:
            return IDLE
        if self.mode == RTL:
            return self.go_home()
        if self.mode == LAND:
            return Goal("land", self.hold.target)
        if self.mode == POSITION:
            return self.without_a_radio()
        return self.hold or IDLE

    def auto_goal(self, dt):
        waits = self.kind == "copter" and self.flavour.name == "ardupilot" and not self.started
        if waits and self.body.on_ground:
            return IDLE
        goal = self.auto.step(dt)
        if goal is not None:
            return goal
        if self.body.on_ground:
            self.disarm()
            return IDLE
        return self.after_mission()

    def after_mission(self):
        """The last item is done in the air: ArduCopter stays in AUTO and hovers."""
        if self.flavour.name == "ardupilot" and self.kind == "copter":
            if self.goal.kind != "loiter":
                self.hold = self.body.stop_here()
            return self.hold
        plane = self.flavour.name == "ardupilot"
        self.set_mode(RTL if plane else HOLD, "mission complete")
        return self.goal_of_mode(0.0)

    def takeoff_goal(self):
        target = self.takeoff_target or self.home.at(self.home.alt + 50.0)
        goal = Goal("takeoff", target)
        if self.body.on_ground or not self.body.arrived(goal):
            return goal
        self.hold = self.body.stop_here()
        self.takeoff_target = None
        self.set_mode(HOLD, "takeoff complete")
        return self.hold

    def begin_return(self):
        self.returning = "climb" if self.kind == "copter" else "fly"
        self.return_from = self.body.position
        alt = self.home.alt + self.parameters["RTL_ALT"]
        self.return_alt = max(alt, self.body.position.alt) if self.kind == "copter" else alt

    def go_home(self):
        """Goal of RTL: a copter climbs, flies home and lands; a plane circles over home."""
        if self.returning is None:
            self.begin_return()
        over_home = self.home.at(self.return_alt)
        if self.kind == "plane":
            return Goal("loiter", over_home, radius=self.parameters["WP_LOITER_RAD"])
        body = self.body
        if self.returning == "climb":
            if body.position.alt < self.return_alt - 1.0:
                return Goal("loiter", self.return_from.at(self.return_alt))
            self.returning = "fly"
        if self.returning == "fly":
            if geodesy.horizontal(body.position, self.home) > self.parameters["WPNAV_RADIUS"]:
                return Goal("leg", over_home, self.return_from.at(self.return_alt))
            self.returning = "land"
        return Goal("land", self.home)

    def after_landing(self, dt):
        if not (self.armed and self.body.on_ground):
            self.landed_for = 0.0
            return
        self.landed_for += dt
        if self.goal.kind == "land" and self.mode != AUTO and self.body.arrived(self.goal):
            self.disarm()
        elif self.kind == "copter" and self.landed_for > self.parameters["DISARM_DELAY"] > 0:
            self.disarm()

    def without_a_radio(self):
        """POSCTL with sticks that nobody holds: a copter sinks, a plane flies straight on."""
        if self.kind == "copter":
            return Goal("velocity", velocity=(0.0, 0.0, -SINK))
        yaw = self.body.course()
        ahead = geodesy.offset(self.body.position, 1e4 * math.cos(yaw), 1e4 * math.sin(yaw), 0.0)
        return Goal("leg", ahead.at(self.hold.target.alt))

    def lose_set_points(self):
        mode = SETPOINT_LOSS[self.parameters["COM_OBL_RC_ACT"]]
        self.text(Severity.CRITICAL, f"Failsafe: no set-points, {mode}")
        self.set_mode(mode, "failsafe")

    def reboot(self):
        """In flight the restarted autopilot holds where it is, armed as it was."""
        self.booted_at = self.time
        self.body.speed = None
        self.auto.restart()
        self.guided = Guided(self)
        if self.body.on_ground:
            self.armed, self.mode = False, MANUAL
        else:
            self.mode = HOLD
            self.hold = self.body.stop_here()
        self.node.log("mode", mode=self.mode, reason="reboot")

    def guided_item(self, message):
        """ArduPilot: an item with current = 2 is flown to in GUIDED, with 3 only its altitude."""
        if self.mode != GUIDED or message.command != Command.NAV_WAYPOINT:
            return MissionResult.ERROR
        refusal = plans.refusal(plans.of_message(message), MISSION, True)
        if refusal != MissionResult.ACCEPTED:
            return refusal
        scale = 1e7 if message.name == "MISSION_ITEM_INT" else 1.0
        alt = message.z if message.frame in (Frame.GLOBAL, Frame.GLOBAL_INT) \
            else message.z + self.home.alt
        if message.current == 3:
            self.guided.change_altitude(alt)
        else:
            self.guided.go_to(geodesy.Position(message.x / scale, message.y / scale, alt))
        return MissionResult.ACCEPTED
