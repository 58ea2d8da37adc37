# SPDX-License-Identifier: Apache-2.0
"""The vehicle's codec against values that the specification and its reference libraries publish."""
import math
import random
import unittest

import checksum
import codec
import messages

# CRC_EXTRA as the reference C library's generated headers have it.
CRC_EXTRA = {
    "HEARTBEAT": 50, "SYS_STATUS": 124, "SYSTEM_TIME": 137, "PING": 237, "SET_MODE": 89,
    "PARAM_REQUEST_READ": 214, "PARAM_REQUEST_LIST": 159, "PARAM_VALUE": 220, "PARAM_SET": 168,
    "GPS_RAW_INT": 24, "ATTITUDE": 39, "LOCAL_POSITION_NED": 185, "GLOBAL_POSITION_INT": 104,
    "MISSION_REQUEST_PARTIAL_LIST": 212, "MISSION_WRITE_PARTIAL_LIST": 9, "MISSION_ITEM": 254,
    "MISSION_REQUEST": 230, "MISSION_SET_CURRENT": 28, "MISSION_CURRENT": 28,
    "MISSION_REQUEST_LIST": 132, "MISSION_COUNT": 221, "MISSION_CLEAR_ALL": 232,
    "MISSION_ITEM_REACHED": 11, "MISSION_ACK": 153, "GPS_GLOBAL_ORIGIN": 39,
    "MISSION_REQUEST_INT": 196, "NAV_CONTROLLER_OUTPUT": 183, "REQUEST_DATA_STREAM": 148,
    "MISSION_ITEM_INT": 38, "VFR_HUD": 20, "COMMAND_INT": 158, "COMMAND_LONG": 152,
    "COMMAND_ACK": 143, "SET_POSITION_TARGET_LOCAL_NED": 143, "POSITION_TARGET_LOCAL_NED": 140,
    "SET_POSITION_TARGET_GLOBAL_INT": 5, "POSITION_TARGET_GLOBAL_INT": 150, "RADIO_STATUS": 185,
    "TIMESYNC": 34, "TERRAIN_REQUEST": 6, "TERRAIN_DATA": 229, "TERRAIN_CHECK": 203,
    "TERRAIN_REPORT": 1, "AUTOPILOT_VERSION": 178, "WIND": 1, "WIND_COV": 105,
    "HOME_POSITION": 104, "MESSAGE_INTERVAL": 95, "EXTENDED_SYS_STATE": 130, "STATUSTEXT": 83,
    "PROTOCOL_VERSION": 217}
# Bytes of the payload without and with extensions.
LENGTHS = {"HEARTBEAT": (9, 9), "MISSION_ITEM_INT": (37, 38), "MISSION_COUNT": (4, 9),
           "COMMAND_LONG": (33, 33), "GLOBAL_POSITION_INT": (28, 28), "SYS_STATUS": (31, 43),
           "MISSION_ACK": (3, 8), "STATUSTEXT": (51, 54), "TERRAIN_DATA": (43, 43),
           "SET_POSITION_TARGET_GLOBAL_INT": (53, 53), "HOME_POSITION": (52, 60)}
KEY = bytes(range(32))


def random_fields(message, rng):
    fields = {}
    for field in message.fields:
        if field.type == "char":
            text = "".join(rng.choice("ABC_xyz09 ") for _ in range(rng.randint(0, field.length)))
            fields[field.name] = text
        elif field.length:
            fields[field.name] = [rng.randint(0, 100) for _ in range(field.length)]
        elif field.type == "float":
            fields[field.name] = rng.randint(-10 ** 6, 10 ** 6) / 64
        else:
            bits = 8 * field.size
            signed = not field.type.startswith("u")
            low, high = (-2 ** (bits - 1), 2 ** (bits - 1) - 1) if signed else (0, 2 ** bits - 1)
            fields[field.name] = rng.choice([0, low, high, rng.randint(low, high)])
    return fields


class Vectors(unittest.TestCase):
    def test_checksum(self):
        """The check value of CRC-16/MCRF4XX."""
        self.assertEqual(checksum.crc16(b"123456789"), 0x6F91)

    def test_crc_extra(self):
        computed = {name: message.crc_extra for name, message in messages.BY_NAME.items()}
        self.assertEqual(computed, CRC_EXTRA)

    def test_lengths(self):
        for name, lengths in LENGTHS.items():
            message = messages.BY_NAME[name]
            base = sum(field.size * max(1, field.length) for field in message.base)
            self.assertEqual((base, message.layout.size), lengths, name)

    def test_bytes_of_a_heartbeat(self):
        """Larger fields first, little-endian, the header as in the page of serialisation."""
        frame = codec.Encoder(1, 1).frame("HEARTBEAT", {
            "type": 2, "autopilot": 3, "base_mode": 81, "custom_mode": 0x01020304,
            "system_status": 3, "mavlink_version": 3})
        self.assertEqual(frame[:10].hex(), "fd09000000010100" "0000")
        self.assertEqual(frame[10:19].hex(), "04030201" "02035103" "03")
        crc = checksum.crc16(frame[1:19] + bytes([50]))
        self.assertEqual(int.from_bytes(frame[19:], "little"), crc)

    def test_truncated_zeros(self):
        """Zeros at the end are left out, but never the first byte."""
        encoder = codec.Encoder(1, 1)
        self.assertEqual(encoder.frame("MISSION_CURRENT", {})[1], 1)
        self.assertEqual(encoder.frame("MISSION_CURRENT", {"seq": 256})[1], 2)
        parser = codec.Parser()
        message, = parser.feed(encoder.frame("COMMAND_LONG", {"param1": 2.5}))
        self.assertEqual((message.param1, message.param7, message.command), (2.5, 0.0, 0))


