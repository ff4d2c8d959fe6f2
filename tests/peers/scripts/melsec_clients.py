"""Holds the tests' PLC against two clients of other people, and leaves a text for the program at D6000. Argument: the port."""

import sys
import warnings

import pymcprotocol
import slmp

port = int(sys.argv[1])

plc = pymcprotocol.Type3E()
plc.connect("127.0.0.1", port)
plc.batchwrite_wordunits("D100", [1, -2, 300, 0x6162])
assert plc.batchread_wordunits("D100", 4) == [1, -2, 300, 0x6162]
try:
    plc.batchread_wordunits("D12287", 2)
    raise SystemExit("D12288 does not exist")
except pymcprotocol.mcprotocolerror.MCProtocolError as error:
    assert "C056" in str(error).upper(), error

warnings.simplefilter("ignore")
with slmp.SlmpClient(
    "127.0.0.1", port, plc_series=slmp.PLCSeries.QL, frame_type=slmp.FrameType.FRAME_3E, _allow_manual_profile=True,
    strict_profile=False, raise_on_error=True,
) as other:
    assert other.read_devices("D100", 4) == [1, 0xFFFE, 300, 0x6162]
    other.write_devices("D102", [7, 8])
assert plc.batchread_wordunits("D100", 4) == [1, -2, 7, 8]

plc.batchwrite_wordunits("D6000", [int.from_bytes(b"he", "little"), int.from_bytes(b"ll", "little"), ord("o")])
plc.close()
