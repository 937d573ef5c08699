//! Fig. 7: basins of attraction at six forcing frequencies, and which attractors there are.

mod colours;
mod frame;

use super::Item;
use super::attractors::{described, found};
use super::claim::{Claim, ClaimVerdict};
use super::item_work::{Findings, ItemWork, Size};
use super::paper::{Printed, attractors_model};
use crate::engine::Failure;
use crate::picture::{Figure, caption, caption_without};
use frame::Frame;
use percuss::Parameter;
use percuss::dynamics::attractor::AttractorKind;

/// Cells along a side.
const CELLS: u32 = 300;
const FULL_CELLS: u32 = 1000;

/// A frame's letter, its frequency, and the claim about what coexists there.
const FRAMES: [(&str, f64, &str); 6] = [
    ("a", 1.4, "census-1.4"),
    ("b", 1.45, "census-1.45"),
    ("c", 1.56, "census-1.56"),
    ("d", 1.58, "census-1.58"),
    ("e", 1.60, "census-1.60"),
    ("f", 1.70, "census-1.70"),
];

pub(super) const ITEM: Item = Item {
    id: "figure-7",
    claims: &[
        "fig7a-f",
        "fig7a",
        "fig7b",
        "fig7c",
        "fig7d",
        "fig7e",
        "fig7f",
        "census-1.4",
        "census-1.45",
        "census-1.56",
        "census-1.58",
        "census-1.60",
        "census-1.70",
    ],
    // Ten a frame.
    parts: 60,
    kept: &["figure-7a", "figure-7b", "figure-7c", "figure-7d", "figure-7e", "figure-7f"],
    run,
};

fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let cells = match work.size {
        Size::Default => CELLS,
        Size::Full => FULL_CELLS,
    };
    let frames = FRAMES.map(|(letter, omega, _)| Frame::kept(work, letter, omega, cells));
    let frames: Vec<Frame> = frames.into_iter().collect::<Result<_, _>>()?;
    let colours = colours::through(&frames)?;
    let mut findings = Findings::default();
    let mut all_agree = true;
    for ((frame, colours), (letter, _, census)) in frames.iter().zip(&colours).zip(FRAMES) {
        let claims = settle(work, frame, &format!("fig7{letter}"), census)?;
        all_agree &= claims[0].verdict == ClaimVerdict::Reproduced;
        findings.claims.extend(claims);
        let figure = drawing(letter, Some(frame.omega), vec![frame.plot("", colours)], cells, 1);
        findings.picture(&format!("figure-7{letter}"), &figure)?;
        findings.files.push((format!("figure-7{letter}.npz"), frame.npz()?));
    }
    let plots = frames.iter().zip(&colours).zip(FRAMES).map(|((frame, colours), (letter, ..))| {
        frame.plot(&format!("({letter}) \u{3c9} = {}", frame.omega), colours)
    });
    findings.picture("figure-7", &drawing("", None, plots.collect(), cells, 3))?;
    let said: Vec<_> = frames
        .iter()
        .map(|frame| format!("omega = {}: {}", frame.omega, frame.attractors.len()))
        .collect();
    findings.claims.push(
        Claim::settle(
            &work.paper,
            "fig7a-f",
            ClaimVerdict::new(all_agree),
            format!("number of attractors at {}", said.join(", ")),
        )?
        .note(format!(
            "{cells} x {cells} starts a frame, p from -3 to 1.2, y from -1.5 to 1.5 at omega tau = 0, q = 0 where p < g and on the \
             contact surface elsewhere: the paper prints neither window nor q"
        ))
        .evidence("claims fig7a to fig7f and the censuses", "each with its own evidence"),
    );
    Ok(findings)
}

/// Settles the claims on the number and the kinds of a frame's attractors.
fn settle(
    work: &ItemWork<'_>,
    frame: &Frame,
    figure: &str,
    census: &str,
) -> Result<[Claim; 2], Failure> {
    let shares = frame.attractors.iter().map(|it| format!("{}: {}", it.said, it.share));
    let shares = shares.collect::<Vec<_>>().join("; ");
    let printed = work.paper.claim(figure)?;
    let count = frame.attractors.len();
    let computed = format!("{count} attractors; unresolved {}", frame.unresolved);
    let first = Claim::settle(
        &work.paper,
        figure,
        ClaimVerdict::new(printed.attractors == Some(count)),
        computed,
    )?
    .evidence("shares of the starts", shares.as_str());
    let printed = work.paper.claim(census)?;
    let again = found(frame.omega)?;
    let coarse: Vec<_> = again.iter().map(described).collect();
    let mut second = Claim::settle(
        &work.paper,
        census,
        ClaimVerdict::new(agrees(frame, printed)),
        frame.attractors.iter().map(|it| it.said.clone()).collect::<Vec<_>>().join("; "),
    )?
    .evidence("every start of the frame followed; orbits by Newton with multipliers, chaos by a positive exponent", shares)
    .evidence("a coarser grid of starts", coarse.join("; "));
    if !agrees(frame, printed) {
        second = second.note(difference(frame, printed));
    }
    for (method, finding) in frame.integrated(&again)? {
        second = second.evidence(method, finding);
    }
    Ok([first, second])
}

/// Periods and number of chaotic attractors.
fn census(frame: &Frame) -> (Vec<u32>, usize) {
    let mut periods: Vec<_> = frame.attractors.iter().filter_map(|it| it.period).collect();
    periods.sort_unstable();
    let chaotic =
        frame.attractors.iter().filter(|it| it.kind == AttractorKind::Chaotic.as_str()).count();
    (periods, chaotic)
}

/// Whether they are those that the paper names.
fn agrees(frame: &Frame, printed: &Printed) -> bool {
    let (periods, chaotic) = census(frame);
    periods == printed.periods && printed.chaotic == Some(chaotic)
}

/// Says in what a frame and the printed one differ.
fn difference(frame: &Frame, printed: &Printed) -> String {
    let said = |periods: &[u32], chaotic: usize| {
        let periods: Vec<_> = periods.iter().map(u32::to_string).collect();
        format!("{chaotic} chaotic and the periods {}", periods.join(", "))
    };
    let (periods, chaotic) = census(frame);
    let papers = said(&printed.periods, printed.chaotic.unwrap_or(0));
    format!("here {}, in the paper {papers}", said(&periods, chaotic))
}

fn drawing(
    letter: &str,
    omega: Option<f64>,
    plots: Vec<crate::picture::Plot>,
    cells: u32,
    columns: usize,
) -> Figure {
    let parameters = match omega {
        Some(omega) => caption(&attractors_model(omega)),
        None => caption_without(&attractors_model(1.0), Some(Parameter::Omega)),
    };
    Figure {
        title: format!("Fig. 7{letter}: basins of attraction"),
        caption: format!(
            "{parameters}; {cells} x {cells} starts at \u{3c9}\u{3c4} = 0, q = 0 where p < g and on the contact surface elsewhere \
             (assumed, as is the window). Attractors as dots on their basins, one pair of colours an attractor kept through the frames; \
             grey: unresolved."
        ),
        columns,
        panel: (760, 560),
        plots,
    }
}