class Frames(unittest.TestCase):
    def setUp(self):
        self.rng = random.Random(1)

    def test_round_trip_of_every_message(self):
        encoder, parser = codec.Encoder(7, 8), codec.Parser()
        for message in messages.BY_NUMBER.values():
            for _ in range(10):
                fields = random_fields(message, self.rng)
                received, = parser.feed(encoder.frame(message.name, fields))
                self.assertEqual(received.fields, fields)
                self.assertEqual((received.system, received.component), (7, 8))

    def test_nan_survives(self):
        frame = codec.Encoder(1, 1).frame("COMMAND_LONG", {"param4": math.nan})
        self.assertTrue(math.isnan(codec.Parser().feed(frame)[0].param4))

    def test_sequence_wraps(self):
        encoder, parser = codec.Encoder(1, 1), codec.Parser()
        sequences = [parser.feed(encoder.frame("PING", {}))[0].sequence for _ in range(300)]
        self.assertEqual(sequences, [i % 256 for i in range(300)])

    def test_bytes_in_any_portions_with_noise_between(self):
        encoder, parser = codec.Encoder(1, 1), codec.Parser()
        stream, received = b"", []
        for i in range(200):
            noise = bytes(self.rng.randrange(253) for _ in range(self.rng.randint(0, 9)))
            stream += noise + encoder.frame("PING", {"seq": i})
        while stream:
            size = self.rng.randint(1, 40)
            received += parser.feed(stream[:size])
            stream = stream[size:]
        self.assertEqual([message.seq for message in received], list(range(200)))

    def test_damaged_packets_are_not_received(self):
        """Of any one damaged byte; what follows is received."""
        encoder = codec.Encoder(1, 1)
        for at in range(len(encoder.frame("MISSION_COUNT", {"count": 515}))):
            parser = codec.Parser()
            frame = bytearray(encoder.frame("MISSION_COUNT", {"count": 515}))
            frame[at] ^= self.rng.randint(1, 255)
            received = parser.feed(bytes(frame)) + parser.end_datagram()
            self.assertEqual(received, [], f"byte {at}")
            self.assertEqual(len(parser.feed(encoder.frame("PING", {}))), 1)

    def test_unknown_incompatibility_flags(self):
        frame = bytearray(codec.Encoder(1, 1).frame("PING", {}))
        frame[2] = 2
        crc = checksum.crc16(frame[1:-2] + bytes([237]))
        frame[-2:] = crc.to_bytes(2, "little")
        self.assertEqual(codec.Parser().feed(bytes(frame)), [])


class Signatures(unittest.TestCase):
    def setUp(self):
        self.now = 1_700_000_000.0
        self.parser = codec.Parser(self.signer())

    def signer(self, key=KEY):
        return codec.Signer(key, clock=lambda: self.now)

    def test_layout(self):
        """13 bytes more, the flag set, timestamps of 10 us since 2015."""
        frame = codec.Encoder(1, 1, self.signer()).frame("PING", {"seq": 1})
        self.assertEqual(frame[2], 1)
        self.assertEqual(len(frame), 10 + frame[1] + 2 + 13)
        stamp = int.from_bytes(frame[-12:-6], "little")
        self.assertEqual(stamp, int((self.now - 1420070400) * 100000))

    def test_accepted_once(self):
        frame = codec.Encoder(1, 1, self.signer()).frame("PING", {})
        self.assertEqual(len(self.parser.feed(frame)), 1)
        self.assertEqual(len(self.parser.feed(frame)), 0)
        self.assertEqual(self.parser.counts["bad_signature"], 1)

    def test_refused(self):
        self.assertEqual(self.parser.feed(codec.Encoder(1, 1).frame("PING", {})), [])
        self.assertEqual(self.parser.counts["unsigned"], 1)
        other = codec.Encoder(1, 1, self.signer(KEY[::-1])).frame("PING", {})
        self.assertEqual(self.parser.feed(other), [])
        self.now -= 61
        late = codec.Encoder(1, 1, self.signer()).frame("PING", {})
        self.now += 61
        self.assertEqual(self.parser.feed(late), [])

    def test_timestamps_grow(self):
        encoder = codec.Encoder(1, 1, self.signer())
        received = [m for _ in range(20) for m in self.parser.feed(encoder.frame("PING", {}))]
        self.assertEqual(len(received), 20)


if __name__ == "__main__":
    unittest.main()
