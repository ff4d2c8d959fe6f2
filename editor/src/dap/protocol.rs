//! The messages of the debug adapter protocol.

use crate::framing;
use serde::Deserialize;
use serde_json::{Value, json};
use std::cell::Cell;

/// A request of the editor.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Request {
    pub(super) seq: i64,
    pub(super) command: String,
    #[serde(default)]
    pub(super) arguments: Value,
}

/// Messages to the editor, numbered.
#[derive(Default, Debug)]
pub(super) struct Outgoing {
    sent: Cell<i64>,
}

impl Outgoing {
    fn send(&self, mut message: Value) {
        self.sent.set(self.sent.get() + 1);
        message["seq"] = json!(self.sent.get());
        // The editor may no longer read: then the requests end, too.
        let _ = framing::write(&mut std::io::stdout().lock(), &message);
    }

    /// Answers a request.
    pub(super) fn answer(&self, request: &Request, result: Result<Value, String>) {
        let (success, mut answer) = match result {
            Ok(body) => (true, json!({"body": body})),
            Err(why) => (false, json!({"message": why, "body": {"error": {"id": 1, "format": why, "showUser": true}}})),
        };
        answer["type"] = json!("response");
        answer["request_seq"] = json!(request.seq);
        answer["command"] = json!(request.command);
        answer["success"] = json!(success);
        self.send(answer);
    }

    /// Reports that something has happened.
    pub(super) fn event(&self, event: &str, body: Value) {
        self.send(json!({"type": "event", "event": event, "body": body}));
    }

    /// Shows a text: `stdout` what the program prints, `stderr` mistakes and alarms, `console` messages of the adapter.
    pub(super) fn output(&self, category: &str, text: &str) {
        self.event("output", json!({"category": category, "output": text}));
    }
}

/// What the adapter can do.
pub(super) fn capabilities() -> Value {
    json!({
        "supportsConfigurationDoneRequest": true,
        "supportsFunctionBreakpoints": true,
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsLogPoints": true,
        "supportsEvaluateForHovers": true,
        "supportsSetVariable": true,
        "supportsSetExpression": true,
        "supportsStepBack": true,
        "supportsGotoTargetsRequest": true,
        "supportsRestartRequest": true,
        "supportsTerminateRequest": true,
        "supportsBreakpointLocationsRequest": true,
        "supportsExceptionInfoRequest": true,
        "exceptionBreakpointFilters": [
            {"filter": "alarms", "label": "Alarms", "default": true,
             "description": "Halts where an alarm comes up, before the program ends"},
            {"filter": "events", "label": "Events", "default": false,
             "description": "Halts where the action of an interrupt, timer or trigger begins"},
        ],
    })
}
