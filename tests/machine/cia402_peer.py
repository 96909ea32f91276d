"""Peers of the CiA 402 driver and of the simulated drive, on python-can.

cia402_peer.py INTERFACE OTHER OWN

It first moves the drive OTHER by SDO and prints "passed". Then it is a drive itself, with the number OWN, and prints
"ready". It was written from CiA 301 and CiA 402-2 alone.
"""
import struct
import sys
import time

import can

NAME = b"A drive on python-can"
SWITCH_ON_DISABLED, READY, SWITCHED_ON, ENABLED, QUICK_STOP = 0x40, 0x21, 0x23, 0x27, 0x07


def open_bus(interface):
    return can.interface.Bus(channel=interface, interface="socketcan")


def send(bus, identifier, data):
    bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))


class Drive:
    """One axis in profile position mode. It moves with its profile velocity and without a ramp."""

    def __init__(self, bus, node):
        self.bus, self.node = bus, node
        self.objects = {}  # (index, sub): number
        for key, number in {(0x1000, 0): 0x00040192, (0x1018, 1): 0x1234, (0x1018, 2): 0x5678, (0x1400, 1): 0x200 + node,
                            (0x1401, 1): 0x300 + node, (0x1800, 1): 0x180 + node, (0x6060, 0): 0, (0x607A, 0): 0,
                            (0x6081, 0): 1000, (0x6040, 0): 0, (0x1017, 0): 0}.items():
            self.objects[key] = number
        self.state, self.is_operational, self.word = SWITCH_ON_DISABLED, False, 0
        self.start, self.since, self.goal = 0.0, time.monotonic(), 0.0
        self.is_acknowledged, self.waiting, self.rest, self.toggle = False, [], None, 0
        self.next_heartbeat = None
        send(bus, 0x700 + node, [0])

    def position(self):
        way = self.goal - self.start
        done = self.objects[0x6081, 0] * (time.monotonic() - self.since)
        return self.goal if done >= abs(way) else self.start + (done if way > 0 else -done)

    def stand(self):
        self.start = self.goal = self.position()

    def statusword(self):
        word = self.state | 0x0210  # Remote, voltage.
        if self.state == ENABLED and self.position() == self.goal:
            word |= 0x0400
        return word | (0x1000 if self.is_acknowledged else 0)

    def get(self, key):
        live = {(0x6041, 0): self.statusword, (0x6061, 0): lambda: self.objects[0x6060, 0],
                (0x6064, 0): lambda: round(self.position()), (0x1001, 0): lambda: 0, (0x603F, 0): lambda: 0}
        return live[key]() if key in live else self.objects.get(key)

    def put(self, key, number):
        self.objects[key] = number
        if key == (0x1017, 0):
            self.next_heartbeat = time.monotonic() if number else None
        if key == (0x6040, 0):
            self.control(number)

    def control(self, word):
        edges, self.word = word & ~self.word, word
        if word & 0x82 == 0:
            self.state = SWITCH_ON_DISABLED
        elif word & 0x86 == 0x02:
            if self.state == ENABLED:
                self.stand()
                self.state = QUICK_STOP
        elif word & 0x87 == 0x06 and self.state != QUICK_STOP:
            self.state = READY
        elif word & 0x8F == 0x07 and self.state in (READY, ENABLED):
            self.state = SWITCHED_ON
        elif word & 0x8F == 0x0F and self.state in (SWITCHED_ON, QUICK_STOP):
            self.state = ENABLED
        if self.state != ENABLED:
            self.stand()
        elif edges & 0x10 and self.objects[0x6060, 0] == 1:
            self.start, self.since = self.position(), time.monotonic()
            self.goal = float(struct.unpack("<i", struct.pack("<I", self.objects[0x607A, 0] & 0xFFFFFFFF))[0])
            self.is_acknowledged = True
        if not word & 0x10:
            self.is_acknowledged = False

    def mapped(self, mapping):
        for sub in range(1, self.objects.get((mapping, 0), 0) + 1):
            entry = self.objects[mapping, sub]
            yield (entry >> 16, entry >> 8 & 0xFF), (entry & 0xFF) // 8

    def sync(self):
        for mapping, data in self.waiting:
            for key, size in self.mapped(mapping):
                self.objects[key] = int.from_bytes(data[:size], "little")
                data = data[size:]
        if self.waiting:
            self.control(self.objects[0x6040, 0])
        self.waiting = []
        data = b"".join((self.get(key) & (1 << 8 * size) - 1).to_bytes(size, "little")
                        for key, size in self.mapped(0x1A00))
        if self.is_operational and not self.objects[0x1800, 1] >> 31:
            send(self.bus, 0x180 + self.node, data)

    def serve(self, request):
        """Answers a request of SDO."""
        command, index, sub = struct.unpack("<BHB", request[:4])
        kind, head = command >> 5, request[1:4]
        answer = None
        if kind == 2 and (index, sub) == (0x1008, 0):
            self.rest, self.toggle = NAME, 0
            answer = b"\x41" + head + struct.pack("<I", len(NAME))
        elif kind == 2 and self.get((index, sub)) is not None:
            answer = b"\x43" + head + struct.pack("<I", self.get((index, sub)) & 0xFFFFFFFF)
        elif kind == 1 and command & 2:
            size = 4 - (command >> 2 & 3)
            self.put((index, sub), int.from_bytes(request[4:4 + size], "little"))
            answer = b"\x60" + head + bytes(4)
        elif kind == 3 and self.rest is not None and command & 0x10 == self.toggle:
            part, self.rest = self.rest[:7], self.rest[7:]
            answer = bytes([self.toggle | 7 - len(part) << 1 | (0 if self.rest else 1)]) + part.ljust(7, b"\0")
            self.toggle ^= 0x10
        elif kind == 4:
            return
        send(self.bus, 0x580 + self.node, answer or b"\x80" + head + struct.pack("<I", 0x06020000))

    def take(self, message):
        if message.is_extended_id or message.is_remote_frame or message.is_error_frame:
            return
        identifier, data = message.arbitration_id, bytes(message.data)
        if identifier == 0 and data[1] in (0, self.node):
            self.is_operational = data[0] == 0x01
        elif identifier == 0x80:
            self.sync()
        elif identifier == 0x600 + self.node and len(data) == 8:
            self.serve(data)
        for parameters in (0x1400, 0x1401):
            if self.is_operational and identifier == self.objects[parameters, 1]:
                self.waiting.append((parameters + 0x200, data))

    def run(self):
        print("ready", flush=True)
        while True:
            message = self.bus.recv(0.02)
            if message:
                self.take(message)
            if self.next_heartbeat and time.monotonic() >= self.next_heartbeat:
                self.next_heartbeat += self.objects[0x1017, 0] / 1000
                send(self.bus, 0x700 + self.node, [0x05 if self.is_operational else 0x7F])


