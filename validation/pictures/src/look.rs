//! The look of an engine: a family of colours a library, a shade and a marker an engine, the same
//! in every picture and on every page.

use super::colour::Colour;
use percuss_engines::engine::Colours;
use percuss_engines::integrators;

/// The colour and marker in which an engine is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// The colour on white.
    pub light: Colour,
    /// The colour on black.
    pub dark: Colour,
    /// The marker of the points.
    pub marker: Marker,
}

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "they are what they are called")]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
    Plus,
    Nabla,
}

const MARKERS: [Marker; 7] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Cross,
    Marker::Plus,
    Marker::Nabla,
];

/// The looks of engines given as (name, library), in their order.
///
/// Shades are given by the place among all engines that the program has, so that a selection of
/// engines looks as the whole does.
#[must_use]
pub fn looks(engines: &[(&str, &str)]) -> Vec<Look> {
    let known: Vec<_> = integrators::all().iter().map(|engine| engine.declaration()).collect();
    let colours_of = |library: &str| {
        let kin = known.iter().find(|it| it.library == library);
        kin.map_or(Colours::OTHERS, |it| it.colours)
    };
    let mut all: Vec<_> = known.iter().map(|it| (it.name, it.colours)).collect();
    let others = engines.iter().filter(|(name, _)| known.iter().all(|it| it.name != *name));
    all.extend(others.map(|(name, library)| (*name, colours_of(library))));
    engines.iter().map(|(name, _)| look(name, &all)).collect()
}

fn look(name: &str, all: &[(&str, Colours)]) -> Look {
    let colours = all.iter().find(|it| it.0 == name).map_or(Colours::OTHERS, |it| it.1);
    let kin: Vec<_> = all.iter().filter(|it| it.1 == colours).collect();
    let place = kin.iter().position(|it| it.0 == name).unwrap_or(0);
    match colours {
        Colours::Ink => ink(place),
        Colours::Hues(from, to) => {
            let share = place as f64 / kin.len().saturating_sub(1).max(1) as f64;
            let hue = from + share * (to - from);
            let lift = if place % 2 == 0 { 0.0 } else { 0.13 };
            Look {
                light: colour(hue, 0.85, 0.34 + lift),
                dark: colour(hue, 0.75, 0.62 + lift),
                marker: MARKERS[place % MARKERS.len()],
            }
        }
    }
}

/// The first is black or white, all others of the family are grey.
fn ink(place: usize) -> Look {
    let (light, dark, marker) = match place {
        0 => (Colour(20, 20, 20), Colour(245, 245, 245), Marker::Circle),
        _ => (Colour(125, 125, 125), Colour(150, 150, 150), Marker::Diamond),
    };
    Look { light, dark, marker }
}

/// Hue in degrees, saturation and lightness from 0 to 1.
fn colour(hue: f64, saturation: f64, lightness: f64) -> Colour {
    let strength = saturation * lightness.min(1.0 - lightness);
    let channel = |offset: f64| {
        let k = (offset + hue / 30.0) % 12.0;
        let value = lightness - strength * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0);
        (255.0 * value).round() as u8
    };
    Colour(channel(0.0), channel(8.0), channel(4.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues() {
        assert_eq!(colour(0.0, 1.0, 0.5), Colour(255, 0, 0));
        assert_eq!(colour(120.0, 1.0, 0.5), Colour(0, 255, 0));
        assert_eq!(colour(240.0, 1.0, 0.25), Colour(0, 0, 128));
    }

    #[test]
    fn a_selection_looks_as_the_whole() {
        let whole: Vec<_> = integrators::all().iter().map(|engine| engine.declaration()).collect();
        let whole: Vec<_> = whole.iter().map(|it| (it.name, it.library)).collect();
        let looks_of_all = looks(&whole);
        for (engine, of_all) in whole.iter().zip(&looks_of_all) {
            assert_eq!(looks(&[*engine])[0], *of_all);
        }
        for (i, look) in looks_of_all.iter().enumerate() {
            assert!(!looks_of_all[..i].contains(look), "{:?}", whole[i]);
        }
    }
}
