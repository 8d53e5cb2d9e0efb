"""Motive and QTM as far as a client sees them, on the loopback address."""

import socket
import threading
from contextlib import closing, contextmanager

import numpy as np
from tracking_packets import (
    MEASURED,
    motive_frame,
    motive_names,
    motive_packet,
    motive_server,
    qtm_frame,
    qtm_names,
    qtm_packet,
    text,
)

HOST, GROUP = "127.0.0.1", "239.255.42.99"
EVERY = 0.01  # s, a frame


class Motive:
    """Answers what it is asked, and sends frames to whom asked for them.

    Args:
        version: Of NatNet.
        names: Of the markers in the set "arm".
        points: Where they are.
        millimetres: What it says that its unit is; None if it does not know the question.
    """

    def __init__(self, version, names, points, *, group=None, millimetres=1000.0):
        self.version, self.names, self.points = version, names, points
        self.group, self.millimetres = group, millimetres
        self.data_port = 0

    def answer(self, message, content):
        if message == 0:
            return motive_packet(1, motive_server(self.version, self.group, self.data_port))
        if message == 4:
            return motive_packet(5, motive_names(self.version, {"arm": self.names}))
        if message == 2 and content == text("UnitsToMillimeters") and self.millimetres is not None:
            return motive_packet(3, np.float32(self.millimetres).tobytes())
        return None

    def frame(self):
        points = [tuple(point) for point in np.asarray(self.points).tolist()]
        labelled = [(4 << 16 | k, point, MEASURED) for k, point in enumerate(points, 1)]
        return motive_packet(7, motive_frame(self.version, {"arm": points}, labelled))

    def serve(self, listening, ended):
        clients = set()
        while not ended.is_set():
            try:
                data, sender = listening.recvfrom(65536)
                clients.add(sender)
                if answered := self.answer(int.from_bytes(data[:2], "little"), data[4:]):
                    listening.sendto(answered, sender)
            except TimeoutError:
                for client in [(self.group, self.data_port)] if self.group and clients else clients:
                    listening.sendto(self.frame(), client)


class Qtm:
    """Answers one client after another.

    Args:
        names: Of the markers.
        points: Where they are, m; not a number where one is not seen.
        refusal: What it says to a version, if it refuses it.
    """

    def __init__(self, names, points, refusal=None):
        self.names, self.points, self.refusal = names, points, refusal

    def answer(self, command):
        word = command.split()[0].lower()
        if word == "version":
            refused = qtm_packet(0, text(self.refusal or ""))
            return refused if self.refusal else qtm_packet(1, text(f"Version set to {command.split()[1]}"))
        return qtm_packet(2, qtm_names(self.names)) if word == "getparameters" else b""

    def serve(self, listening, ended):
        while not ended.is_set():
            try:
                client = listening.accept()[0]
            except TimeoutError:
                continue
            with closing(client):
                client.settimeout(EVERY)
                client.sendall(qtm_packet(1, text("QTM RT Interface connected")))
                try:
                    self.talk(client, ended)
                except OSError:
                    continue  # it has gone

    def talk(self, client, ended):
        streaming, data = False, b""
        while not ended.is_set():
            try:
                more = client.recv(65536)
            except TimeoutError:
                if streaming:
                    points = [None if np.isnan(p).any() else 1e3 * p for p in np.asarray(self.points)]
                    client.sendall(qtm_packet(3, qtm_frame(points)))
                continue
            if not more:
                return
            data += more
            while len(data) >= 8 and len(data) >= (size := int.from_bytes(data[:4], "little")):
                command, data = data[8:size].rstrip(b"\0").decode(), data[size:]
                streaming = streaming or command.lower().startswith("streamframes")
                client.sendall(self.answer(command))


@contextmanager
def running(server, port=0):
    """Run a server, and yield its port."""
    kind = socket.SOCK_STREAM if isinstance(server, Qtm) else socket.SOCK_DGRAM
    with socket.socket(socket.AF_INET, kind) as listening:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((HOST, port))
        listening.settimeout(EVERY)
        if isinstance(server, Qtm):
            listening.listen()
        if isinstance(server, Motive) and server.group:
            listening.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(HOST))
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
                free.bind(("", 0))
                server.data_port = free.getsockname()[1]
        ended = threading.Event()
        working = threading.Thread(target=server.serve, args=(listening, ended))
        working.start()
        try:
            yield listening.getsockname()[1]
        finally:
            ended.set()
            working.join(20.0)
