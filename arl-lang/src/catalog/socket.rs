//! 5.6.1: sockets. Each call tries once and returns whether it is done; `waituntil` repeats it.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Accepted;

entries! { pub(super) SOCKET =
    /// Sets address, gateway and mask of a network port; true if it worked.
    fn setip(
        ip: string "the address",
        gate: string "the gateway",
        mask: string "the mask of the subnet",
        if_name: string [otherwise("\"eth1\"")] "the port: eth1 without it",
    ) -> bool
        { "5.6.1.1", socket::setip, waits, fails, uses_disk;
          "print setip(\"10.20.210.93\",\"10.20.210.1\",\"255.255.255.0\",\"eth1\")" }
    /// Reads the address of a network port; true if it worked.
    fn getip(
        ip: string [out] "gets the address",
        if_name: string [otherwise("\"eth1\"")] "the port: eth1 without it",
    ) -> bool
        { "5.6.1.2", socket::getip, waits, fails; "string ip\nif(getip(ip)) print ip" }
    /// Connects to a server; true when the connection is established.
    fn connect(s: socket "the connection", ip: string "the server's address", port: int [accepts(Accepted::Range(1, 65535))] "the server's port") -> bool
        { "5.6.1.3", socket::connect, waits, fails, connects; "socket s\nwaituntil connect(s,\"192.168.0.40\",2888),maxtime:5" }
    /// Listens for a client; true when one has connected.
    fn accept(s: socket "the connection", ip: string "the controller's own address", port: int [accepts(Accepted::Range(1, 65535))] "the port to listen on") -> bool
        { "5.6.1.4", socket::accept, waits, fails, connects; "socket s\nwaituntil accept(s,\"192.168.0.40\",2888),maxtime:5" }
    /// Error state of a connection: 0, or $ERR_SOCKET_CLOSED when the other side has closed it.
    fn geterror(s: socket "the connection") -> int
        { "5.6.1.5", socket::geterror, waits, fails; "socket s\nprint geterror(s)" }
    /// Closes a connection; closing one that is not open does nothing.
    fn close(s: socket "the connection")
        { "5.6.1.5", socket::close, waits; "socket s\nclose(s)" }
    /// Sends a text; true when all of it has been sent.
    fn write(s: socket "the connection", data: string "the text") -> bool
        { "5.6.1.5", socket::write_string, waits, fails;
          "socket s\nwaituntil connect(s,\"192.168.0.40\",2888)\nwaituntil write(s,\"hello\")" }
    /// Sends bytes; true when all of them have been sent.
    fn write(s: socket "the connection", data: [byte] "the bytes", len: int [counts(8)] "how many of them") -> bool
        { "5.6.1.5", socket::write_bytes, waits, fails;
          "socket s\nbyte data[3] = {1,2,3}\nwaituntil connect(s,\"192.168.0.40\",2888)\nwaituntil write(s,data,3)" }
    /// Takes exactly len bytes as a text when that many have arrived; the rest stays for the next call.
    fn read(s: socket "the connection", data: string [out] "gets the text", len: int "how many bytes") -> bool
        { "5.6.1.6", socket::read_string, waits, fails;
          "socket s\nstring data\nwaituntil connect(s,\"192.168.0.40\",2888)\nwaituntil read(s,data,5)" }
    /// Takes exactly len bytes when that many have arrived; the rest stays for the next call.
    fn read(s: socket "the connection", data: [byte] [out] "gets the bytes", len: int [counts(8)] "how many bytes") -> bool
        { "5.6.1.6", socket::read_bytes, waits, fails;
          "socket s\nbyte data[3]\nwaituntil connect(s,\"192.168.0.40\",2888)\nwaituntil read(s,data,3)" }
    /// Takes the text before a mark when the mark has arrived; both leave the buffer.
    fn readuntil(s: socket "the connection", data: string [out] "gets the text", cut: string "the mark") -> bool
        { "5.6.1.7", socket::readuntil, waits, fails;
          "socket s\nstring line\nwaituntil connect(s,\"192.168.0.40\",2888)\nwaituntil readuntil(s,line,\"\\n\")" }
    /// Discards what has arrived but has not been read; true if it worked.
    fn clearbuff(s: socket "the connection") -> bool
        { "5.6.1.8", socket::clearbuff, waits, fails; "socket s\nprint clearbuff(s)" }
}
