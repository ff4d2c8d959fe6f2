//! The server of the page: on this computer only, and for its own page only.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::time::Duration;

use oxhttp::model::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, ORIGIN};
use oxhttp::model::header::{HeaderName, X_CONTENT_TYPE_OPTIONS};
use oxhttp::model::{Body, Method, Request, Response, StatusCode};
use oxhttp::{ListeningServer, Server};

use super::super::failure::Failure;

/// The page may load nothing but what this server has.
const POLICY: &str = "default-src 'self'; img-src 'self' data:; style-src 'self'; frame-ancestors 'none'";
/// A page keeps a few connections; nobody else has any.
const MOST_CONNECTIONS: usize = 64;
/// A connection on which nothing comes is closed.
const IDLE: Duration = Duration::from_secs(120);
/// How often another free port is tried where somebody else took the first one.
const TRIES: usize = 8;

/// What is asked for.
pub(super) struct Asked<'a> {
    pub(super) path: &'a str,
    pub(super) query: &'a str,
    /// What is sent, where something is to be done.
    pub(super) order: Option<String>,
}

/// What is answered.
pub(super) enum Answer {
    /// A file of the page, or what it asked for: the type and the bytes.
    Bytes(&'static str, Vec<u8>),
    Json(serde_json::Value),
    NotFound,
    /// It cannot be, and why.
    Refused(String),
}

impl Asked<'_> {
    /// A number of the query: `from=1.5`.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.text(name)?.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// A count of the query; 0 where there is none.
    pub(super) fn count(&self, name: &str) -> usize {
        self.number(name).map_or(0, |number| number.max(0.0) as usize)
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.query.split('&').find_map(|pair| pair.strip_prefix(name)?.strip_prefix('='))
    }
}

/// Serves on a port, any free one for 0; the address.
///
/// # Errors
/// The port is taken.
pub(super) fn serve(
    port: u16,
    answer: impl Fn(&Asked<'_>) -> Answer + Clone + Send + Sync + 'static,
) -> Result<(SocketAddr, ListeningServer), Failure> {
    let mut tries = if port == 0 { TRIES } else { 1 };
    loop {
        let address = free(port).and_then(|address| {
            let answer = answer.clone();
            let server = Server::new(move |request| respond(request, address, &answer)).bind(address);
            let server = server.with_max_concurrent_connections(MOST_CONNECTIONS).with_global_timeout(IDLE);
            Ok((address, server.spawn()?))
        });
        tries -= 1;
        match address {
            Ok(served) => return Ok(served),
            Err(_) if tries > 0 => {}
            Err(error) if error.kind() == std::io::ErrorKind::AddrInUse => {
                let text = format!(
                    "port {port} is taken, perhaps by another view: choose another `--port`, or leave it out for a free one"
                );
                return Err(Failure::Usage(text));
            }
            Err(error) => return Err(Failure::Usage(format!("cannot serve on port {port}: {error}"))),
        }
    }
}

/// The address to serve on.
fn free(port: u16) -> std::io::Result<SocketAddr> {
    // The library binds by itself and does not say which port it got.
    let wanted = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    if port == 0 { TcpListener::bind(wanted)?.local_addr() } else { Ok(wanted) }
}

fn respond(request: &mut Request<Body>, address: SocketAddr, answer: &impl Fn(&Asked<'_>) -> Answer) -> Response<Body> {
    if let Err(why) = is_own(request, address) {
        return text(StatusCode::FORBIDDEN, &why);
    }
    let order = match *request.method() {
        Method::GET => None,
        Method::POST => match body(request) {
            Ok(order) => Some(order),
            Err(why) => return text(StatusCode::BAD_REQUEST, &why),
        },
        _ => return text(StatusCode::METHOD_NOT_ALLOWED, "only GET and POST"),
    };
    let uri = request.uri();
    let asked = Asked { path: uri.path(), query: uri.query().unwrap_or_default(), order };
    match answer(&asked) {
        Answer::Bytes(kind, bytes) => finish(StatusCode::OK, kind, bytes),
        Answer::Json(value) => finish(StatusCode::OK, "application/json", value.to_string().into_bytes()),
        Answer::NotFound => text(StatusCode::NOT_FOUND, "there is no such page"),
        Answer::Refused(why) => text(StatusCode::CONFLICT, &why),
    }
}

/// Whether the page of this server asks: other pages in the same browser must not, under whatever name they know this computer.
fn is_own(request: &Request<Body>, address: SocketAddr) -> Result<(), String> {
    let port = address.port();
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let header = |name: HeaderName| request.headers().get(name).and_then(|value| value.to_str().ok());
    let host = header(HOST).unwrap_or_default();
    if !hosts.iter().any(|own| own == host) {
        return Err(format!("this server is http://127.0.0.1:{port}, and nothing else"));
    }
    let origin = header(ORIGIN);
    let own = origin.is_some_and(|origin| hosts.iter().any(|own| origin.strip_prefix("http://") == Some(own)));
    match origin {
        None if *request.method() == Method::POST => Err("only the page of this server may do that".to_owned()),
        Some(_) if !own => Err("only the page of this server may ask".to_owned()),
        _ => Ok(()),
    }
}

/// What was sent, where it is not longer than an order can be.
fn body(request: &mut Request<Body>) -> Result<String, String> {
    use std::io::Read;
    const LONGEST: u64 = 1 << 16;
    let mut bytes = Vec::new();
    let read = request.body_mut().take(LONGEST + 1).read_to_end(&mut bytes);
    read.map_err(|error| error.to_string())?;
    if bytes.len() as u64 > LONGEST {
        return Err(format!("an order is at most {LONGEST} bytes long"));
    }
    String::from_utf8(bytes).map_err(|_| "an order is a text in UTF-8".to_owned())
}

fn text(status: StatusCode, text: &str) -> Response<Body> {
    finish(status, "text/plain; charset=utf-8", text.as_bytes().to_vec())
}

fn finish(status: StatusCode, kind: &str, bytes: Vec<u8>) -> Response<Body> {
    let response = Response::builder()
        .status(status)
        .header(CONTENT_TYPE, kind)
        .header(CACHE_CONTROL, "no-store")
        .header(X_CONTENT_TYPE_OPTIONS, "nosniff")
        .header(CONTENT_SECURITY_POLICY, POLICY)
        .body(Body::from(bytes));
    // These names and values are good ones, whatever the bytes.
    response.unwrap_or_else(|_| Response::new(Body::empty()))
}
