# SPDX-License-Identifier: Apache-2.0
"""The messages that the vehicle knows, each declared once as the MAVLink 2 specification declares
it (minimal.xml, common.xml; WIND of ardupilotmega.xml). Layout and CRC_EXTRA follow from the
fields."""
import struct

import checksum

# Wire type: (struct code, bytes). The magic type of HEARTBEAT is a plain byte on the wire.
TYPES = {"uint64_t": ("Q", 8), "int64_t": ("q", 8), "double": ("d", 8), "uint32_t": ("I", 4),
         "int32_t": ("i", 4), "float": ("f", 4), "uint16_t": ("H", 2), "int16_t": ("h", 2),
         "uint8_t": ("B", 1), "int8_t": ("b", 1), "char": ("c", 1)}

TO = "uint8_t target_system; uint8_t target_component; "
PARAMS = "float param1; float param2; float param3; float param4; "
TYPE = "| uint8_t mission_type"
AIM = ("float vx; float vy; float vz; float afx; float afy; float afz; float yaw; float yaw_rate")

# id, name, fields in the order of the XML; '|' begins the extensions.
DECLARED = [
    (0, "HEARTBEAT", "uint8_t type; uint8_t autopilot; uint8_t base_mode; uint32_t custom_mode; "
     "uint8_t system_status; uint8_t mavlink_version"),
    (1, "SYS_STATUS", "uint32_t onboard_control_sensors_present; "
     "uint32_t onboard_control_sensors_enabled; uint32_t onboard_control_sensors_health; "
     "uint16_t load; uint16_t voltage_battery; int16_t current_battery; int8_t battery_remaining; "
     "uint16_t drop_rate_comm; uint16_t errors_comm; uint16_t errors_count1; "
     "uint16_t errors_count2; uint16_t errors_count3; uint16_t errors_count4; "
     "| uint32_t onboard_control_sensors_present_extended; "
     "uint32_t onboard_control_sensors_enabled_extended; "
     "uint32_t onboard_control_sensors_health_extended"),
    (2, "SYSTEM_TIME", "uint64_t time_unix_usec; uint32_t time_boot_ms"),
    (4, "PING", "uint64_t time_usec; uint32_t seq; " + TO),
    (11, "SET_MODE", "uint8_t target_system; uint8_t base_mode; uint32_t custom_mode"),
    (20, "PARAM_REQUEST_READ", TO + "char[16] param_id; int16_t param_index"),
    (21, "PARAM_REQUEST_LIST", TO),
    (22, "PARAM_VALUE", "char[16] param_id; float param_value; uint8_t param_type; "
     "uint16_t param_count; uint16_t param_index"),
    (23, "PARAM_SET", TO + "char[16] param_id; float param_value; uint8_t param_type"),
    (24, "GPS_RAW_INT", "uint64_t time_usec; uint8_t fix_type; int32_t lat; int32_t lon; "
     "int32_t alt; uint16_t eph; uint16_t epv; uint16_t vel; uint16_t cog; "
     "uint8_t satellites_visible; | int32_t alt_ellipsoid; uint32_t h_acc; uint32_t v_acc; "
     "uint32_t vel_acc; uint32_t hdg_acc; uint16_t yaw"),
    (30, "ATTITUDE", "uint32_t time_boot_ms; float roll; float pitch; float yaw; float rollspeed; "
     "float pitchspeed; float yawspeed"),
    (32, "LOCAL_POSITION_NED", "uint32_t time_boot_ms; float x; float y; float z; float vx; "
     "float vy; float vz"),
    (33, "GLOBAL_POSITION_INT", "uint32_t time_boot_ms; int32_t lat; int32_t lon; int32_t alt; "
     "int32_t relative_alt; int16_t vx; int16_t vy; int16_t vz; uint16_t hdg"),
    (37, "MISSION_REQUEST_PARTIAL_LIST", TO + "int16_t start_index; int16_t end_index; " + TYPE),
    (38, "MISSION_WRITE_PARTIAL_LIST", TO + "int16_t start_index; int16_t end_index; " + TYPE),
    (39, "MISSION_ITEM", TO + "uint16_t seq; uint8_t frame; uint16_t command; uint8_t current; "
     "uint8_t autocontinue; " + PARAMS + "float x; float y; float z; " + TYPE),
    (40, "MISSION_REQUEST", TO + "uint16_t seq; " + TYPE),
    (41, "MISSION_SET_CURRENT", TO + "uint16_t seq"),
    (42, "MISSION_CURRENT", "uint16_t seq; | uint16_t total; uint8_t mission_state; "
     "uint8_t mission_mode; uint32_t mission_id; uint32_t fence_id; uint32_t rally_points_id"),
    (43, "MISSION_REQUEST_LIST", TO + TYPE),
    (44, "MISSION_COUNT", TO + "uint16_t count; " + TYPE + "; uint32_t opaque_id"),
    (45, "MISSION_CLEAR_ALL", TO + TYPE),
    (46, "MISSION_ITEM_REACHED", "uint16_t seq"),
    (47, "MISSION_ACK", TO + "uint8_t type; " + TYPE + "; uint32_t opaque_id"),
    (49, "GPS_GLOBAL_ORIGIN", "int32_t latitude; int32_t longitude; int32_t altitude; "
     "| uint64_t time_usec"),
    (51, "MISSION_REQUEST_INT", TO + "uint16_t seq; " + TYPE),
    (62, "NAV_CONTROLLER_OUTPUT", "float nav_roll; float nav_pitch; int16_t nav_bearing; "
     "int16_t target_bearing; uint16_t wp_dist; float alt_error; float aspd_error; "
     "float xtrack_error"),
    (66, "REQUEST_DATA_STREAM", TO + "uint8_t req_stream_id; uint16_t req_message_rate; "
     "uint8_t start_stop"),
    (73, "MISSION_ITEM_INT", TO + "uint16_t seq; uint8_t frame; uint16_t command; "
     "uint8_t current; uint8_t autocontinue; " + PARAMS + "int32_t x; int32_t y; float z; " + TYPE),
    (74, "VFR_HUD", "float airspeed; float groundspeed; int16_t heading; uint16_t throttle; "
     "float alt; float climb"),
    (75, "COMMAND_INT", TO + "uint8_t frame; uint16_t command; uint8_t current; "
     "uint8_t autocontinue; " + PARAMS + "int32_t x; int32_t y; float z"),
    (76, "COMMAND_LONG", TO + "uint16_t command; uint8_t confirmation; " + PARAMS +
     "float param5; float param6; float param7"),
    (77, "COMMAND_ACK", "uint16_t command; uint8_t result; | uint8_t progress; "
     "int32_t result_param2; " + TO),
    (84, "SET_POSITION_TARGET_LOCAL_NED", "uint32_t time_boot_ms; " + TO +
     "uint8_t coordinate_frame; uint16_t type_mask; float x; float y; float z; " + AIM),
    (85, "POSITION_TARGET_LOCAL_NED", "uint32_t time_boot_ms; "
     "uint8_t coordinate_frame; uint16_t type_mask; float x; float y; float z; " + AIM),
    (86, "SET_POSITION_TARGET_GLOBAL_INT", "uint32_t time_boot_ms; " + TO +
     "uint8_t coordinate_frame; uint16_t type_mask; int32_t lat_int; int32_t lon_int; float alt; "
     + AIM),
    (87, "POSITION_TARGET_GLOBAL_INT", "uint32_t time_boot_ms; uint8_t coordinate_frame; "
     "uint16_t type_mask; int32_t lat_int; int32_t lon_int; float alt; " + AIM),
    (109, "RADIO_STATUS", "uint8_t rssi; uint8_t remrssi; uint8_t txbuf; uint8_t noise; "
     "uint8_t remnoise; uint16_t rxerrors; uint16_t fixed"),
    (111, "TIMESYNC", "int64_t tc1; int64_t ts1; | " + TO),
    (133, "TERRAIN_REQUEST", "int32_t lat; int32_t lon; uint16_t grid_spacing; uint64_t mask"),
    (134, "TERRAIN_DATA", "int32_t lat; int32_t lon; uint16_t grid_spacing; uint8_t gridbit; "
     "int16_t[16] data"),
    (135, "TERRAIN_CHECK", "int32_t lat; int32_t lon"),
    (136, "TERRAIN_REPORT", "int32_t lat; int32_t lon; uint16_t spacing; float terrain_height; "
     "float current_height; uint16_t pending; uint16_t loaded"),
    (148, "AUTOPILOT_VERSION", "uint64_t capabilities; uint32_t flight_sw_version; "
     "uint32_t middleware_sw_version; uint32_t os_sw_version; uint32_t board_version; "
     "uint8_t[8] flight_custom_version; uint8_t[8] middleware_custom_version; "
     "uint8_t[8] os_custom_version; uint16_t vendor_id; uint16_t product_id; uint64_t uid; "
     "| uint8_t[18] uid2"),
    (168, "WIND", "float direction; float speed; float speed_z"),
    (231, "WIND_COV", "uint64_t time_usec; float wind_x; float wind_y; float wind_z; "
     "float var_horiz; float var_vert; float wind_alt; float horiz_accuracy; float vert_accuracy"),
    (242, "HOME_POSITION", "int32_t latitude; int32_t longitude; int32_t altitude; float x; "
     "float y; float z; float[4] q; float approach_x; float approach_y; float approach_z; "
     "| uint64_t time_usec"),
    (244, "MESSAGE_INTERVAL", "uint16_t message_id; int32_t interval_us"),
    (245, "EXTENDED_SYS_STATE", "uint8_t vtol_state; uint8_t landed_state"),
    (253, "STATUSTEXT", "uint8_t severity; char[50] text; | uint16_t id; uint8_t chunk_seq"),
    (300, "PROTOCOL_VERSION", "uint16_t version; uint16_t min_version; uint16_t max_version; "
     "uint8_t[8] spec_version_hash; uint8_t[8] library_version_hash"),
]


