//! Both sides of the protocol are held to its schemas, and to the examples on its page.

use super::{Ask, Asked, ReplyContent, RunAsk, decode};
use jsonschema::Validator;
use percuss::Parameters;
use percuss_engines::engine::{Accuracy, Limits, Task, percussive};
use percuss_engines::system::{CheckedSystem, CoefficientDerivatives, Direction, System, Watch};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

fn schema(of: &str) -> Validator {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join(format!("../schemas/program-{of}.schema.json"));
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let schema: Value = serde_json::from_str(&text).unwrap_or_default();
    assert!(schema.is_object(), "{of}");
    match jsonschema::validator_for(&schema) {
        Ok(schema) => schema,
        Err(error) => unreachable!("{of}: {error}"),
    }
}

fn value(ask: &Ask<'_>) -> Value {
    serde_json::to_value(ask).unwrap_or_default()
}

/// The oscillator, with an event that is only counted.
fn system() -> System {
    let mut system = percussive(&Parameters::default(), 0.5);
    let guard = system.modes[0].until[0].guard.clone();
    let watch = Watch { name: "seen".to_owned(), guard, direction: Direction::Both };
    system.modes[0].watch.push(watch);
    system
}

fn task(system: System) -> Task {
    let Ok(system) = CheckedSystem::new(system) else { unreachable!("it is whole") };
    let state = vec![0.25; system.system().states.len()];
    match Task::new(Arc::new(system), 0, &state, 3.0, vec![0.0, 1.5, 4.0]) {
        Ok(task) => task,
        Err(failure) => unreachable!("{failure}"),
    }
}

#[test]
fn requests_are_as_their_schema_says() {
    let schema = schema("request");
    let limits = Limits::default();
    let oscillator = task(system());
    let mut still = system();
    still.omega = 0.0;
    still.modes.iter_mut().for_each(|mode| mode.a.iter_mut().flatten().for_each(|it| *it = 0.0));
    for (task, accuracy) in
        [(oscillator, Accuracy::Tolerance(1e-6)), (task(still), Accuracy::Step(0.25))]
    {
        let run = RunAsk::new("radau", &task, accuracy, &limits);
        let ask = value(&Ask::run(3, &run));
        assert!(schema.is_valid(&ask), "{ask}: {:?}", schema.validate(&ask).err());
        assert_eq!(ask["run"]["tolerance"].is_null(), accuracy.tolerance().is_none());
        assert_eq!(ask["run"]["samples"], json!([0.0, 1.5, 3.0]));
        let mut spoiled = ask.clone();
        spoiled["run"]["span"] = json!(-1.0);
        assert!(!schema.is_valid(&spoiled));
    }
    for asked in [Asked::Capabilities, Asked::Ready] {
        assert!(schema.is_valid(&value(&Ask::plain(1, asked))), "{asked:?}");
    }
    assert!(!schema.is_valid(&value(&Ask::plain(1, Asked::Run))));
}

/// A task that asks for the derivatives by one name, all of them zero.
fn task_with_gradients() -> Task {
    let task = task(system());
    let modes = task.system.system().modes.clone();
    let (name, state) = ("g".to_owned(), task.state);
    let rates = CoefficientDerivatives { name, value: 1.0, omega: 0.0, phi: 0.0, state, modes };
    Task { gradients: Some(Arc::new(vec![rates])), ..task }
}

/// The key is there only where derivatives are asked for: other programs do not know it.
#[test]
fn derivatives_are_asked_for_as_the_schema_says() {
    let schema = schema("request");
    let (plain, asking) = (task(system()), task_with_gradients());
    let ask = |task: &Task| {
        let accuracy = Accuracy::Tolerance(1e-6);
        value(&Ask::run(3, &RunAsk::new("radau", task, accuracy, &Limits::default())))
    };
    assert_eq!(ask(&plain)["run"].get("gradients"), None);
    let mut asked = ask(&asking);
    assert!(schema.is_valid(&asked), "{asked}: {:?}", schema.validate(&asked).err());
    assert_eq!(asked["run"]["gradients"][0]["wrt"], json!("g"));
    let events = asked["run"]["system"]["modes"][0]["events"].as_array().map(Vec::len);
    let rates = asked["run"]["gradients"][0]["modes"][0]["events"].as_array().map(Vec::len);
    assert_eq!(rates, events);
    asked["run"]["gradients"][0]["modes"] = json!([]);
    assert!(!schema.is_valid(&asked));
}

#[test]
fn answered_derivatives_are_read_as_the_schema_says() {
    let schema = schema("answer");
    let (mut run, id) = example_run();
    run["run"]["gradients"] =
        json!([{"wrt": "g", "events": [{"time": 1, "state": null}, {}], "end": [0.5, 1.0]}]);
    assert!(schema.is_valid(&run), "{run}: {:?}", schema.validate(&run).err());
    let Ok(ReplyContent::Run(reply)) = decode(run.to_string().as_bytes(), id) else {
        unreachable!("{run}")
    };
    assert_eq!(reply.gradients.0[0].events.0[0].time, Some(1.0));
    let changes: [Spoiling; 4] = [
        |it| it["run"]["gradients"][0]["end"] = json!([null, 1.0]),
        |it| it["run"]["gradients"][0]["events"][0]["time"] = json!("NaN"),
        |it| it["run"]["gradients"][0]["mood"] = json!(1),
        |it| it["run"]["gradients"][0]["wrt"] = Value::Null,
    ];
    for (n, change) in changes.iter().enumerate() {
        let mut changed = run.clone();
        change(&mut changed);
        assert!(!schema.is_valid(&changed), "{n}: {changed}");
        assert!(decode(changed.to_string().as_bytes(), id).is_err(), "{n}: {changed}");
    }
}

