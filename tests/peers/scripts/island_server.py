"""An io island by pymodbus. Its outputs have to become coils 0 to 7 at a5h and holding register 0 at 2500; what it does then says
the second argument: `answer` switches discrete input 8 on, `wait` nothing, `silent` answers no more, `garbage` answers
nonsense. Arguments: PORT (0: any that is free) MANNER. Says its port first."""

import asyncio
import sys

from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

port, manner = int(sys.argv[1]), sys.argv[2]
WANTED = {15: [True, False, True, False, False, True, False, True], 16: [2500]}
written = {}


def bits(values):
    return [SimData(0, values=values, datatype=DataType.BITS)]


def registers(values):
    return [SimData(0, values=values, datatype=DataType.REGISTERS)]


async def action(function_code, _start_address, _address, _count, current_registers, set_values):
    if function_code in WANTED:
        written.setdefault(function_code, []).append(set_values)
    if function_code == 2 and done() and manner == "answer":
        current_registers[0] |= 1 << 8


def done():
    return all(values in written.get(function, []) for function, values in WANTED.items())


def packet(sending, data):
    if sending and done() and manner == "silent":
        return b""
    if sending and done() and manner == "garbage":
        return bytes(255 - byte for byte in data)
    return data


async def main():
    inputs = [True, True, True, False, False, False, False, True, False, False]
    device = SimDevice(
        0,
        simdata=(bits([False] * 8), bits(inputs), registers([0] * 4), registers([65536 - 250, 750])),
        action=action,
    )
    server = ModbusTcpServer(device, address=("127.0.0.1", port), trace_packet=packet)
    await server.serve_forever(background=True)
    print(server.transport.sockets[0].getsockname()[1], flush=True)
    await asyncio.Event().wait()


asyncio.run(main())
