//! Requests and answers: only the page of this computer's server is served.

use std::net::SocketAddr;

use serde::Serialize;

use super::http::{Answers, Rank, Request, Response, Status};

/// A request of the page.
pub(super) struct PageRequest<'a> {
    pub(super) path: &'a str,
    pub(super) query: &'a str,
    /// What is sent, if something is to be done.
    pub(super) order: Option<&'a str>,
}

/// An answer.
pub(super) enum Answer {
    /// A file of the page, or requested data: the type and the bytes.
    Bytes(&'static str, Vec<u8>),
    /// JSON.
    Json(String),
    NotFound,
    /// The request is refused, for this reason.
    Refused(String),
}

impl Answer {
    /// A value as JSON.
    pub(super) fn json(value: &impl Serialize) -> Self {
        serde_json::to_string(value).map_or_else(|error| Self::Refused(error.to_string()), Self::Json)
    }
}

impl PageRequest<'_> {
    /// A number of the query: `from=1.5`.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.text(name)?.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// A count of the query; 0 if it is missing.
    pub(super) fn count(&self, name: &str) -> usize {
        self.number(name).map_or(0, |number| number.max(0.0) as usize)
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.query.split('&').find_map(|pair| pair.strip_prefix(name)?.strip_prefix('='))
    }
}

/// Answers to the page of a server.
pub(super) struct ToPage<F> {
    /// The server's own names.
    hosts: [String; 2],
    answer: F,
}

impl<F: Fn(&PageRequest<'_>) -> Answer> ToPage<F> {
    /// Answers for the server at this address.
    pub(super) fn new(address: SocketAddr, answer: F) -> Self {
        let port = address.port();
        Self { hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")], answer }
    }

    fn respond(&self, request: &Request) -> Result<Response, (Status, String)> {
        self.expect_own(request).map_err(|why| (Status::Forbidden, why))?;
        let order = match &*request.method {
            "GET" => None,
            "POST" => {
                let text = std::str::from_utf8(&request.body);
                Some(text.map_err(|_| (Status::BadRequest, "an order must be UTF-8 text".to_owned()))?)
            }
            _ => return Err((Status::MethodNotAllowed, "only GET and POST".to_owned())),
        };
        match (self.answer)(&PageRequest { path: &request.path, query: &request.query, order }) {
            Answer::Bytes(kind, bytes) => Ok(Response::new(Status::Ok, kind, bytes)),
            Answer::Json(text) => Ok(Response::new(Status::Ok, "application/json", text.into_bytes())),
            Answer::NotFound => Err((Status::NotFound, "there is no such page".to_owned())),
            Answer::Refused(why) => Err((Status::Conflict, why)),
        }
    }

    /// Checks that the page of this server makes the request: other pages in the same browser must not, under whatever
    /// name they know this computer.
    fn expect_own(&self, request: &Request) -> Result<(), String> {
        if !self.hosts.contains(&request.host) {
            return Err(format!("this server answers requests for http://{} only", self.hosts[0]));
        }
        let own = |origin: &str| self.hosts.iter().any(|own| origin.strip_prefix("http://") == Some(own));
        match &request.origin {
            None if request.method == "POST" => Err("only the page of this server may do that".to_owned()),
            Some(origin) if !own(origin) => Err("only the page of this server may ask".to_owned()),
            _ => Ok(()),
        }
    }
}

impl<F: Fn(&PageRequest<'_>) -> Answer + Send + Sync + 'static> Answers for ToPage<F> {
    fn answer(&self, request: &Request) -> (Rank, Response) {
        let response = self.respond(request);
        let rank = match &response {
            Err((Status::Forbidden | Status::BadRequest | Status::MethodNotAllowed, _)) => Rank::Unknown,
            _ if request.method == "POST" => Rank::Orders,
            _ => Rank::Reader,
        };
        (rank, response.unwrap_or_else(|(status, why)| Response::text(status, &why)))
    }
}