/// The first block of JSON after a heading of the protocol's page, a message a line.
fn examples(heading: &str) -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/PROTOCOL.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    let (_, after) = page.split_once(&format!("\n## {heading}\n")).unwrap_or_default();
    let (_, block) = after.split_once("```json\n").unwrap_or_default();
    let (block, _) = block.split_once("```").unwrap_or_default();
    block.split("\n\n").filter_map(|text| serde_json::from_str(text).ok()).collect()
}

#[test]
fn the_examples_of_the_page_are_messages() {
    let (requests, answers) = (examples("Requests"), examples("Answers"));
    assert_eq!((requests.len(), answers.len()), (3, 6), "{requests:?} {answers:?}");
    let [request, answer] = ["request", "answer"].map(schema);
    for message in requests {
        assert!(request.is_valid(&message), "{message}: {:?}", request.validate(&message).err());
    }
    for message in answers {
        assert!(answer.is_valid(&message), "{message}: {:?}", answer.validate(&message).err());
        let id = message["id"].as_u64().unwrap_or_default();
        let decoded = decode(message.to_string().as_bytes(), id);
        assert!(decoded.is_ok(), "{message}: {decoded:?}");
    }
}

/// The run among the answers of the protocol's page, and the number of its request.
fn example_run() -> (Value, u64) {
    let runs: Vec<Value> =
        examples("Answers").into_iter().filter(|it| it["run"].is_object()).collect();
    let [run] = runs.as_slice() else { unreachable!("{runs:?}") };
    (run.clone(), run["id"].as_u64().unwrap_or_default())
}

/// Derivatives are differences of runs only where a set-up says so.
#[test]
fn a_set_up_says_that_it_takes_differences() {
    let schema = schema("answer");
    let Some(plain) = examples("Answers").into_iter().find(|it| it["capabilities"].is_object())
    else {
        unreachable!("the page has capabilities")
    };
    let id = plain["id"].as_u64().unwrap_or_default();
    let said = |changed: &Value| match decode(changed.to_string().as_bytes(), id) {
        Ok(ReplyContent::Capabilities(it)) => it.set_ups[0].differences,
        other => unreachable!("{changed}: {other:?}"),
    };
    assert!(!said(&plain));
    let mut changed = plain;
    changed["capabilities"]["setups"][0]["differences"] = json!(true);
    assert!(schema.is_valid(&changed), "{changed}: {:?}", schema.validate(&changed).err());
    assert!(said(&changed));
    changed["capabilities"]["setups"][0]["differences"] = json!("central");
    assert!(!schema.is_valid(&changed));
    assert!(decode(changed.to_string().as_bytes(), id).is_err());
}

/// A change of an answer.
type Spoiling = fn(&mut Value);

/// What the schema refuses in an answer is refused by its reader.
#[test]
fn reader_and_schema_agree() {
    let schema = schema("answer");
    let changes: [Spoiling; 14] = [
        |it| it["percuss_protocol"] = json!(2),
        |it| it["id"] = json!(-1),
        |it| it["mood"] = json!(1),
        |it| it["ready"] = json!(true),
        |it| it["run"] = Value::Null,
        |it| it["run"]["end"] = json!(["1"]),
        |it| it["run"]["end"] = json!(vec![0.0; 12]),
        |it| it["run"]["ended"] = json!("Horizon"),
        |it| it["run"]["work"]["rhs"] = json!(0.5),
        |it| it["run"]["work"]["calls"] = json!(1),
        |it| it["run"]["events"][0]["time"] = Value::Null,
        |it| it["run"]["events"][0]["mode"] = json!(-1),
        |it| it["run"]["events"][0]["before"] = json!(["1"]),
        |it| it["run"]["events"][0]["before"] = json!(vec![0.0; 12]),
    ];
    let (run, id) = example_run();
    for (n, change) in changes.iter().enumerate() {
        let mut changed = run.clone();
        change(&mut changed);
        assert!(!schema.is_valid(&changed), "{n}: {changed}");
        assert!(decode(changed.to_string().as_bytes(), id).is_err(), "{n}: {changed}");
    }
}

/// The state before an event's reset is read where it is given; it may be left out or be null.
#[test]
fn the_state_before_a_reset_may_be_missing() {
    let schema = schema("answer");
    let (mut run, id) = example_run();
    let given = run["run"]["events"][1]["before"].as_array().map(Vec::len);
    run["run"]["events"][0].as_object_mut().map(|event| event.remove("before"));
    run["run"]["events"][2]["before"] = Value::Null;
    assert!(schema.is_valid(&run), "{run}: {:?}", schema.validate(&run).err());
    let Ok(ReplyContent::Run(reply)) = decode(run.to_string().as_bytes(), id) else {
        unreachable!("{run}")
    };
    let sizes: Vec<Option<usize>> =
        reply.events.0.iter().map(|event| event.before.map(|it| it.0.len())).collect();
    assert_eq!(sizes, [None, given, None]);
    assert_eq!(given, Some(2));
}
