//! A program that misbehaves in the way that it is told.

use super::alter::{answer, capabilities, said};
use rustix::process::{Signal, getpid, kill_process, setsid};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{BufRead, Read, Write, stderr, stdin, stdout};
use std::process::{Command, Stdio, exit};
use std::time::Duration;

/// Is the program: a kind, and a word by which its processes are found.
pub fn misbehave(kind: &str, token: &str) {
    before(kind, token);
    for line in stdin().lock().lines() {
        let Ok(line) = line else { break };
        let request: Value = serde_json::from_str(&line).expect("requests are in JSON");
        let id = request["id"].as_u64().expect("requests have numbers");
        match request["ask"].as_str() {
            Some("capabilities") => write_line(introduction(kind, id).to_string().as_bytes()),
            // The requests before it are those of the start and of the row before.
            Some("ready") if kind == "run-for-ready" && id == 6 => write_line(&answer("", id)),
            Some("ready") => write_line(said(id, "ready", json!(true)).to_string().as_bytes()),
            Some("run") if request["run"]["setup"] == "odd" => odd(kind, token, id),
            _ => write_line(&answer("", id)),
        }
    }
}

fn write_line(bytes: &[u8]) {
    let line = [bytes, b"\n"].concat();
    let mut output = stdout().lock();
    // Nobody reads any more where the program was given up.
    if output.write_all(&line).and_then(|()| output.flush()).is_err() {
        exit(1);
    }
}

/// What happens before the first request.
fn before(kind: &str, token: &str) {
    match kind {
        "exits-at-once" => exit(3),
        "exits-with-a-complaint" => {
            for _ in 0..100_000 {
                eprintln!("Traceback, most recent call last: {token}");
            }
            eprintln!("no module of that name\n");
            exit(3);
        }
        "aborts-at-once" => std::process::abort(),
        "waits-at-once" => linger(),
        "prints-a-banner" => write_line(b"Welcome to the language"),
        "speaks-unasked" => write_line(introduction(kind, 1).to_string().as_bytes()),
        "linger" => {
            stderr().write_all(b"up\n").expect("the parent waits");
            linger();
        }
        "linger-in-a-session" => {
            setsid().expect("it leads no group");
            stderr().write_all(b"up\n").expect("the parent waits");
            linger();
        }
        "parent-of-an-orphan" => {
            child("linger-in-a-session", token, &[]);
            stderr().write_all(b"up\n").expect("the parent waits");
            exit(0);
        }
        _ => {}
    }
}

fn introduction(kind: &str, id: u64) -> Value {
    match kind {
        "no-library" => said(id, "unavailable", json!("the library is not installed")),
        "fails-at-once" => said(id, "failure", json!("the licence has expired")),
        "ready-for-capabilities" => said(id, "ready", json!(true)),
        _ => {
            let mut answer = said(id, "capabilities", capabilities(kind));
            match kind {
                "other-version" => {
                    answer = json!({ "percuss_protocol": 2, "id": id, "hello": "there" });
                }
                "no-version" => drop(answer.as_object_mut().unwrap().remove("percuss_protocol")),
                _ => {}
            }
            answer
        }
    }
}

/// Waits until it is killed, or for ten minutes.
fn linger() -> ! {
    std::thread::sleep(Duration::from_secs(600));
    exit(0)
}

/// What happens where the set-up that misbehaves is asked for a run.
fn odd(kind: &str, token: &str, id: u64) {
    instead(kind);
    without_end(kind);
    leave(kind, token);
    match kind {
        "megabytes-of-complaints" => complain(8 << 20),
        "complains-and-exits" => {
            complain(1 << 20);
            eprintln!("\nand that is all");
            exit(1);
        }
        "exits-in-a-line" => {
            let whole = answer("", id);
            stdout().write_all(&whole[..40]).and_then(|()| stdout().flush()).expect("it is read");
            exit(3);
        }
        _ => {}
    }
    write_line(&answer(kind, id));
    after(kind, token);
}

