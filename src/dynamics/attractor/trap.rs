//! Neighbourhoods of a stable orbit that nothing leaves, and how far in them a motion is.

use super::coordinates::Coordinates;
use super::thresholds::REST_TOLERANCE;

/// An ellipsoid about one point of an orbit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "C::Spot: serde::Serialize, C::Piece: serde::Serialize",
        deserialize = "C::Spot: serde::Deserialize<'de>, C::Piece: serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Trap<C: Coordinates> {
    pub centre: C::Spot,
    /// The piece of the section on which all of the trap lies.
    pub piece: C::Piece,
    /// The metric, which is not below the identity, row by row.
    pub metric: Vec<f64>,
    pub radius: f64,
    /// The distance, by the metric, within which a motion is at rest for all that rounding does.
    pub rest: f64,
    /// The ways on which the net of the trap has come back; none where ways are not told apart.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub ways: Vec<u64>,
}

impl<C: Coordinates> Trap<C> {
    /// Whether a motion has come to a spot on a way of the net: on another one it may be led to
    /// another orbit.
    pub fn is_on_way(&self, coordinates: &C, spot: &C::Spot) -> bool {
        let is_known = |way| self.ways.is_empty() || self.ways.contains(&way);
        coordinates.way(spot).is_none_or(is_known)
    }

    /// The square of the distance in units of the radius: at most 1 inside.
    pub fn size(&self, coordinates: &C, spot: &C::Spot) -> f64 {
        if !coordinates.lies_on(&self.piece, spot) {
            return f64::INFINITY;
        }
        let step = coordinates.step(&self.centre, spot);
        // The metric is not below the identity.
        let is_outside = step.as_ref().iter().any(|it| it.abs() > self.radius);
        if is_outside { f64::INFINITY } else { self.length(step.as_ref()) }
    }

    /// Whether a motion at this [`Self::size`] is at rest on the orbit: it need not come closer
    /// still, or cannot for rounding.
    pub fn is_at_rest(&self, size: f64) -> bool {
        size < REST_TOLERANCE || size.sqrt() * self.radius <= self.rest
    }

    /// The square of the distance in units of the radius, outside too.
    pub fn distance(&self, coordinates: &C, spot: &C::Spot) -> f64 {
        match coordinates.lies_on(&self.piece, spot) {
            true => self.length(coordinates.step(&self.centre, spot).as_ref()),
            false => f64::INFINITY,
        }
    }

    /// x' metric x of a step x in units of the radius.
    fn length(&self, step: &[f64]) -> f64 {
        let scaled = || step.iter().map(|it| it / self.radius);
        let rows = self.metric.chunks_exact(self.metric.len().isqrt());
        let images = rows.map(|row| row.iter().zip(scaled()).map(|(m, x)| m * x).sum::<f64>());
        scaled().zip(images).map(|(x, image)| x * image).sum()
    }
}
