# SPDX-License-Identifier: Apache-2.0
"""The vehicle's side of the mission protocol, https://mavlink.io/en/services/mission.html: uploads
that it drives by asking for each item, downloads that it answers, clearing. Where autopilots differ
from the page or it leaves the choice, the flavour says what is done."""
import dataclasses

import plans
from constants import ALL_PLANS, FENCE, MISSION, RALLY, MissionResult, Severity

KINDS = (MISSION, FENCE, RALLY)
IN_TEXTS = {MISSION: "Mission", FENCE: "Fence", RALLY: "Rally"}


@dataclasses.dataclass
class Upload:
    partner: tuple  # system, component, address
    kind: int
    expected: int  # the item asked for
    last: int
    requested_at: float
    received_at: float
    items: list  # as they came; of a partial upload with those before
    names_current: bool = False  # item 0 is marked as the current one


class Missions:
    """`node` sends messages; `pilot` is asked for home and whether a mission runs, and hears of
    changed plans; `changes` is how a faulty vehicle alters items."""

    def __init__(self, flavour, airframe, node, pilot, capacity, storage=None):
        self.flavour, self.airframe = flavour, airframe
        self.node, self.pilot = node, pilot
        self.capacity = capacity
        self.storage = storage or flavour.storage
        self.plans = {kind: [] for kind in KINDS}
        if flavour.name == "ardupilot":
            self.plans[MISSION] = [plans.home_item(pilot.home)]
        self.restart()

    def restart(self):
        """What a reboot loses: all but the plans."""
        self.upload = None
        self.acknowledged = None  # the last upload: partner, kind, last item, result
        self.listed = None

    def handle(self, message, address):
        sender = (message.system, message.component, address)
        kind = message.fields.get("mission_type", MISSION)
        clears_all = kind == ALL_PLANS and message.name == "MISSION_CLEAR_ALL" and \
            self.flavour.name != "ardupilot"
        if kind not in KINDS and not clears_all:
            self.acknowledge(sender, kind, MissionResult.UNSUPPORTED)
            return
        injected = self.node.faults.nak(message)
        if injected is not None:
            self.upload = None
            self.acknowledge(sender, kind, injected)
            return
        getattr(self, "on_" + message.name.lower())(message, sender, kind)

    # Uploads.

    def on_mission_count(self, message, sender, kind):
        if self.busy(sender, kind):
            return
        upload = self.upload
        if upload and self.flavour.name == "px4":
            if upload.expected == 0:
                self.request()
            else:
                self.acknowledge(sender, kind, MissionResult.ERROR)
            return
        if message.count > self.capacity:
            self.acknowledge(sender, kind, MissionResult.NO_SPACE)
            return
        if message.count == 0:
            self.upload = None
            self.plans[kind] = []
            self.finish(sender, kind, [])
            return
        if self.overwrites(kind):
            del self.plans[kind][message.count:]
        self.begin(sender, kind, 0, message.count - 1, [])

    def on_mission_write_partial_list(self, message, sender, kind):
        if self.busy(sender, kind):
            return
        first, last = message.start_index, message.end_index
        if not self.flavour.partial_upload:
            self.acknowledge(sender, kind, MissionResult.UNSUPPORTED)
        elif self.upload is not None and self.flavour.name == "ardupilot":
            self.acknowledge(sender, kind, MissionResult.DENIED)
        elif not 0 <= first <= last or last >= len(self.stored(kind)):
            self.acknowledge(sender, kind, MissionResult.ERROR)
        else:
            self.begin(sender, kind, first, last, list(self.plans[kind]))

    def overwrites(self, kind):
        """Whether items replace those of the old plan as they come; ArduPilot's fences wait."""
        waits = kind == FENCE and self.flavour.name == "ardupilot"
        return self.storage == "overwrite" and not waits

    def busy(self, sender, kind):
        """Answers a second partner while the first one's upload is under way."""
        if self.upload is None or self.upload.partner[:2] == sender[:2]:
            return False
        self.acknowledge(sender, kind, MissionResult[self.flavour.other_partner])
        return True

    def begin(self, sender, kind, first, last, items):
        now = self.node.now
        self.upload = Upload(sender, kind, first, last, now, now, items)
        self.request()

    def request(self):
        upload = self.upload
        upload.requested_at = self.node.now
        self.node.send(self.flavour.request, self.addressed(upload.partner, upload.kind,
                                                            seq=upload.expected))

    def on_mission_item(self, message, sender, kind):
        self.on_mission_item_int(message, sender, kind)

    def on_mission_item_int(self, message, sender, kind):
        upload = self.upload
        if upload is None:
            self.item_without_upload(message, sender, kind)
        elif self.flavour.name == "ardupilot" and message.seq != upload.expected:
            self.item_out_of_order(sender, kind)
        elif self.busy(sender, kind):
            pass
        elif kind != upload.kind:
            self.acknowledge(sender, kind, MissionResult.ERROR)
        elif message.seq != upload.expected:
            self.item_out_of_order(sender, kind)
        else:
            upload.names_current |= message.seq == 0 and message.current == 1
            self.store(plans.of_message(message), sender)

    def item_without_upload(self, message, sender, kind):
        if message.current in (2, 3) and self.flavour.name == "ardupilot":
            self.acknowledge(sender, kind, self.pilot.guided_item(message))
            return
        if self.flavour.idle_item == "acknowledge" and self.acknowledged is not None:
            partner, last_kind, last, result = self.acknowledged
            if (partner[:2], last_kind, last) == (sender[:2], kind, message.seq):
                self.acknowledge(sender, kind, result)
                return
        self.acknowledge(sender, kind, MissionResult.ERROR)

    def item_out_of_order(self, sender, kind):
        if self.flavour.out_of_order == "nak":
            self.acknowledge(sender, kind, MissionResult.INVALID_SEQUENCE)
        elif self.flavour.out_of_order == "request":
            self.request()

    def store(self, item, sender):
        upload = self.upload
        ardupilot = self.flavour.name == "ardupilot"
        result = plans.refusal(item, upload.kind, ardupilot)
        if ardupilot and plans.jumps_nowhere(item, upload.last + 1):
            result = MissionResult.ERROR
        if result == MissionResult.ACCEPTED and self.node.faults.refuses(item):
            result = MissionResult.UNSUPPORTED_FRAME
        if result != MissionResult.ACCEPTED:
            self.refuse(sender, result)
            return
        if ardupilot:
            item = plans.as_ardupilot_keeps(item, self.airframe, upload.kind)
        item = self.node.faults.changed(item)
        target = self.plans[upload.kind] if self.overwrites(upload.kind) else upload.items
        # The first item that ArduPilot stores at all comes after its own home.
        added = [item] if target or not ardupilot or upload.kind != MISSION else [item, item]
        target[upload.expected:upload.expected + 1] = added
        upload.received_at = self.node.now
        upload.expected += 1
        if upload.expected <= upload.last:
            self.request()
        else:
            self.finish(sender, upload.kind, target)

    def refuse(self, sender, result):
        kind = self.upload.kind
        self.upload = None
        self.acknowledge(sender, kind, result)

    def finish(self, sender, kind, items):
        """The whole plan is there: it is checked as one and replaces the old plan."""
        last = self.upload.last if self.upload else -1
        # PX4 keeps the index of the old mission unless an item of the new one is marked.
        keeps_index = self.flavour.name == "px4" and self.upload and not self.upload.names_current
        self.upload = None
        result = plans.refusal_of_whole(items, kind)
        if result == MissionResult.ACCEPTED:
            self.plans[kind] = [item for item in items if not self.node.faults.drops(item)]
            self.node.log("stored", kind=kind, items=[plans.listed(each)
                                                      for each in self.plans[kind]])
            self.pilot.plan_changed(kind, keeps_index)
            if self.flavour.name == "ardupilot" and kind == MISSION:
                self.node.text(Severity.INFO, "Flight plan received")
        elif self.flavour.name == "ardupilot":
            result = MissionResult.ERROR
        self.acknowledged = (sender, kind, last, result)
        self.acknowledge(sender, kind, result)
        if kind == MISSION and self.node.faults.infeasible():
            self.node.text(Severity.CRITICAL, f"Mission rejected: {self.node.faults.infeasible()}\t")

    def on_mission_ack(self, message, sender, kind):
        upload = self.upload
        if message.type == MissionResult.ACCEPTED or upload is None or kind != upload.kind:
            return
        if upload.partner[:2] == sender[:2] and self.flavour.cancels_uploads:
            self.upload = None

    def step(self):
        """Asks again for what did not come, and gives up."""
        upload, now = self.upload, self.node.now
        if upload is None:
            return
        if now - upload.received_at >= self.flavour.give_up_after:
            self.upload = None
            self.node.text(Severity.WARNING, f"{IN_TEXTS[upload.kind]} upload timeout")
            if self.flavour.name != "px4":
                self.acknowledge(upload.partner, upload.kind, MissionResult.OPERATION_CANCELLED)
        elif now - upload.requested_at >= self.flavour.resend_after:
            self.request()

    # Downloads.

    def stored(self, kind):
        """As a reader sees it: ArduPilot's item 0 is home, whatever was uploaded there."""
        items = self.plans[kind]
        if kind == MISSION and items and self.flavour.home_is_item_0:
            return [plans.home_item(self.pilot.home)] + items[1:]
        return items

    def on_mission_request_list(self, message, sender, kind):
        self.answer_count(sender, kind, len(self.stored(kind)))

    def on_mission_request_partial_list(self, message, sender, kind):
        """The page leaves the answer open: here the number of items, which are then asked for by
        their own sequence numbers."""
        size = len(self.stored(kind))
        last = message.end_index if message.end_index >= 0 else size - 1
        if self.flavour.name == "ardupilot":
            return  # a message that it does not know
        if not self.flavour.partial_upload:
            self.acknowledge(sender, kind, MissionResult.UNSUPPORTED)
        elif not 0 <= message.start_index <= last < size:
            self.acknowledge(sender, kind, MissionResult.ERROR)
        else:
            self.answer_count(sender, kind, last - message.start_index + 1)

    def answer_count(self, sender, kind, count):
        if self.upload is not None:
            self.acknowledge(sender, kind, MissionResult[self.flavour.other_partner])
            return
        self.listed = sender[:2]
        identifier = plans.opaque_id(self.plans[kind]) if self.flavour.opaque_ids else 0
        self.node.send("MISSION_COUNT", self.addressed(sender, kind, count=count,
                                                       opaque_id=identifier))

    def on_mission_request_int(self, message, sender, kind):
        item = self.requested(message, sender, kind)
        if item is not None:
            self.node.send("MISSION_ITEM_INT", self.outgoing(item, message.seq, sender, kind))

    def on_mission_request(self, message, sender, kind):
        """Deprecated; the page wants MISSION_ITEM_INT in answer, ArduPilot sends MISSION_ITEM."""
        if self.flavour.name != "ardupilot":
            self.on_mission_request_int(message, sender, kind)
            return
        item = self.requested(message, sender, kind)
        if item is not None:
            fields = self.outgoing(item, message.seq, sender, kind)
            self.node.send("MISSION_ITEM", {**fields, "x": item.x / 1e7, "y": item.y / 1e7})

    def requested(self, message, sender, kind):
        items = self.stored(kind)
        if self.upload is not None:
            self.acknowledge(sender, kind, MissionResult[self.flavour.other_partner])
        elif self.flavour.list_first and self.listed != sender[:2]:
            pass
        elif message.seq < len(items):
            return items[message.seq]
        elif self.flavour.home_is_item_0 and kind == MISSION and message.seq == 0:
            return plans.home_item(self.pilot.home)
        else:
            if self.flavour.name == "ardupilot" and message.name == "MISSION_REQUEST_INT":
                self.answer_count(sender, kind, len(items))
            self.acknowledge(sender, kind, MissionResult.INVALID_SEQUENCE)
        return None

    def outgoing(self, item, sequence, sender, kind):
        current = int(kind == MISSION and sequence == self.pilot.current_item())
        return self.addressed(sender, kind, seq=sequence, current=current,
                              **plans.fields_of(item))

    # Clearing.

    def on_mission_clear_all(self, message, sender, kind):
        kinds = KINDS if kind == ALL_PLANS else (kind,)
        flying_it = MISSION in kinds and self.pilot.mission_runs()
        if self.upload is not None and not self.restarts(sender, kind):
            self.acknowledge(sender, kind, MissionResult.ERROR)
        elif flying_it and self.flavour.name == "ardupilot":
            self.acknowledge(sender, kind, MissionResult.ERROR)
        else:
            for each in kinds:
                self.plans[each] = []
                self.pilot.plan_changed(each)
            self.acknowledge(sender, kind, MissionResult.ACCEPTED)

    def restarts(self, sender, kind):
        """ArduPilot lets the partner of an upload begin anew, and denies it to others before it
        reports an error."""
        if self.flavour.name != "ardupilot" or self.busy(sender, kind):
            return False
        self.upload = None
        return True

    def acknowledge(self, partner, kind, result):
        fields = self.addressed(partner, kind, type=int(result))
        if result == MissionResult.ACCEPTED and self.flavour.opaque_ids and kind in KINDS:
            fields["opaque_id"] = plans.opaque_id(self.plans[kind])
        self.node.send("MISSION_ACK", fields)

    @staticmethod
    def addressed(partner, kind, **fields):
        return {"target_system": partner[0], "target_component": partner[1],
                "mission_type": kind, **fields}
