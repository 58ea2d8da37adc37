# SPDX-License-Identifier: Apache-2.0
"""Where packets come from and go to: UDP, TCP, or a pseudo-terminal in place of a serial line. Each
has `name` to print, `files` to wait for, `receive` and `send`; a stream is cut into packets, so
that faults of packets are the same on each."""
import os
import pty
import socket
import tty

import codec

MOST = 65535


def nothing_there(read):
    """What `read` returns, or None if that would block or the other side has gone."""
    try:
        return read()
    except (BlockingIOError, ConnectionError, OSError):
        return None


class Cutter:
    """Packets of a stream by their lengths; what is between them is left out."""

    def __init__(self):
        self.parser = codec.Parser()

    def feed(self, data):
        parser = self.parser
        parser.buffer += data
        packets = []
        while True:
            start = parser.buffer.find(codec.MAGIC)
            parser.buffer = parser.buffer[start:] if start >= 0 else b""
            size = parser.frame_size()
            if size is None or len(parser.buffer) < size:
                return packets
            packets.append(parser.buffer[:size])
            parser.buffer = parser.buffer[size:]


class UdpIn:
    def __init__(self, address):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(address)
        self.socket.setblocking(False)
        self.name = self.socket.getsockname()[1]
        self.files = [self.socket]

    def receive(self):
        packets = []
        while (got := nothing_there(lambda: self.socket.recvfrom(MOST))) is not None:
            packets.append(got)
        return packets

    def send(self, packet, address):
        # Nobody may listen there any more, as on a radio.
        nothing_there(lambda: self.socket.sendto(packet, address))


class TcpIn:
    """Any number of connections, each an address."""

    def __init__(self, address):
        self.listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.listener.bind(address)
        self.listener.listen()
        self.listener.setblocking(False)
        self.name = self.listener.getsockname()[1]
        self.connections = {}  # address: (socket, Cutter)
        self.files = [self.listener]

    def receive(self):
        while (got := nothing_there(self.listener.accept)) is not None:
            got[0].setblocking(False)
            self.connections[got[1]] = got[0], Cutter()
            self.files.append(got[0])
        packets = []
        for address, (connection, cutter) in list(self.connections.items()):
            data = nothing_there(lambda c=connection: c.recv(MOST))
            if data == b"":
                self.close(address)
            elif data:
                packets += [(packet, address) for packet in cutter.feed(data)]
        return packets

    def close(self, address):
        connection, _ = self.connections.pop(address)
        self.files.remove(connection)
        connection.close()

    def send(self, packet, address):
        if address in self.connections:
            nothing_there(lambda: self.connections[address][0].sendall(packet))


class Pty:
    """`name` is the terminal that the other side opens."""

    def __init__(self):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.name = os.ttyname(self.slave)
        self.files = [self.master]
        self.cutter = Cutter()

    def receive(self):
        data = nothing_there(lambda: os.read(self.master, MOST))
        return [(packet, self.name) for packet in self.cutter.feed(data or b"")]

    def send(self, packet, address):
        nothing_there(lambda: os.write(self.master, packet))
