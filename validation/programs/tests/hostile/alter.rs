//! Answers, as programs that misbehave alter them.

use serde_json::{Value, json};

/// What the program can do; its set-up `odd` misbehaves.
pub fn capabilities(kind: &str) -> Value {
    let set_up = |name: &str| {
        json!({
            "name": name, "method": "none", "events": "library", "dense_output": true,
            "stepping": "adaptive",
        })
    };
    let mut said = json!({
        "library": "library", "version": "1.2.3", "language": "Rust",
        "setups": [set_up("good"), set_up("odd")],
    });
    match kind {
        "no-set-ups" => said["setups"] = json!([]),
        "many-set-ups" => {
            said["setups"] = (0..65).map(|n| set_up(&format!("s{n}"))).collect();
        }
        "set-up-twice" => said["setups"][0]["name"] = json!("odd"),
        "set-up-as-a-path" => said["setups"][1]["name"] = json!("../../x"),
        "unknown-stepping" => said["setups"][1]["stepping"] = json!("by-hand"),
        "unknown-class" => said["setups"][1]["class"] = json!("clever"),
        "no-order" => said["setups"][1]["stepping"] = json!("per-step"),
        "long-library" => said["library"] = json!("x".repeat(20_000_000)),
        "empty-library" => said["library"] = json!(""),
        _ => {}
    }
    said
}

/// The right run of the task in `rows.rs`.
pub fn right() -> Value {
    json!({
        "events": [
            { "time": 0.5, "event": 0, "mode": 1, "before": [0.5, 1.0], "state": [0.0, 1.0] },
            { "time": 1.5, "event": 0, "mode": 1, "before": [0.5, 1.0], "state": [0.5, 1.0] },
        ],
        "samples": [[0.0, 1.0], [0.25, 1.0], [0.75, 1.0]],
        "end": [0.75, 1.0],
        "work": { "rhs": 30, "jacobians": 2, "linear_solves": 4, "steps": 5 },
        "own_ns": 1,
    })
}

/// The run as a kind answers it.
fn run(kind: &str) -> Value {
    let mut run = right();
    let event = || json!({ "time": 0.5, "event": 0, "mode": 1, "state": [0.0, 1.0] });
    match kind {
        "nan-as-text" => run["end"][0] = json!("NaN"),
        "null" => run["end"][0] = Value::Null,
        "null-before" => run["events"][0]["before"][0] = Value::Null,
        "text-as-number" => run["events"][0]["time"] = json!("0.5"),
        "negative-time" => run["events"][0]["time"] = json!(-0.5),
        "time-goes-back" => run["events"][1]["time"] = json!(0.25),
        "beyond-the-horizon" => run["events"][0]["time"] = json!(2.5),
        "unknown-event" => run["events"][0]["event"] = json!(7),
        "negative-event" => run["events"][0]["event"] = json!(-1),
        "half-an-event" => run["events"][0]["event"] = json!(0.5),
        "unknown-mode" => run["events"][0]["mode"] = json!(7),
        "impossible-mode" => run["events"][0]["mode"] = json!(0),
        "states-missing" => run["events"][0]["state"] = json!([0.0]),
        "states-missing-before" => run["events"][0]["before"] = json!([0.5]),
        "state-too-many-before" => run["events"][1]["before"] = json!([0.5, 1.0, 2.0]),
        "end-of-another-size" => run["end"] = json!([0.0, 1.0, 2.0]),
        "sample-of-another-size" => run["samples"][1] = json!([]),
        "samples-missing" => run["samples"] = json!([[0.0, 1.0], [0.25, 1.0]]),
        "samples-too-many" => run["samples"] = json!([[0, 1], [0, 1], [0, 1], [0, 1]]),
        "events-too-many" => run["events"] = (0..101).map(|_| event()).collect(),
        "events-without-number" => run["events"] = (0..200_000).map(|_| event()).collect(),
        "state-without-number" => run["end"] = vec![0; 1_000_000].into(),
        "state-before-without-number" => run["events"][0]["before"] = vec![0; 1_000_000].into(),
        "unknown-end" => run["ended"] = json!("tired"),
        "end-beyond-horizon" => run["ended_at"] = json!(99.0),
        "leaves-domain-forward" => run["ended"] = json!("leaves-domain"),
        "negative-counter" => run["work"]["rhs"] = json!(-1),
        "counter-too-large" => run["work"]["rhs"] = json!(1e30),
        "calls-beyond-limit" => run["work"]["rhs"] = json!(999),
        "negative-own-time" => run["own_ns"] = json!(-1),
        "own-time-too-long" => run["own_ns"] = json!(1e18),
        "no-events" => drop(run.as_object_mut().unwrap().remove("events")),
        "no-time" => drop(run["events"][0].as_object_mut().unwrap().remove("time")),
        "one-field-more" => run["mood"] = json!("good"),
        "one-field-more-in-an-event" => run["events"][0]["mood"] = json!("good"),
        "text-for-events" => run["events"] = json!("none"),
        "object-for-events" => run["events"] = json!({}),
        "counts-with-a-point" => {
            run["events"][0]["mode"] = json!(1.0);
            run["work"]["rhs"] = json!(3e1);
        }
        "no-work" => {
            run.as_object_mut().unwrap().remove("work");
            run["own_ns"] = Value::Null;
        }
        "no-states-before" => {
            drop(run["events"][0].as_object_mut().unwrap().remove("before"));
            run["events"][1]["before"] = Value::Null;
        }
        _ => {}
    }
    run
}

