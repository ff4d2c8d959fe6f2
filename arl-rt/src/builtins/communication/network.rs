//! `setip` and `getip`: the addresses of the controller's network ports (manual 5.6.1.1, 5.6.1.2).

use std::io;
use std::net::Ipv4Addr;

use crate::builtins::storing;
use crate::communication::{NetworkDriver, PortSettings};
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::storage::disk::Disk;
use crate::storage::state::{KeptState, Saved};
use crate::values::Str;
use arl_robot::robot::Family;

/// The name under which the settings are kept without a driver.
const KEPT: &str = "NETWORK";

/// The network ports of a SCARA robot's cabinet. Other cabinets have only the first one.
const PORTS: [&str; 3] = ["eth1", "eth2", "eth3"];

/// Sets address, gateway and mask of a network port. False if one of them is not an address, the mask is not a network
/// mask, or the port does not exist.
///
/// # Errors
/// None.
pub async fn setip(cx: &Cx, ip: &Str, gate: &Str, mask: &Str, if_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let (Some(port), Some(settings)) = (port(cx, if_name), settings(ip, gate, mask)) else { return Ok(false) };
    let set = match with_driver(cx, |driver| driver.set(port, settings)) {
        Some(set) => set,
        None => keep(cx, port, settings).await,
    };
    Ok(or_warning(cx, "setip", set).is_some())
}

/// Reads the address of a network port. False, and `ip` stays, if the address is not set or the port does not exist.
///
/// # Errors
/// None.
pub async fn getip(cx: &Cx, ip: &mut Str, if_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let Some(port) = port(cx, if_name) else { return Ok(false) };
    let find = |list: Vec<(String, PortSettings)>| list.into_iter().find(|it| it.0 == port).map(|it| it.1);
    let found = with_driver(cx, |driver| driver.get(port));
    let found = found.unwrap_or_else(|| kept(&mut cx.shared().state.borrow_mut()).map(find));
    let found = or_warning(cx, "getip", found).flatten();
    Ok(found.map(|settings| *ip = settings.address.to_string().into()).is_some())
}

/// Calls `ask` with the driver; `None` without a driver.
fn with_driver<T>(cx: &Cx, ask: impl FnOnce(&mut dyn NetworkDriver) -> T) -> Option<T> {
    let mut driver = cx.shared().network_driver.borrow_mut();
    driver.as_mut().map(|driver| ask(&mut **driver))
}

/// The port of this name, if the robot's cabinet has it.
fn port(cx: &Cx, name: &Str) -> Option<&'static str> {
    let count = match cx.family() {
        Family::SixAxis => 1,
        Family::Scara => PORTS.len(),
    };
    PORTS.into_iter().take(count).find(|port| name == *port)
}

fn settings(ip: &Str, gate: &Str, mask: &Str) -> Option<PortSettings> {
    let address = |text: &Str| text.to_text().parse::<Ipv4Addr>().ok();
    let (address, gateway, mask) = (address(ip)?, address(gate)?, address(mask)?);
    let ones = mask.to_bits().leading_ones();
    (mask.to_bits().count_ones() == ones).then_some(PortSettings { address, gateway, mask })
}

/// The settings that are kept, by port.
fn kept(state: &mut KeptState) -> io::Result<Vec<(String, PortSettings)>> {
    let text = state.load(KEPT).map_err(io::Error::other)?.unwrap_or_default();
    let read = |line: &str| {
        let mut words = line.split(' ');
        let port = words.next()?.to_owned();
        let mut address = || words.next()?.parse().ok();
        Some((port, PortSettings { address: address()?, gateway: address()?, mask: address()? }))
    };
    Ok(text.lines().filter_map(read).collect())
}

/// Stores the settings of a port together with those of the others.
async fn keep(cx: &Cx, port: &str, settings: PortSettings) -> io::Result<()> {
    let saved = begin_to_keep(&mut cx.shared().state.borrow_mut(), &cx.shared().disk, port, settings)?;
    storing::saved(saved, cx).await.map_err(io::Error::other)
}

fn begin_to_keep(state: &mut KeptState, disk: &Disk, port: &str, settings: PortSettings) -> io::Result<Saved> {
    let mut list = kept(state)?;
    list.retain(|(known, _)| known != port);
    list.push((port.to_owned(), settings));
    let line = |(port, it): &(String, PortSettings)| format!("{port} {} {} {}\n", it.address, it.gateway, it.mask);
    Ok(state.save(KEPT, list.iter().map(line).collect(), disk))
}

/// The value of a result; an error becomes a warning.
fn or_warning<T>(cx: &Cx, function: &str, result: io::Result<T>) -> Option<T> {
    result.map_err(|error| cx.shared().warn(format!("{function}: {error}"))).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::state::Memory;

    #[test]
    fn masks_have_their_ones_in_front() {
        let good = |ip: &str, gate: &str, mask: &str| settings(&ip.into(), &gate.into(), &mask.into()).is_some();
        assert!(good("10.20.210.93", "10.20.210.1", "255.255.255.0"));
        assert!(good("10.20.210.93", "10.20.210.1", "255.255.255.128"));
        for (ip, gate, mask) in [
            ("10.20.210", "10.20.210.1", "255.255.255.0"),
            ("10.20.210.93", "", "255.255.255.0"),
            ("10.20.210.93", "10.20.210.1", "255.0.255.0"),
            ("10.20.210.93", "10.20.210.256", "255.255.255.0"),
        ] {
            assert!(!good(ip, gate, mask), "{ip} {gate} {mask}");
        }
    }

    #[test]
    fn each_port_keeps_its_own() {
        let mut state = KeptState::new(Box::new(Memory::default()));
        let settings = |last| PortSettings {
            address: Ipv4Addr::new(10, 0, 0, last),
            gateway: Ipv4Addr::new(10, 0, 0, 1),
            mask: Ipv4Addr::new(255, 0, 0, 0),
        };
        let disk = Disk::default();
        for (port, last) in [("eth1", 2), ("eth2", 3), ("eth1", 4)] {
            begin_to_keep(&mut state, &disk, port, settings(last)).unwrap().take().unwrap().unwrap();
        }
        assert_eq!(kept(&mut state).unwrap(), [("eth2".into(), settings(3)), ("eth1".into(), settings(4))]);
    }
}
