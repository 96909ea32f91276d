#!/usr/bin/env python3
"""Draws front.png and side.png: what the cameras of this example see behind the arm.

Usage: python3 draw_clutter.py (in this folder)
"""

import math
import random
import struct
import zlib

WIDTH, HEIGHT = 640, 480


def png(rows):
    """Returns the PNG file of rows of RGB bytes. Each row is stored as the difference from the one above."""
    above = bytes(3 * WIDTH)
    raw = bytearray()
    for row in rows:
        raw.append(2)
        raw += bytes((a - b) & 255 for a, b in zip(row, above))
        above = row

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b"")


def covered(distance):
    """Returns the share of a pixel inside a shape, with borders blurred over two pixels."""
    return min(max(0.5 - distance / 2, 0), 1)


def box(left, top, right, bottom):
    return lambda u, v: max(left - u, u - right, top - v, v - bottom)


def rod(a, b, width):
    """A straight cable or post from a to b."""
    way = (b[0] - a[0], b[1] - a[1])
    square = way[0] ** 2 + way[1] ** 2

    def distance(u, v):
        t = min(max(((u - a[0]) * way[0] + (v - a[1]) * way[1]) / square, 0), 1)
        return math.hypot(u - a[0] - t * way[0], v - a[1] - t * way[1]) - width / 2

    return distance


def hose(u0, v0, radius, width):
    """A ring, such as a coiled hose."""
    return lambda u, v: abs(math.hypot(u - u0, v - v0) - radius) - width / 2


def draw(name, seed):
    random.seed(seed)
    shapes = []
    # Boxes on shelves.
    for shelf in (120, 250, 385):
        left = random.uniform(-20, 10)
        while left < WIDTH:
            width, height = random.uniform(25, 90), random.uniform(40, 105)
            color = [random.uniform(60, 225) for _ in range(3)]
            shapes.append((box(left, shelf - height, left + width, shelf), color))
            left += width + random.uniform(0, 22)
        shapes.append((box(-1, shelf, WIDTH, shelf + 9), [95, 70, 50]))
    # Posts, cables and a hose, as dark and as wide as the arm.
    for _ in range(7):
        a = (random.uniform(0, WIDTH), random.uniform(0, HEIGHT))
        b = (a[0] + random.uniform(-200, 200), a[1] + random.uniform(-300, 300))
        shapes.append((rod(a, b, random.uniform(4, 13)), [random.uniform(25, 60)] * 3))
    shapes.append((rod((70, 0), (70, HEIGHT), 13), [45, 45, 47]))
    shapes.append((hose(random.uniform(480, 560), 330, 60, 12), [40, 40, 42]))
    # A chessboard on the wall.
    u0, v0 = random.uniform(400, 460), 20
    for i in range(7):
        for j in range(5):
            shapes.append((box(u0 + 18 * i, v0 + 18 * j, u0 + 18 * i + 17, v0 + 18 * j + 17), [230 if (i + j) % 2 else 30] * 3))
    picture = [[[150 + 40 * math.cos(u / 210) + 20 * math.sin(v / 90) + c * 6 for c in range(3)] for u in range(WIDTH)] for v in range(HEIGHT)]
    for distance, color in shapes:
        for v in range(HEIGHT):
            for u in range(WIDTH):
                share = covered(distance(u, v))
                if share > 0:
                    pixel = picture[v][u]
                    for c in range(3):
                        pixel[c] += share * (color[c] - pixel[c])
    # The light falls to the right.
    rows = [bytes(min(255, int((1.05 - 0.0005 * u) * value + 0.5)) for u, pixel in enumerate(row) for value in pixel) for row in picture]
    with open(name, "wb") as file:
        file.write(png(rows))


draw("front.png", 1)
draw("side.png", 2)
