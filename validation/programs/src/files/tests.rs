//! The oscillator as files.

use super::CaseFile;
use percuss::Parameters;
use percuss_engines::engine::{Task, percussive};
use percuss_engines::system::CheckedSystem;
use std::sync::Arc;

fn task() -> Task {
    let system = percussive(&Parameters::default(), 0.5);
    let Ok(system) = CheckedSystem::new(system) else { unreachable!("it is whole") };
    let start = [-0.02, 0.0, 0.0, 0.0];
    let Ok(task) = Task::new(Arc::new(system), 0, &start, 3.0, vec![0.0, 1.5]) else {
        unreachable!("it is a run")
    };
    task
}

fn text(ending: &str) -> String {
    let task = task();
    let files = CaseFile::new("mine", &task, []).plain_files();
    files.into_iter().find(|it| it.0 == ending).map(|it| it.1).unwrap_or_default()
}

#[test]
fn equations_are_those_of_the_paper() {
    let text = text("txt");
    for line in [
        "case mine of the system percussive-oscillator\ntime t from 0 to 3\n",
        "theta = 1.4 t + 0.5\nstart in mode no-contact: p = -0.02, y = 0, q = 0, v = 0\n",
        "mode no-contact\n  p' = y\n  y' = 0.3 cos(theta) + 0.1\n  q' = -50 q\n  v' = 0\n",
        "    where p - q - 0.02 rises through 0\n    p becomes q + 0.02\n",
        "    mode progression follows where 0.02 y + q - 1 > 0, or else\n    mode contact follows\n",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
}

#[test]
fn rows_are_over_the_states_and_the_forcing() {
    let rows = text("rows.csv");
    for line in [
        "mode,event,row,of,p,y,q,v,cos,sin,one\n",
        "no-contact,,rate,y,0,0,0,0,0.3,0,0.1\n",
        "no-contact,impact,guard,rising,1,0,-1,0,0,0,-0.02\n",
        "no-contact,impact,successor,contact,0,0,0,0,0,0,1\n",
    ] {
        assert!(rows.contains(line), "{line} is not in {rows}");
    }
    assert_eq!(text("start.csv").lines().nth(1), Some("no-contact,3,1.4,0.5,0,-0.02,0,0,0"));
    assert_eq!(text("sample-times.csv"), "time\n0\n1.5\n3\n");
}
