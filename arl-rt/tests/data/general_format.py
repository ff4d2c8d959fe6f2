"""Writes general_format.txt: doubles as C's %g prints them. Each line: bits in hexadecimal, precision, text."""

import random
import struct
import sys

random.seed(20260714)


def bits(value):
    return struct.unpack("<Q", struct.pack("<d", value))[0]


def double(pattern):
    return struct.unpack("<d", struct.pack("<Q", pattern))[0]


def values():
    # All exponents, at random.
    for _ in range(900):
        yield double(random.getrandbits(64))
    # What robots print: millimetres, degrees, seconds.
    for _ in range(900):
        yield round(random.uniform(-3000, 3000), random.randint(0, 6))
    # Near powers of ten, where rounding adds a digit and the form changes.
    for exponent in range(-8, 25):
        for factor in (1, 0.9999995, 0.99999949, 0.99999951, 9.9999949, 9.9999951, 1.0000005):
            yield factor * 10.0**exponent
    # Ties: halves of the last digit that is kept.
    for _ in range(600):
        digits = random.randint(1, 8)
        yield (random.randint(10 ** (digits - 1), 10**digits) + 0.5) * 2.0 ** random.randint(-3, 3)
    # Subnormals and whole numbers.
    for _ in range(150):
        yield double(random.getrandbits(random.randint(1, 52)))
        yield float(random.getrandbits(random.randint(1, 63)))


with open(sys.argv[1], "w", encoding="ascii") as out:
    for value in values():
        if value != value or value in (float("inf"), float("-inf")):
            continue
        for precision in (6, random.choice((1, 2, 3, 4, 8, 12, 15, 16, 17, 21, 40))):
            out.write(f"{bits(value):016x} {precision} {value:.{precision}g}\n")
