"""A PLC that speaks the MC protocol, 3E frames in binary, and has D registers 0 to 12287. Its first line is its port.

Made from the public layout of the frames; melsec_clients.py holds it against other people's clients."""

import socketserver
import struct

REGISTERS = 12288
memory = bytearray(2 * REGISTERS)


def execute(body):
    """The end code and the data of a request: command, subcommand, and what follows."""
    if len(body) < 10:
        return 0xC061, b""
    command, subcommand = struct.unpack_from("<HH", body)
    start = int.from_bytes(body[4:7], "little")
    device, count = body[7], struct.unpack_from("<H", body, 8)[0]
    if command not in (0x0401, 0x1401) or subcommand != 0:
        return 0xC059, b""
    if device != 0xA8:
        return 0xC05B, b""
    if not 1 <= count <= 960:
        return 0xC051, b""
    if start + count > REGISTERS:
        return 0xC056, b""
    place = slice(2 * start, 2 * (start + count))
    if command == 0x0401:
        return 0, bytes(memory[place])
    if len(body) != 10 + 2 * count:
        return 0xC061, b""
    memory[place] = body[10:]
    return 0, b""


class Handler(socketserver.BaseRequestHandler):
    def take(self, count):
        data = b""
        while len(data) < count:
            piece = self.request.recv(count - len(data))
            if not piece:
                raise EOFError
            data += piece
        return data

    def handle(self):
        try:
            while True:
                head = self.take(9)
                assert head[:2] == b"\x50\x00", head
                body = self.take(struct.unpack_from("<H", head, 7)[0])
                code, data = execute(body[2:])
                self.request.sendall(
                    b"\xd0\x00" + head[2:7] + struct.pack("<HH", 2 + len(data), code) + data
                )
        except (EOFError, ConnectionError):
            pass


class Server(socketserver.ThreadingTCPServer):
    daemon_threads = True


with Server(("127.0.0.1", 0), Handler) as server:
    print(server.server_address[1], flush=True)
    server.serve_forever()
