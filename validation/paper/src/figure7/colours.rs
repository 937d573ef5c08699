//! One pair of colours per attractor, kept from frame to frame.
//!
//! An attractor is followed by carrying its motion along: the frequency is raised in small steps,
//! each starting where the last ended. The attractor that the motion is on in the next frame
//! inherits the colours; where two lead to the same, those of its own kind and period, else those
//! that come first.

use super::frame::{ColourPlace, Frame};
use crate::attractors::start;
use crate::engine::Failure;
use crate::paper::attractors_model;
use percuss::Parameter;
use percuss::dynamics::diagram::{Diagram, Follow};

/// The paper's orange on yellow, for the strange attractor; the others follow.
const STRANGE_PLACE: ColourPlace = 0;

/// Steps of the frequency from frame to frame, and forcing periods in each.
const STEPS: u32 = 200;
const PERIODS: u64 = 400;
/// A motion is on an attractor when its strobes come so near to it on average.
const MAX_STROBE_DISTANCE: f64 = 0.02;

/// Colours of every frame's attractors, in their order.
pub(super) fn through(frames: &[Frame]) -> Result<Vec<Vec<ColourPlace>>, Failure> {
    let mut all: Vec<Vec<ColourPlace>> = Vec::new();
    let mut used = 0;
    for (k, frame) in frames.iter().enumerate() {
        let inherited = match (k.checked_sub(1).map(|last| &frames[last]), all.last()) {
            (Some(last), Some(colours)) => inherited(last, colours, frame)?,
            _ => vec![None; frame.attractors.len()],
        };
        let colours = inherited.into_iter().zip(&frame.attractors).map(|(pair, attractor)| {
            pair.unwrap_or_else(|| match attractor.period {
                None if k == 0 => STRANGE_PLACE,
                _ => {
                    used += 1;
                    STRANGE_PLACE + used
                }
            })
        });
        all.push(colours.collect());
    }
    Ok(all)
}

/// The colours that attractors of a frame have from the one before.
fn inherited(
    last: &Frame,
    colours: &[ColourPlace],
    frame: &Frame,
) -> Result<Vec<Option<ColourPlace>>, Failure> {
    let mut heirs: Vec<Option<(bool, ColourPlace)>> = vec![None; frame.attractors.len()];
    for (attractor, pair) in last.attractors.iter().zip(colours) {
        let Some(first) = attractor.points.first() else { continue };
        let Some(heir) = carried(last.omega, *first, frame)? else { continue };
        let kin = frame.attractors[heir].kind == attractor.kind
            && frame.attractors[heir].period == attractor.period;
        let stronger = heirs[heir].is_none_or(|(known, _)| kin && !known);
        if stronger {
            heirs[heir] = Some((kin, *pair));
        }
    }
    Ok(heirs.into_iter().map(|heir| heir.map(|(_, pair)| pair)).collect())
}

/// The attractor of a frame that a motion carried there is on.
fn carried(from: f64, point: [f64; 3], frame: &Frame) -> Result<Option<usize>, Failure> {
    let diagram = Diagram {
        parameters: attractors_model(from),
        start: start(point),
        parameter: Parameter::Omega,
        from,
        to: frame.omega,
        steps: STEPS,
        transient: PERIODS,
        periods: 48,
        follow: Follow::Carry,
    };
    let steps = diagram.steps(|_| {}).map_err(Failure::new)?;
    let Some(last) = steps.last() else { return Ok(None) };
    let distance = |points: &[[f64; 3]]| {
        let nearest = |it: &[f64; 3]| {
            let apart = points.iter().map(|at| (at[0] - it[0]).hypot(at[1] - it[1]));
            apart.fold(f64::INFINITY, f64::min)
        };
        last.points.iter().map(nearest).sum::<f64>() / last.points.len() as f64
    };
    let near = frame.attractors.iter().enumerate().map(|(id, it)| (id, distance(&it.points)));
    Ok(near
        .filter(|it| it.1 < MAX_STROBE_DISTANCE)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|it| it.0))
}
