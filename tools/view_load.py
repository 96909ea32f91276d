#!/usr/bin/env python3
"""Measures the CPU time of `flexura view` while one client watches it as the page does.

    tools/view_load.py build/release/bin/flexura [EXPERIMENT.toml | RESULTS] [--seconds 10]
"""
import argparse
import base64
import json
import math
import os
import signal
import socket
import struct
import subprocess
import time


class Page:
    """A client of docs/viewer-protocol.md: counts states and images, and acknowledges images."""

    def __init__(self, url):
        address, token = url.split("/#token=")
        host = address.split("//")[1]
        name, port = host.rsplit(":", 1)
        self.socket = socket.create_connection((name, int(port)))
        self.buffer = b""
        self.states = self.images = self.asked = 0
        self.hello = None
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /socket HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\nAuthorization: Bearer {token}\r\n\r\n".encode())
        while b"\r\n\r\n" not in self.buffer:
            self.buffer += self.socket.recv(65536)
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise RuntimeError(head.decode())
        while self.hello is None:
            self.take()

    def need(self, count):
        while len(self.buffer) < count:
            data = self.socket.recv(65536)
            if not data:
                raise EOFError("the program has closed")
            self.buffer += data

    def send(self, kind, data):
        mask = os.urandom(4)
        head = bytes([0x80 | kind])
        head += bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xfe]) + struct.pack(">H", len(data))
        self.socket.sendall(head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def ask(self, **request):
        self.asked += 1
        self.send(1, json.dumps({"id": self.asked, **request}).encode())

    def take(self):
        self.need(2)
        kind, size, start = self.buffer[0] & 15, self.buffer[1] & 127, 2
        if size == 126:
            self.need(4)
            size, start = struct.unpack(">H", self.buffer[2:4])[0], 4
        elif size == 127:
            self.need(10)
            size, start = struct.unpack(">Q", self.buffer[2:10])[0], 10
        self.need(start + size)
        data, self.buffer = self.buffer[start:start + size], self.buffer[start + size:]
        if kind == 9:
            self.send(10, data)
        elif kind == 1:
            message = json.loads(data)
            if message["type"] == "hello":
                self.hello = message
        elif kind == 2 and data[0] == 1:
            self.states += 1
        elif kind == 2:
            self.images += 1
            camera = self.hello["scene"]["cameras"][data[1]]["name"]
            self.ask(do="ack", camera=camera, number=struct.unpack("<I", data[4:8])[0])


def cpu_seconds(process):
    with open(f"/proc/{process}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(what, page, process, seconds, moves):
    sections = len(page.hello["scene"]["arm"]["sections"])
    cpu, start, states, images, moved = cpu_seconds(process), time.monotonic(), page.states, page.images, 0
    while (now := time.monotonic() - start) < seconds:
        if moves and now > moved:
            moved = now + 1 / 30
            page.ask(do="arm", bends=[[0.2 * math.sin(2 * now), 0]] * sections, duration=0.05)
        page.take()
    took = time.monotonic() - start
    print(f"{what:32} {100 * (cpu_seconds(process) - cpu) / took:6.1f} % of a core, "
          f"{(page.states - states) / took:5.1f} states/s, {(page.images - images) / took:5.1f} images/s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("what", nargs="?")
    parser.add_argument("--seconds", type=float, default=10)
    arguments = parser.parse_args()
    command = [arguments.program, "view", "--no-browser", "--port", "0"] + ([arguments.what] if arguments.what else [])
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as program:
        try:
            page = Page(program.stdout.readline().split()[1])
            cases = [("states, arm still", False), ("states, arm moving", True)]
            for name, moves in cases:
                measure(name, page, program.pid, arguments.seconds, moves)
            for camera in page.hello["scene"]["cameras"][:2]:
                page.ask(do="images", camera=camera["name"], rate=30)
            for name, moves in cases:
                measure("two images and " + name, page, program.pid, arguments.seconds, moves)
        finally:
            program.send_signal(signal.SIGTERM)
    if program.returncode != 0:
        raise SystemExit(f"the program ended with the status {program.returncode}")


if __name__ == "__main__":
    main()
