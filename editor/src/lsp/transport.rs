//! Messages over standard input and output.
//!
//! A message that is not JSON, or not what the protocol allows, is answered and skipped: its header gives its length.
//! What is between messages and is not a header is skipped, too.

use crate::framing::{self, Messages};
use gen_lsp_types::ErrorCodes;
use gen_lsp_types::json_rpc::Id;
use serde::Serialize;
use serde_json::{Value, json};
use std::io::BufRead;
use std::sync::mpsc::{Receiver, Sender, channel};

/// An incoming message.
#[derive(PartialEq, Debug)]
pub(super) enum Incoming {
    /// A request, which is answered under its number.
    Request(Id, String, Value),
    Notification(String, Value),
    /// The answer to a request of ours.
    Response,
    /// Something that is not a message, and the answer to it.
    Malformed(Value),
}

/// The answer to a request.
pub(super) fn answer(id: &Id, result: &impl Serialize) -> Value {
    match serde_json::to_value(result) {
        Ok(result) => json!({"jsonrpc": "2.0", "id": id, "result": result}),
        Err(error) => refusal(id, ErrorCodes::InternalError, &error.to_string()),
    }
}

/// The answer to a request that is not fulfilled.
pub(super) fn refusal(id: &Id, code: ErrorCodes, message: &str) -> Value {
    json!({"jsonrpc": "2.0", "id": id, "error": {"code": code, "message": message}})
}

/// A message without an answer.
pub(super) fn notification(method: &str, params: &impl Serialize) -> Value {
    json!({"jsonrpc": "2.0", "method": method, "params": params})
}

/// Starts the thread that reads; the channel ends with the input.
pub(super) fn reader() -> Receiver<Incoming> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let mut input = Messages::new(std::io::stdin().lock());
        while let Some(incoming) = read(&mut input) {
            if sender.send(incoming).is_err() {
                break;
            }
        }
    });
    receiver
}

/// Starts the thread that writes. It ends when the sender is dropped or the output is closed.
pub(super) fn writer() -> (Sender<Value>, std::thread::JoinHandle<()>) {
    let (sender, receiver) = channel::<Value>();
    let thread = std::thread::spawn(move || {
        let mut output = std::io::stdout().lock();
        for message in receiver {
            if framing::write(&mut output, &message).is_err() {
                break;
            }
        }
    });
    (sender, thread)
}

/// The next message; `None` at the end of the input.
fn read(input: &mut Messages<impl BufRead>) -> Option<Incoming> {
    let body = input.next_message()?;
    Some(match serde_json::from_slice::<Value>(&body) {
        Ok(value) => message(value),
        Err(error) => Incoming::Malformed(refusal(&Id::Null, ErrorCodes::ParseError, &error.to_string())),
    })
}

/// A message of the protocol, or the answer to anything else.
fn message(mut value: Value) -> Incoming {
    let id = value.get("id").map(|id| serde_json::from_value::<Id>(id.clone()).ok());
    let method = value.get("method").and_then(Value::as_str).map(ToString::to_string);
    let params = value.get_mut("params").map(Value::take).unwrap_or_default();
    let is_answer = value.get("result").is_some() || value.get("error").is_some();
    match (id, method) {
        (Some(Some(Id::Number(_) | Id::String(_))), None) if is_answer => Incoming::Response,
        (Some(Some(id @ (Id::Number(_) | Id::String(_)))), Some(method)) => Incoming::Request(id, method, params),
        (None, Some(method)) => Incoming::Notification(method, params),
        (id, _) => {
            let id = id.flatten().unwrap_or(Id::Null);
            let text = "this is not a request, notification or response";
            Incoming::Malformed(refusal(&id, ErrorCodes::InvalidRequest, text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(input: &str) -> Vec<Incoming> {
        let mut input = Messages::new(input.as_bytes());
        std::iter::from_fn(|| read(&mut input)).collect()
    }

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    #[test]
    fn what_is_no_message_costs_itself_only() {
        let good = framed(r#"{"jsonrpc":"2.0","method":"exit"}"#);
        let input = framed("{nonsense") + "noise\r\n\r\n" + &framed(r#"{"id":7}"#) + &framed("[1]") + &good;
        let mut messages = all(&input);
        assert_eq!(messages.pop(), Some(Incoming::Notification("exit".into(), Value::Null)));
        let code = |incoming: &Incoming| match incoming {
            Incoming::Malformed(answer) => (answer["id"].clone(), answer["error"]["code"].as_i64()),
            _ => (Value::Null, None),
        };
        let codes: Vec<_> = messages.iter().map(code).collect();
        assert_eq!(codes, [(Value::Null, Some(-32700)), (json!(7), Some(-32600)), (Value::Null, Some(-32600))]);
    }

    #[test]
    fn a_message_that_is_cut_off_ends_the_input() {
        assert!(all("Content-Length: 20\r\n\r\n{}").is_empty());
        assert!(all("Content-Length: x\r\n\r\n").is_empty());
    }
}
