//! What a report is about, in words: whose cases, which systems, their states, and where their
//! truth comes from.

use super::super::{CASES_FLAG, CaseNote, OSCILLATOR, Report, ReportEvidence};

/// The most systems, or cases, that are named instead of counted.
const MAX_NAMES: usize = 6;

/// The texts of the page on the cases as a whole.
pub(super) struct ReportScope {
    /// Whether a case of the paper's oscillator is among them.
    pub oscillator: bool,
    /// Whether a case of another system is among them.
    pub systems: bool,
    /// The sentence that says which integrators are compared with the truth.
    pub lead: String,
    /// A line on the truth at the head of the page, where it is not that of the tables.
    pub replayed: String,
    /// The source of the truth of these cases.
    pub truth: String,
    /// The definition of a state error.
    pub state_error: String,
    /// The definition of a state error, in a few words.
    pub state_error_briefly: String,
}

impl ReportScope {
    pub fn new(report: &Report, evidence: &ReportEvidence) -> Self {
        let notes = &evidence.cases;
        let systems = systems(notes);
        let oscillator = notes.is_empty() || notes.iter().any(|it| it.system == OSCILLATOR);
        let own = evidence.folders.iter().any(|(flag, _)| *flag == CASES_FLAG);
        Self {
            oscillator,
            systems: !systems.is_empty(),
            lead: lead(report, (oscillator, &systems), own),
            replayed: replayed_cases(evidence),
            truth: truth(evidence),
            state_error: state_error(oscillator, &systems),
            state_error_briefly: brief_scope(oscillator, &systems),
        }
    }
}

/// The systems besides the oscillator, each by the first case of it.
fn systems(notes: &[CaseNote]) -> Vec<&CaseNote> {
    let mut systems: Vec<&CaseNote> = Vec::new();
    for note in notes.iter().filter(|it| it.system != OSCILLATOR) {
        if systems.iter().all(|known| known.system != note.system) {
            systems.push(note);
        }
    }
    systems
}

fn lead(report: &Report, (oscillator, systems): (bool, &[&CaseNote]), own: bool) -> String {
    let names: Vec<&str> = systems.iter().map(|it| it.system.as_str()).collect();
    let others = match names[..] {
        [] => None,
        [name] => Some(format!("the system {name}")),
        _ if own && names.len() <= MAX_NAMES => Some(format!("the systems {}", names.join(", "))),
        _ if oscillator && !own => Some("other systems".to_owned()),
        _ => Some(format!("{} piecewise-affine systems", names.len())),
    };
    let first = oscillator.then(|| "a visco-elastic impact oscillator".to_owned());
    let what: Vec<String> = first.into_iter().chain(others).collect();
    let whose = if own { " on cases of your own," } else { "" };
    let (engines, cases) = (report.engines.len(), report.number_of_cases());
    format!(
        "Integrators{whose} of {}, held against the true events: {} on {}.",
        what.join(" and "),
        count_of(engines, "engine"),
        count_of(cases, "case"),
    )
}

fn count_of(count: usize, of: &str) -> String {
    if count == 1 { format!("1 {of}") } else { format!("{count} {of}s") }
}

/// Names, or how many of what they are.
fn names_or_count(names: &[String], what: &str) -> String {
    if names.len() <= MAX_NAMES { names.join(", ") } else { count_of(names.len(), what) }
}

const TABLES: &str = "Tables of events and states with 25 proved digits, made once in ball \
                      arithmetic; no engine knows them.";
const REPLAYED_RUN: &str = "the exact solver's run made again in 106 bits, twice as many as the \
                          numbers that engines return";

fn replayed_cases(evidence: &ReportEvidence) -> String {
    match &evidence.replayed[..] {
        [] => String::new(),
        names if names.len() == evidence.cases.len() => {
            format!("The truth is {REPLAYED_RUN}: there are no tables of these cases.")
        }
        names => format!("The truth of {} is {REPLAYED_RUN}.", names_or_count(names, "case")),
    }
}

fn truth(evidence: &ReportEvidence) -> String {
    if evidence.replayed.is_empty() {
        return TABLES.to_owned();
    }
    let own = "Tables of 25 digits that owe nothing to the solver are made by \
               reference_data/generate_systems.py, and --reference judges by them.";
    let first = if evidence.replayed.len() < evidence.cases.len() { TABLES } else { "" };
    format!("{first} {} {own}", replayed_cases(evidence)).trim_start().to_owned()
}

/// The states of each system, or of the oscillator alone.
fn states(systems: &[&CaseNote]) -> String {
    match systems {
        [only] => names_or_count(&only.states, "state"),
        few if few.len() <= MAX_NAMES => {
            let of =
                |it: &&CaseNote| format!("{}: {}", it.system, names_or_count(&it.states, "state"));
            few.iter().map(of).collect::<Vec<_>>().join("; ")
        }
        _ => "each system's own".to_owned(),
    }
}

fn state_error(oscillator: bool, systems: &[&CaseNote]) -> String {
    let model = "The largest of |dp|, |dy| and |dq| at equal times, on a fixed sample of instants; \
                 the model's displacements and velocities are of order one.";
    let others = format!(
        "The largest |difference| of a state ({}) over its scale at equal times, on a fixed sample \
         of instants; a scale is 1 where the system's file gives none.",
        states(systems)
    );
    match (oscillator, systems) {
        (_, []) => model.to_owned(),
        (false, _) => others,
        (true, _) => format!("Of the oscillator: {model} Of other systems: {others}"),
    }
}

fn brief_scope(oscillator: bool, systems: &[&CaseNote]) -> String {
    match (oscillator, systems) {
        (_, []) => "largest of |dp|, |dy|, |dq|".to_owned(),
        (false, [only]) => format!("largest error of {}", names_or_count(&only.states, "state")),
        _ => "largest error of a state".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn note(system: &str, states: &[&str]) -> CaseNote {
        let states = states.iter().map(|it| (*it).to_owned()).collect();
        CaseNote { system: system.to_owned(), states, ..CaseNote::default() }
    }

    #[test]
    fn systems_are_named_once_with_their_states() {
        let notes = [note("house", &["air", "wall"]), note("house", &["air", "wall"])];
        let of_house = systems(&notes);
        assert_eq!(of_house.len(), 1);
        assert_eq!(brief_scope(false, &of_house), "largest error of air, wall");
        let notes = [note("house", &["air", "wall"]), note("ball", &["x", "v"])];
        assert_eq!(states(&systems(&notes)), "house: air, wall; ball: x, v");
    }

    #[test]
    fn truth_says_which_cases_have_no_tables() {
        let cases = vec![note("house", &["air"]), note("ball", &["x"])];
        let evidence = |replayed: &[&str]| ReportEvidence {
            cases: cases.clone(),
            replayed: replayed.iter().map(|it| (*it).to_owned()).collect(),
            ..ReportEvidence::default()
        };
        assert_eq!(truth(&evidence(&[])), TABLES);
        let some = truth(&evidence(&["a-day"]));
        assert!(some.starts_with(TABLES) && some.contains("The truth of a-day is"), "{some}");
        let all = truth(&evidence(&["a-day", "a-fall"]));
        assert!(!all.contains(TABLES) && all.starts_with("The truth is the exact"), "{all}");
    }
}
