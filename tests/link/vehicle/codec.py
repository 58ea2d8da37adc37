# SPDX-License-Identifier: Apache-2.0
"""MAVLink 2 frames: encoding, parsing a stream with damage in it, and signatures."""
import hashlib
import time

import checksum
import messages

MAGIC = 0xFD
HEADER = 10
SIGNED = 0x01
SIGNATURE = 13
# Signature timestamps count 10 us since the beginning of 2015.
EPOCH_2015 = 1420070400
ONE_MINUTE = 6_000_000


class Received:
    """A message that came whole: `name` is of the table, or None for an id that is not in it."""

    def __init__(self, number, system, component, sequence, payload):
        self.number, self.system, self.component = number, system, component
        self.sequence = sequence
        known = messages.BY_NUMBER.get(number)
        self.name = known.name if known else None
        self.fields = known.decode(payload) if known else {}

    def __getattr__(self, field):
        try:
            return self.__dict__["fields"][field]
        except KeyError:
            raise AttributeError(field) from None


class Signer:
    """Signs and verifies with one key; `clock` gives Unix time in seconds."""

    def __init__(self, key, link=0, clock=time.time):
        if len(key) != 32:
            raise ValueError(f"the key has {len(key)} bytes, a MAVLink key has 32")
        self.key, self.link, self.clock = key, link, clock
        self.timestamp = 0
        self.streams = {}

    def advance(self):
        """A timestamp greater than every earlier one."""
        now = int((self.clock() - EPOCH_2015) * 1e5)
        self.timestamp = max(self.timestamp + 1, now)
        return self.timestamp

    def digest(self, frame, tail):
        return hashlib.sha256(self.key + frame + tail).digest()[:6]

    def sign(self, frame):
        tail = bytes([self.link]) + self.advance().to_bytes(6, "little")
        return frame + tail + self.digest(frame, tail)

    def accepts(self, frame, signature, sender):
        tail = signature[:7]
        if signature[7:] != self.digest(frame, tail):
            return False
        stream = (*sender, tail[0])
        timestamp = int.from_bytes(tail[1:], "little")
        now = max(self.timestamp, int((self.clock() - EPOCH_2015) * 1e5))
        previous = self.streams.get(stream, now - ONE_MINUTE - 1)
        if timestamp <= previous or timestamp < now - ONE_MINUTE:
            return False
        self.streams[stream] = timestamp
        self.timestamp = max(self.timestamp, timestamp)
        return True


class Encoder:
    def __init__(self, system, component, signer=None):
        self.system, self.component, self.signer = system, component, signer
        self.sequence = 0

    def frame(self, name, values):
        message = messages.BY_NAME[name]
        payload = message.encode(values)
        flags = SIGNED if self.signer else 0
        body = bytes([len(payload), flags, 0, self.sequence, self.system, self.component])
        body += message.number.to_bytes(3, "little") + payload
        crc = checksum.crc16(body + bytes([message.crc_extra]))
        self.sequence = (self.sequence + 1) % 256
        frame = bytes([MAGIC]) + body + crc.to_bytes(2, "little")
        return self.signer.sign(frame) if self.signer else frame


class Parser:
    """Bytes in, messages out. What is damaged is dropped and counted, and the search for the next
    frame begins at the byte after its magic one: a damaged length must not swallow what follows."""

    def __init__(self, signer=None):
        self.signer = signer
        self.buffer = b""
        self.counts = {"damaged": 0, "unknown": 0, "unsigned": 0, "bad_signature": 0}

    def feed(self, data):
        self.buffer += data
        received = []
        while True:
            start = self.buffer.find(MAGIC)
            self.buffer = self.buffer[start:] if start >= 0 else b""
            size = self.frame_size()
            if size is None or len(self.buffer) < size:
                return received
            consumed = self.take(self.buffer[:size], received)
            self.buffer = self.buffer[consumed:]

    def end_datagram(self):
        """A datagram holds whole frames: what is left of one is damaged."""
        rest, self.buffer = self.buffer, b""
        if not rest:
            return []
        self.counts["damaged"] += 1
        received = self.feed(rest[1:])
        return received + self.end_datagram()

    def frame_size(self):
        if len(self.buffer) < HEADER:
            return None
        signature = SIGNATURE if self.buffer[2] & SIGNED else 0
        return HEADER + self.buffer[1] + 2 + signature

    def take(self, frame, received):
        """Appends the frame's message to `received` if it is accepted; returns the bytes used."""
        length, flags = frame[1], frame[2]
        number = int.from_bytes(frame[7:10], "little")
        known = messages.BY_NUMBER.get(number)
        checked = frame[:HEADER + length + 2]
        if flags & ~SIGNED:
            self.counts["unknown"] += 1
            return 1
        if known is None:
            # Without its CRC_EXTRA the length cannot be trusted either.
            self.counts["unknown"] += 1
            return 1
        expected = checksum.crc16(checked[1:-2] + bytes([known.crc_extra]))
        if int.from_bytes(checked[-2:], "little") != expected:
            self.counts["damaged"] += 1
            return 1
        if self.admitted(checked, frame[len(checked):]):
            payload = frame[HEADER:HEADER + length]
            received.append(Received(number, frame[5], frame[6], frame[4], payload))
        return len(frame)

    def admitted(self, checked, signature):
        if not self.signer:
            return True
        if not signature:
            self.counts["unsigned"] += 1
            return False
        if not self.signer.accepts(checked, signature, (checked[5], checked[6])):
            self.counts["bad_signature"] += 1
            return False
        return True