/// The answer as a kind writes it, without the end of its line.
pub fn answer(kind: &str, id: u64) -> Vec<u8> {
    let mut answer = json!({ "percuss_protocol": 1, "id": id, "run": run(kind) });
    match kind {
        "other-id" => answer["id"] = json!(999),
        "earlier-id" => answer["id"] = json!(1),
        "negative-id" => answer["id"] = json!(-1),
        "text-as-id" => answer["id"] = json!(id.to_string()),
        "no-id" => drop(answer.as_object_mut().unwrap().remove("id")),
        "version-changes" => answer["percuss_protocol"] = json!(2),
        "two-in-one" => answer["ready"] = json!(true),
        "nothing-in-it" => drop(answer.as_object_mut().unwrap().remove("run")),
        "ready-for-a-run" => answer = said(id, "ready", json!(true)),
        "capabilities-for-a-run" => answer = said(id, "capabilities", capabilities("")),
        "failure" => answer = said(id, "failure", json!("the step\nbecame too small")),
        "empty-failure" => answer = said(id, "failure", json!("")),
        "long-failure" => answer = said(id, "failure", json!("y".repeat(20_000_000))),
        _ => {}
    }
    written(kind, id, &answer.to_string())
}

/// An answer of one part.
pub fn said(id: u64, key: &str, what: Value) -> Value {
    let mut answer = json!({ "percuss_protocol": 1, "id": id });
    answer[key] = what;
    answer
}

/// The bytes of an answer.
fn written(kind: &str, id: u64, text: &str) -> Vec<u8> {
    let end = |number: &str| text.replace("\"end\":[0.75,", &format!("\"end\":[{number},"));
    let [open, close] = ["[", "]"].map(|it| it.repeat(100_000));
    let deep = format!("{{\"percuss_protocol\":1,\"id\":{id},\"run\":{open}{close}}}");
    match kind {
        "nan" => end("NaN").into(),
        "infinity" => end("-Infinity").into(),
        "too-large-a-number" => end("1e999").into(),
        "field-twice" => text.replace("\"run\":", &format!("\"id\":{id},\"run\":")).into(),
        "truncated" => text[..text.len() / 2].into(),
        "a-list" => format!("[{text}]").into(),
        "two-on-a-line" => format!("{text}{text}").into(),
        "deep" => deep.into(),
        "escapes" => "\u{1b}[31mred".into(),
        "prints-a-word" => "loading".into(),
        "empty-line" => Vec::new(),
        "no-utf-8" => b"{\"percuss_protocol\":\"\xff\"}".to_vec(),
        "bytes" => vec![0xfe, 0xff, 0, 0x9f],
        "carriage-returns" => format!("{text}\r").into(),
        "byte-order-mark" => format!("\u{feff}{text}").into(),
        "spaces" => format!("\t  {text}  ").into(),
        "answers-twice" => format!("{text}\n{text}").into(),
        "talks-after-it" => format!("{text}\ndone").into(),
        "out-of-order" => format!("{}\n{text}", said(id + 1, "ready", json!(true))).into(),
        _ => text.into(),
    }
}
