"""A Modbus master: reads what the program has written, writes what it waits for. Arguments: tcp PORT, or rtu DEVICE."""

import sys

from pymodbus.client import ModbusSerialClient, ModbusTcpClient

kind, where = sys.argv[1:]
if kind == "tcp":
    client = ModbusTcpClient("127.0.0.1", port=int(where))
else:
    # Pseudo terminals have no parity, and the C library makes asking for one an error.
    client = ModbusSerialClient(where, baudrate=19200, parity="N", stopbits=1, timeout=2)
assert client.connect()
UNIT = 17


def registers(address, count):
    answer = client.read_holding_registers(address, count=count, device_id=UNIT)
    assert not answer.isError(), answer
    return answer.registers


def fails(answer, code):
    assert answer.isError() and answer.exception_code == code, answer


if kind == "tcp":
    assert registers(100, 2) == [0x0102, 0x0304]
    assert not client.write_coils(10, [True] + 6 * [False] + 2 * [True] + [False, True], device_id=UNIT).isError()
    assert client.read_coils(10, count=11, device_id=UNIT).bits[:11] == [True] + 6 * [False] + 2 * [True] + [False, True]
    assert not client.write_coil(500, True, device_id=UNIT).isError()
    assert client.read_coils(500, count=1, device_id=UNIT).bits[0]
else:
    assert registers(50, 2) == [0x0102, 0x0304]
assert not client.write_registers(20, [0x6162, 0x6364], device_id=UNIT).isError()
values = list(range(1000, 1123))
assert not client.write_registers(1000, values, device_id=UNIT).isError()
assert registers(1000, 123) == values
assert len(registers(1000, 125)) == 125
assert not client.write_register(1200, 0x12, device_id=UNIT).isError()
assert not client.mask_write_register(address=1200, and_mask=0xF2, or_mask=0x25, device_id=UNIT).isError()
assert registers(1200, 1) == [0x17]
exchange = client.readwrite_registers(
    read_address=1300, read_count=2, write_address=1301, values=[5, 6], device_id=UNIT
)
assert exchange.registers == [0, 5], exchange
fails(client.read_input_registers(0, count=1, device_id=UNIT), 1)
fails(client.read_discrete_inputs(0, count=1, device_id=UNIT), 1)
fails(client.read_holding_registers(65535, count=2, device_id=UNIT), 2)
assert not client.write_register(0, 7, device_id=UNIT).isError()
client.close()
