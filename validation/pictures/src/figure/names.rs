//! Names beside marks, none of which hides another name or mark.

use super::super::canvas::{At, Canvas, Stroke, TextSide};
use super::super::colour::WHITE;
use super::super::frame::Panel;
use super::super::{Colour, font};

const TEXT_SIZE: f64 = 18.0;
/// Half the width of a mark.
const HALF_MARK: f64 = 4.5;
/// Half the height of a name.
const HALF_HEIGHT: f64 = 9.0;
/// The distance of a name from its mark, across and up.
const DISTANCE: At = (10.0, 16.0);
/// The height of a line, by which a name is moved on where there is no room.
const LINE_HEIGHT: f64 = 20.0;
/// The lines on either side of a mark on which a name is tried.
const MAX_LINES: u32 = 8;

/// A rectangle: its least and its largest corner.
#[derive(Clone, Copy)]
struct Rectangle(At, At);

impl Rectangle {
    fn overlaps(&self, other: &Self) -> bool {
        let apart = |a: f64, b: f64| a >= b;
        !(apart(self.0.0, other.1.0)
            || apart(other.0.0, self.1.0)
            || apart(self.0.1, other.1.1)
            || apart(other.0.1, self.1.1))
    }

    fn is_within(&self, panel: &Panel) -> bool {
        self.0.0 >= panel.from.0
            && self.1.0 <= panel.to.0
            && self.0.1 >= panel.from.1
            && self.1.1 <= panel.to.1
    }
}

/// A mark at a place with its name.
pub(super) struct NamedMark<'a> {
    pub(super) at: At,
    pub(super) name: &'a str,
    pub(super) colour: Colour,
}

/// The place of a name: its left end, half way up.
#[derive(Clone, Copy)]
pub(super) struct NamePlace {
    at: At,
    /// Whether it is so far from its mark that a line leads there.
    is_far: bool,
}

impl NamedMark<'_> {
    fn mark(&self) -> Rectangle {
        let (x, y) = self.at;
        Rectangle((x - HALF_MARK, y - HALF_MARK), (x + HALF_MARK, y + HALF_MARK))
    }

    fn box_at(&self, (left, middle): At) -> Rectangle {
        let right = left + font::width(self.name, TEXT_SIZE);
        Rectangle((left - 2.0, middle - HALF_HEIGHT), (right + 2.0, middle + HALF_HEIGHT))
    }

    /// The places to try, the best first: beside the mark and above it, on the side with the room.
    fn candidates(&self, panel: &Panel) -> Vec<NamePlace> {
        let ((x, y), width) = (self.at, font::width(self.name, TEXT_SIZE));
        let (right, left) = (x + DISTANCE.0, x - DISTANCE.0 - width);
        let sides = if right + width > panel.to.0 { [left, right] } else { [right, left] };
        let mut all = Vec::new();
        for line in 0..MAX_LINES {
            let up = DISTANCE.1 + LINE_HEIGHT * f64::from(line);
            for middle in [y - up, y + up] {
                all.extend(sides.map(|left| NamePlace { at: (left, middle), is_far: line > 0 }));
            }
        }
        all
    }

    /// Draws the mark, and its name on white.
    pub(super) fn draw(&self, canvas: &mut Canvas, place: NamePlace) {
        let Rectangle(from, to) = self.mark();
        canvas.fill(from, to, self.colour);
        let Rectangle(from, to) = self.box_at(place.at);
        if !self.name.is_empty() {
            if place.is_far {
                let beside = if from.0 > self.at.0 { from.0 } else { to.0 };
                canvas.trace(&[self.at, (beside, place.at.1)], 1.0, Stroke::Solid, self.colour);
            }
            canvas.fill(from, to, WHITE);
        }
        canvas.text(self.name, place.at, TEXT_SIZE, TextSide::Left, self.colour);
    }
}

/// The places of all names, in their order: each the first that hides nothing, if there is one.
pub(super) fn places(all: &[NamedMark<'_>], panel: &Panel) -> Vec<NamePlace> {
    let marks: Vec<Rectangle> = all.iter().map(NamedMark::mark).collect();
    let mut taken: Vec<Rectangle> = Vec::new();
    let mut places = Vec::with_capacity(all.len());
    for named in all {
        let candidates = named.candidates(panel);
        let is_free = |it: &&NamePlace| {
            let own = named.box_at(it.at);
            own.is_within(panel) && !marks.iter().chain(&taken).any(|other| own.overlaps(other))
        };
        let place = *candidates.iter().find(is_free).unwrap_or(&candidates[0]);
        if !named.name.is_empty() {
            taken.push(named.box_at(place.at));
        }
        places.push(place);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::super::frame::Ruler;
    use super::*;

    fn panel() -> Panel {
        let ruler = || Ruler::between(0.0, 1.0);
        Panel { from: (100.0, 50.0), to: (700.0, 500.0), x: ruler(), y: ruler() }
    }

    fn named(at: At) -> NamedMark<'static> {
        NamedMark { at, name: "grazing impact@free", colour: WHITE }
    }

    /// Marks at one place, near the edges, and in a row closer than a name is wide.
    #[test]
    fn no_name_hides_another_name_or_a_mark() {
        let panel = panel();
        for marks in [
            vec![(300.0, 200.0); 8],
            vec![(690.0, 60.0), (685.0, 62.0), (110.0, 490.0), (105.0, 495.0)],
            (0..12).map(|n| (120.0 + 40.0 * f64::from(n), 300.0)).collect(),
        ] {
            let all: Vec<_> = marks.iter().map(|at| named(*at)).collect();
            let boxes: Vec<_> = places(&all, &panel)
                .iter()
                .zip(&all)
                .map(|(place, named)| named.box_at(place.at))
                .collect();
            for (n, own) in boxes.iter().enumerate() {
                assert!(own.is_within(&panel), "{marks:?}: {n}");
                assert!(!boxes[n + 1..].iter().any(|it| own.overlaps(it)), "{marks:?}: {n}");
                assert!(!all.iter().any(|it| own.overlaps(&it.mark())), "{marks:?}: {n}");
            }
        }
    }

    /// A mark alone has its name to the right of it and above, and near the right edge to the left.
    #[test]
    fn a_name_alone_stands_beside_its_mark() {
        let panel = panel();
        let left = |at: At| places(&[named(at)], &panel)[0];
        assert_eq!(left((300.0, 200.0)).at, (310.0, 184.0));
        assert!(left((690.0, 200.0)).at.0 < 600.0);
        assert!(!left((690.0, 200.0)).is_far);
    }
}
