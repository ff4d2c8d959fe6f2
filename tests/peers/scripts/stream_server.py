"""A server of byte streams: `echo` sends back what comes, `lines` answers each line with its length and its text in
capitals, `flaky` says one line to each client and hangs up. Says its port first."""

import socket
import sys
import threading


def echo(client):
    while data := client.recv(4096):
        client.sendall(data)


def lines(client):
    for line in client.makefile("rb"):
        text = line.rstrip(b"\n")
        client.sendall(b"%d %s\r\n" % (len(text), text.upper()))


def flaky(client):
    client.sendall(b"hello\n")


def serve(client, manner):
    with client:
        manner(client)


manner = {"echo": echo, "lines": lines, "flaky": flaky}[sys.argv[1]]
server = socket.create_server(("127.0.0.1", 0))
print(server.getsockname()[1], flush=True)
while True:
    threading.Thread(target=serve, args=(server.accept()[0], manner), daemon=True).start()
