//! The sender whose packets count.

use std::net::{IpAddr, SocketAddr, ToSocketAddrs};

/// The robot named in the cell, or the first sender. All others are ignored.
#[derive(Debug)]
pub(super) struct Sender {
    /// The address in the cell: a host, with or without a port.
    address: Option<String>,
    /// The resolved addresses; port 0 is any port.
    named: Vec<SocketAddr>,
    /// The robot that is followed.
    followed: Option<SocketAddr>,
    /// The first other sender.
    other: Option<SocketAddr>,
    /// Whether the user has been told about them.
    followed_is_known: bool,
    other_is_known: bool,
}

impl Sender {
    pub(super) fn new(address: Option<String>) -> Self {
        let (named, followed_is_known) = (Vec::new(), address.is_some());
        Self { address, named, followed: None, other: None, followed_is_known, other_is_known: false }
    }

    /// Resolves the address in the cell.
    ///
    /// # Errors
    /// The host does not exist.
    pub(super) fn resolve(&mut self) -> Result<(), String> {
        let Some(address) = &self.address else { return Ok(()) };
        let is_host = address.parse::<IpAddr>().is_ok() || !address.contains(':');
        let found = if is_host { (address.as_str(), 0).to_socket_addrs() } else { address.to_socket_addrs() };
        self.named = found.map_err(|error| format!("{address}: {error}"))?.collect();
        if self.named.is_empty() { Err(format!("{address}: no address")) } else { Ok(()) }
    }

    /// Whether packets from an address count. Another port of the followed robot is for the link to judge, as a
    /// restarted RSI has another one.
    pub(super) fn is_robot(&self, from: SocketAddr) -> bool {
        let is_host = |robot: &SocketAddr| is_same_host(robot.ip(), from.ip());
        let is_named = |robot: &SocketAddr| is_host(robot) && (robot.port() == 0 || robot.port() == from.port());
        (self.address.is_none() || self.named.iter().any(is_named)) && self.followed.as_ref().is_none_or(is_host)
    }

    /// Follows this robot from now on.
    pub(super) fn follow(&mut self, robot: SocketAddr) {
        self.followed.get_or_insert(robot);
    }

    /// Records another sender.
    pub(super) fn note_other(&mut self, other: SocketAddr) {
        self.other.get_or_insert(other);
    }

    /// Returns a message for the user about the senders to `listen`, once.
    pub(super) fn take_warning(&mut self, listen: &str) -> Option<String> {
        let followed = self.followed?;
        if !std::mem::replace(&mut self.followed_is_known, true) {
            let ip = followed.ip().to_canonical();
            return Some(format!(
                "the robot at {followed} is used, as it was the first to send to {listen}: \
                 `address = \"{ip}\"` of [driver] in the cell makes sure that it is no other one"
            ));
        }
        let other = self.other.filter(|_| !std::mem::replace(&mut self.other_is_known, true))?;
        Some(format!("{other} sends to {listen}, too, and is ignored: the robot is {followed}"))
    }

    /// The reason why nothing that counts has arrived at `listen` for `seconds`.
    pub(super) fn missing(&self, listen: &str, seconds: u64) -> String {
        if let Some(robot) = self.followed {
            return format!(
                "nothing more has come from {robot} to {listen} within {seconds} s: its program has left RSI, or was stopped"
            );
        }
        match (&self.address, self.other) {
            (Some(address), Some(other)) => format!(
                "nothing has come from {address} to {listen} within {seconds} s, only from {other}: \
                 `address` of [driver] names another robot than the one that sends"
            ),
            (Some(address), None) => {
                format!(
                    "nothing has come from {address} to {listen} within {seconds} s: start RSI on the robot's pendant"
                )
            }
            (None, _) => format!("nothing has come to {listen} within {seconds} s: start RSI on the robot's pendant"),
        }
    }
}

/// Whether two addresses are the same, including IPv4 addresses written as IPv6.
fn is_same_host(one: IpAddr, other: IpAddr) -> bool {
    one.to_canonical() == other.to_canonical()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> SocketAddr {
        text.parse().unwrap()
    }

    #[test]
    fn a_host_is_a_robot_from_any_port_and_a_port_is_one_alone() {
        let mut host = Sender::new(Some("127.0.0.1".into()));
        assert!(!host.is_robot(at("127.0.0.1:5")), "nobody has looked it up");
        host.resolve().unwrap();
        assert!(host.is_robot(at("127.0.0.1:5")) && host.is_robot(at("[::ffff:127.0.0.1]:5")));
        assert!(!host.is_robot(at("127.0.0.2:5")));
        let mut port = Sender::new(Some("127.0.0.1:5".into()));
        port.resolve().unwrap();
        assert!(port.is_robot(at("127.0.0.1:5")) && !port.is_robot(at("127.0.0.1:6")));
        let mut six = Sender::new(Some("::1".into()));
        six.resolve().unwrap();
        assert!(six.is_robot(at("[::1]:5")) && !six.is_robot(at("[::2]:5")));
    }

    #[test]
    fn the_first_one_is_reported_and_followed() {
        let mut sender = Sender::new(None);
        sender.resolve().unwrap();
        assert!(sender.is_robot(at("10.0.0.1:5")) && sender.is_robot(at("10.0.0.2:5")));
        assert_eq!(sender.take_warning("*:1"), None);
        sender.follow(at("10.0.0.1:5"));
        sender.follow(at("10.0.0.2:5"));
        assert!(sender.is_robot(at("10.0.0.1:6")) && !sender.is_robot(at("10.0.0.2:5")));
        let warning = sender.take_warning("*:1").unwrap();
        assert!(
            warning.starts_with("the robot at 10.0.0.1:5 is used") && warning.contains("address = \"10.0.0.1\""),
            "{warning}"
        );
        assert_eq!(sender.take_warning("*:1"), None);
        sender.note_other(at("10.0.0.2:7"));
        sender.note_other(at("10.0.0.3:7"));
        assert_eq!(
            sender.take_warning("*:1").unwrap(),
            "10.0.0.2:7 sends to *:1, too, and is ignored: the robot is 10.0.0.1:5"
        );
        assert_eq!(sender.take_warning("*:1"), None);
    }

    #[test]
    fn who_waits_in_vain_hears_who_has_sent() {
        let mut sender = Sender::new(Some("10.0.0.1".into()));
        assert!(sender.missing("*:1", 30).ends_with("start RSI on the robot's pendant"));
        sender.note_other(at("10.0.0.2:7"));
        let why = "nothing has come from 10.0.0.1 to *:1 within 30 s, only from 10.0.0.2:7";
        assert!(sender.missing("*:1", 30).starts_with(why));
        let mut first = Sender::new(None);
        assert!(first.missing("*:1", 30).starts_with("nothing has come to *:1 within 30 s: start RSI"));
        first.follow(at("10.0.0.1:5"));
        first.note_other(at("10.0.0.2:7"));
        assert_eq!(
            first.missing("*:1", 30),
            "nothing more has come from 10.0.0.1:5 to *:1 within 30 s: its program has left RSI, or was stopped"
        );
    }
}
