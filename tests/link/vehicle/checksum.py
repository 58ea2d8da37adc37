# SPDX-License-Identifier: Apache-2.0
"""CRC-16/MCRF4XX, the checksum of MAVLink: polynomial 0x1021 reflected, begins with 0xFFFF."""


def table_entry(byte):
    for _ in range(8):
        byte = (byte >> 1) ^ 0x8408 if byte & 1 else byte >> 1
    return byte


TABLE = [table_entry(byte) for byte in range(256)]


def crc16(data, crc=0xFFFF):
    for byte in data:
        crc = (crc >> 8) ^ TABLE[(crc ^ byte) & 0xFF]
    return crc
