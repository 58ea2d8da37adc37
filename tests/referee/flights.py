# SPDX-License-Identifier: Apache-2.0
"""A track held against the true world as it was at each of its points."""
import numpy as np

import rules
import solids


class World:
    """All that is there, known or not, as events change it."""

    def __init__(self, mission):
        self.layers = {layer.id: layer for layer in mission.layers}
        self.moving = {m.id: (m, 0.0, np.zeros(3)) for m in mission.moving}
        self.to_come, self.goal = list(mission.events), mission.goal
        self.changed = True
        self.set = None

    def arrive(self, t, p):
        """What happens when the vehicle is there."""
        left = []
        for event in self.to_come:
            at_s, near, change = event
            happens = t >= at_s - 1e-9 if near is None else (
                np.linalg.norm(p - near[0]) <= near[1] + 1e-9)
            if happens:
                self.happen(t, *change)
            else:
                left.append(event)
        self.to_come = left

    def happen(self, t, what, *of):
        self.changed = True
        if what == "move_goal":
            self.goal, = of
        elif what == "add":
            layer, = of
            if layer.velocity is None:
                self.layers[layer.id] = layer
            else:
                self.moving[layer.id] = (layer, t, np.zeros(3))
        elif what == "remove":
            self.layers.pop(of[0], None)
            self.moving.pop(of[0], None)
        elif of[0] in self.moving:
            layer, since, by = self.moving[of[0]]
            self.moving[of[0]] = (layer, since, by + of[1])
        else:
            layer = self.layers[of[0]]
            self.layers[of[0]] = type(layer)(layer.id, [s.moved(of[1]) for s in layer.solids],
                                             layer.ground, layer.known)

    def standing(self):
        if self.changed:
            self.set = solids.Set([s for layer in self.layers.values() for s in layer.solids])
            self.changed = False
        return self.set

    def grounds(self):
        return [layer.ground for layer in self.layers.values() if layer.ground is not None]

    def movers(self, t0, t1, a, b):
        """The same leg as those see it that move: solids, and the leg's ends in their places."""
        for layer, since, by in self.moving.values():
            for solid in layer.solids:
                yield (solid, a - by - layer.velocity * (t0 - since),
                       b - by - layer.velocity * (t1 - since))


class Flight:
    """Findings and figures of a track of [t, x, y, z]."""

    def __init__(self, mission, limits, track):
        self.track = np.array(track, float)
        self.times, self.route = self.track[:, 0], self.track[:, 1:]
        self.judge = rules.Judge(mission, limits)
        self.mission, self.limits = mission, limits
        self.separation, self.contact_at = None, None
        self.min_gap = np.inf
        self.world = World(mission)
        self.fly()

    def fly(self):
        count = len(self.track)
        k = 0
        while k < count:
            self.world.arrive(self.times[k], self.route[k])
            first = k
            k += 1
            # Legs that are flown in one world are asked together.
            while k < count - 1 and not self.something_at(k):
                k += 1
            a, b = self.route[first:k], self.route[first + 1:k + 1]
            if len(b) < len(a):  # the last point, in the world as it is when it is reached
                b = a[-1:]
                a = b
            self.stretch(first, a, b)
        self.ends()

    def something_at(self, k):
        return any(self.times[k] >= at_s - 1e-9 if near is None
                   else np.linalg.norm(self.route[k] - near[0]) <= near[1] + 1e-9
                   for at_s, near, _ in self.world.to_come)

    def stretch(self, first, a, b):
        standing = self.world.standing()
        at = first + np.arange(len(a))
        near = standing.nearest(a, b)
        if near is not None:
            self.come_to(near[0], at[near[1]])
        self.meet(at, a, b)
        if first + 1 == len(self.route):
            return  # no leg: what came over the vehicle there is a collision, and no more
        self.judge.clearances(a, b, standing, at)
        grounds = self.world.grounds()
        gaps = self.judge.heights(at, a, b, grounds)
        if grounds:
            self.min_gap = min(self.min_gap, float(np.nanmin(gaps)))

    def meet(self, at, a, b):
        """What moves, in legs from the time of one point to that of the next."""
        t0, t1 = self.times[at][:, None], self.times[np.minimum(at + 1, len(self.times) - 1)][:, None]
        for solid, c, d in self.world.movers(t0, t1, a, b):
            near = solids.Set([solid]).nearest(c, d)
            self.come_to(near[0], at[near[1]])

    def come_to(self, value, leg):
        if self.separation is None or value < self.separation:
            self.separation, self.contact_at = value, leg

    def ends(self):
        judge = self.judge
        judge.steepness(self.route)
        judge.length(self.route)
        judge.volume(self.route)
        judge.below("start", 0, np.linalg.norm(self.route[0] - self.mission.start), 0)
        judge.below("goal", len(self.route) - 1, np.linalg.norm(self.route[-1] - self.world.goal),
                    self.mission.tolerance)
        lengths = np.linalg.norm(np.diff(self.route, axis=0), axis=1)
        top = max([self.mission.speed] + [s for _, s in self.mission.speed_near])
        for i, (length, dt) in enumerate(zip(lengths, np.diff(self.times))):
            judge.add("speed", i, 0, 0, length - top * dt)

    def collided(self):
        """How deep inside of what it may touch the vehicle was, as an excess; None: of nothing."""
        return None if self.separation is None else self.mission.radius - self.separation
