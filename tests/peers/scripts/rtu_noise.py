"""A bad line with other slaves: what a Modbus RTU slave of station 17 hears there, and what it answers. Argument: DEVICE."""

import sys
import time

import serial

line = serial.Serial(sys.argv[1], baudrate=19200)


def frame(*body):
    checksum = 0xFFFF
    for byte in body:
        checksum ^= byte
        for _ in range(8):
            checksum = checksum >> 1 ^ (0xA001 if checksum & 1 else 0)
    return bytes(body) + checksum.to_bytes(2, "little")


def answer(request, wait):
    line.reset_input_buffer()
    line.write(request)
    line.timeout = wait
    return line.read(7)


READ = frame(17, 3, 0, 0, 0, 1)
assert answer(READ, 5) == frame(17, 3, 2, 0, 0)
# Another station, a damaged request, an unfinished one, noise: silence, and nothing of it is left.
damaged = READ[:-1] + bytes([READ[-1] ^ 1])
for request in [frame(18, 6, 0, 0, 0, 5), damaged, READ[:5], bytes(range(256))]:
    assert answer(request, 0.3) == b"", request
    assert answer(READ, 5) == frame(17, 3, 2, 0, 0), request
# Every slave writes, nobody answers.
assert answer(frame(0, 6, 0, 0, 0, 9), 0.3) == b""
assert answer(READ, 5) == frame(17, 3, 2, 0, 9)
# What another slave answers is the start of a longer request, too. The pause behind it may get lost on a busy computer: a
# master asks again.
for _ in range(20):
    line.write(frame(5, 16, 0, 0, 0, 2))
    line.flush()
    time.sleep(0.01)
    if answer(READ, 0.3) == frame(17, 3, 2, 0, 9):
        break
else:
    sys.exit("no answer behind the answer of another slave")