class Field:
    def __init__(self, declared):
        kind, self.name = declared.split()
        self.type, _, length = kind.partition("[")
        self.length = int(length.rstrip("]")) if length else 0
        self.code, self.size = TYPES[self.type]
        if self.type == "char":
            self.format = f"{self.length}s"
        else:
            self.format = f"{self.length or ''}{self.code}"


def parse_fields(text):
    return [Field(part.strip()) for part in text.split(";") if part.strip()]


class Message:
    """One row of the table: its layout on the wire, and values to bytes and back."""

    def __init__(self, number, name, declared):
        base, _, extensions = declared.partition("|")
        self.number, self.name = number, name
        # Larger types first, equal ones as declared; extensions follow as declared.
        self.base = sorted(parse_fields(base), key=lambda field: -field.size)
        self.fields = self.base + parse_fields(extensions)
        self.layout = struct.Struct("<" + "".join(field.format for field in self.fields))
        self.crc_extra = self.checksum_of_fields()

    def checksum_of_fields(self):
        crc = checksum.crc16((self.name + " ").encode())
        for field in self.base:
            crc = checksum.crc16(f"{field.type} {field.name} ".encode(), crc)
            if field.length:
                crc = checksum.crc16(bytes([field.length]), crc)
        return (crc & 0xFF) ^ (crc >> 8)

    def encode(self, values):
        """Payload of a dict of fields, those left out being zero, trailing zeros removed."""
        unknown = set(values) - {field.name for field in self.fields}
        if unknown:
            raise ValueError(f"{self.name} has no field {sorted(unknown)}")
        flat = []
        for field in self.fields:
            value = values.get(field.name)
            if field.type == "char":
                flat.append((value or "").encode()[:field.length])
            elif field.length:
                flat.extend(value or [0] * field.length)
            else:
                flat.append(value or 0)
        payload = self.layout.pack(*flat)
        return payload.rstrip(b"\0") or payload[:1]

    def decode(self, payload):
        """Fields of a payload: truncated zeros are restored, bytes of later extensions ignored."""
        size = self.layout.size
        flat = list(self.layout.unpack(payload[:size].ljust(size, b"\0")))
        values = {}
        for field in self.fields:
            if field.type == "char":
                values[field.name] = flat.pop(0).split(b"\0")[0].decode("ascii", "replace")
            elif field.length:
                values[field.name], flat = flat[:field.length], flat[field.length:]
            else:
                values[field.name] = flat.pop(0)
        return values


BY_NUMBER = {row[0]: Message(*row) for row in DECLARED}
BY_NAME = {message.name: message for message in BY_NUMBER.values()}