fn instead(kind: &str) {
    match kind {
        "exits" => exit(3),
        "exits-well" => exit(0),
        "aborts" => std::process::abort(),
        "kills-itself" => signal(Signal::KILL),
        "waits" => linger(),
        "reads-nothing" => linger(),
        "waits-and-ignores-signals" => {
            for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
                let flag = std::sync::Arc::default();
                signal_hook::flag::register(signal, flag).expect("the signal is known");
            }
            linger();
        }
        "stops-itself" => signal(Signal::STOP),
        "closes-its-output" => {
            close_output();
            linger();
        }
        _ => {}
    }
}

fn without_end(kind: &str) {
    let part: &[u8] = match kind {
        "drips" => b" ",
        "empty-lines-without-end" => b"\n",
        "lines-without-end" => b"x\n",
        "line-without-end" => &[b'x'; 65536],
        _ => return,
    };
    let mut output = stdout().lock();
    while output.write_all(part).and_then(|()| output.flush()).is_ok() {
        if kind == "drips" {
            std::thread::sleep(Duration::from_millis(10));
        }
    }
    exit(1);
}

/// Leaves processes behind.
fn leave(kind: &str, token: &str) {
    match kind {
        "leaves-a-child" => child("linger", token, &["output"]),
        "leaves-a-silent-child" => child("linger", token, &[]),
        "leaves-a-session" => child("linger-in-a-session", token, &[]),
        "leaves-an-orphan" => child("parent-of-an-orphan", token, &[]),
        "leaves-many" => (0..8).for_each(|_| child("parent-of-an-orphan", token, &[])),
        "hides-a-child" => {
            child("linger-in-a-session", token, &["environment"]);
            linger();
        }
        _ => return,
    }
    exit(0);
}

fn after(kind: &str, token: &str) {
    match kind {
        "exits-after-it" => exit(0),
        "waits-after-it" => linger(),
        "stops-after-it" => signal(Signal::STOP),
        "closes-its-input-after-it" => {
            let nothing = File::open("/dev/null").expect("it is there");
            rustix::stdio::dup2_stdin(&nothing).expect("it is open");
            linger();
        }
        "closes-its-output-after-it" => {
            close_output();
            linger();
        }
        "orphan-after-it" => {
            child("parent-of-an-orphan", token, &[]);
            exit(0);
        }
        _ => {}
    }
}

fn signal(signal: Signal) {
    kill_process(getpid(), signal).expect("it is its own");
}

fn close_output() {
    let nothing = File::create("/dev/null").expect("it is there");
    rustix::stdio::dup2_stdout(&nothing).expect("it is open");
}

fn complain(bytes: usize) {
    let line = [b"complaint ".repeat(100).as_slice(), b"\n"].concat();
    (0..bytes / line.len()).for_each(|_| stderr().write_all(&line).expect("it is read"));
}

/// Starts another process and waits until it is what it is to be. `with` says what it gets beside
/// its arguments: the output of this one, or an environment that is not this one's.
#[allow(clippy::zombie_processes, reason = "it is left behind")]
fn child(kind: &str, token: &str, with: &[&str]) {
    let own = std::env::current_exe().expect("it is a file");
    let mut command = Command::new(own);
    command.args(["misbehave", kind, token]).stdin(Stdio::null()).stderr(Stdio::piped());
    command.stdout(if with.contains(&"output") { Stdio::inherit() } else { Stdio::null() });
    if with.contains(&"environment") {
        command.env_clear();
    }
    let mut child = command.spawn().expect("it is started");
    let mut up = [0; 3];
    child.stderr.take().expect("it is piped").read_exact(&mut up).expect("it says so");
    // Its own child is left without a parent.
    if kind == "parent-of-an-orphan" {
        child.wait().expect("it ends");
    }
}