class Client:
    """Reads and writes objects of a drive."""

    def __init__(self, bus, node):
        self.bus, self.node = bus, node

    def answer(self, identifier):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            message = self.bus.recv(1)
            if message and message.arbitration_id == identifier and not message.is_extended_id:
                return bytes(message.data)
        raise AssertionError(f"no frame {identifier:03X} for 60 s")

    def ask(self, data):
        send(self.bus, 0x600 + self.node, data)
        return self.answer(0x580 + self.node)

    def read(self, index, sub=0):
        head = struct.pack("<HB", index, sub)
        answer = self.ask(b"\x40" + head + bytes(4))
        assert answer[1:4] == head, answer
        if answer[0] == 0x80:
            return "abort", struct.unpack("<I", answer[4:])[0]
        if answer[0] & 2:  # Expedited.
            return int.from_bytes(answer[4:8 - (answer[0] >> 2 & 3)], "little")
        data, toggle = b"", 0
        while True:
            part = self.ask(bytes([0x60 | toggle]) + bytes(7))
            assert part[0] & 0xF0 == toggle, part
            data += part[1:8 - (part[0] >> 1 & 7)]
            toggle ^= 0x10
            if part[0] & 1:
                assert len(data) == struct.unpack("<I", answer[4:])[0], data
                return data

    def write(self, index, sub, number, size):
        head = struct.pack("<HB", index, sub)
        answer = self.ask(bytes([0x23 | 4 - size << 2]) + head + (number & 0xFFFFFFFF).to_bytes(4, "little"))
        assert answer[1:4] == head, answer
        return struct.unpack("<I", answer[4:])[0] if answer[0] == 0x80 else 0

    def wait(self, mask, bits):
        end = time.monotonic() + 60
        while self.read(0x6041) & mask != bits:
            assert time.monotonic() < end, f"statusword {self.read(0x6041):04X}"

    def run(self):
        assert self.read(0x1000) & 0xFFFF == 402
        assert self.read(0x1008) == b"Flexura simulated stepper"
        assert self.read(0x5555) == ("abort", 0x06020000)
        assert self.read(0x1018, 9) == ("abort", 0x06090011)
        assert self.write(0x1000, 0, 1, 4) == 0x06010002
        assert self.write(0x1017, 0, 1, 4) == 0x06070010
        # A heartbeat every 50 ms, whose state follows the network's commands.
        assert self.write(0x1017, 0, 50, 2) == 0
        assert self.answer(0x700 + self.node) == b"\x7f"
        send(self.bus, 0, [0x01, self.node])
        while self.answer(0x700 + self.node) != b"\x05":
            pass
        # A move in profile position mode.
        assert self.write(0x6060, 0, 1, 1) == 0
        for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            assert self.write(0x6040, 0, word, 2) == 0
            self.wait(0x6F, state)
        assert self.write(0x607A, 0, -1500, 4) == 0
        assert self.write(0x6081, 0, 3000, 4) == 0
        assert self.write(0x6040, 0, 0x1F, 2) == 0
        self.wait(0x1000, 0x1000)
        assert self.write(0x6040, 0, 0x0F, 2) == 0
        self.wait(0x1400, 0x0400)
        assert self.read(0x6064) == 2**32 - 1500
        # The statusword and the position as a PDO, on SYNC.
        send(self.bus, 0, [0x80, self.node])
        for index, sub, number, size in ((0x1800, 1, 0x80000180 + self.node, 4), (0x1800, 2, 1, 1), (0x1A00, 0, 0, 1),
                                         (0x1A00, 1, 0x60410010, 4), (0x1A00, 2, 0x60640020, 4), (0x1A00, 0, 2, 1),
                                         (0x1800, 1, 0x180 + self.node, 4)):
            assert self.write(index, sub, number, size) == 0, hex(index)
        send(self.bus, 0, [0x01, self.node])
        send(self.bus, 0x80, [])
        word, position = struct.unpack("<Hi", self.answer(0x180 + self.node))
        assert word & 0x6F == 0x27 and position == -1500, (word, position)
        # Bad requests: a segment that nobody has asked for, and a wrong toggle bit.
        assert self.ask(b"\x60" + bytes(7))[0] == 0x80
        self.ask(b"\x40\x08\x10\x00" + bytes(4))
        answer = self.ask(b"\x70" + bytes(7))
        assert answer[0] == 0x80 and struct.unpack("<I", answer[4:])[0] == 0x05030000, answer
        print("passed", flush=True)


def main():
    bus = open_bus(sys.argv[1])
    Client(bus, int(sys.argv[2])).run()
    Drive(bus, int(sys.argv[3])).run()


main()
