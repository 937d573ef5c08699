//! Guards that are polynomials of the time, of at most the second degree.

use super::circle::root;
use super::touch::Touch;
use crate::affine::model::rational::Rational;

/// Whether a parabola with these derivatives keeps the sign that it has at first.
pub(super) fn keeps_sign(values: &[Rational], rises: bool) -> bool {
    let [value, slope, bend] = outward(values, rises);
    // The parabola is negative at first.
    if bend.is_zero() {
        return slope <= Rational::ZERO;
    }
    let rest = &slope * &slope - Rational::from(2) * &value * &bend;
    bend < Rational::ZERO && (slope <= Rational::ZERO || rest <= Rational::ZERO)
}

/// The touch of a parabola that keeps its sign, if it turns at zero later.
pub(super) fn touch(values: &[Rational], rises: bool) -> Option<Touch> {
    let [value, slope, bend] = outward(values, rises);
    let rest = &slope * &slope - Rational::from(2) * &value * &bend;
    let turns = slope > Rational::ZERO && rest.is_zero();
    turns.then(|| Touch::Once(-slope.to_f64() / bend.to_f64()))
}

/// Value, slope and second derivative, with the sign that makes the parabola negative at first.
fn outward(values: &[Rational], rises: bool) -> [Rational; 3] {
    let sign = Rational::from(if rises { -1 } else { 1 });
    [0, 1, 2].map(|k: usize| values.get(k).map_or(Rational::ZERO, |it| it * &sign))
}

/// The zeros of a polynomial of at most the second degree with these derivatives, if they are
/// rational.
pub(super) fn roots(values: &[Rational]) -> Vec<Rational> {
    let degree = values.iter().rposition(|it| !it.is_zero()).unwrap_or(0);
    match &values[..=degree] {
        [value, slope] => vec![-value / slope],
        [value, slope, bend] => {
            let rest = slope * slope - Rational::from(2) * value * bend;
            let roots = root(&rest).map(|it| [(-slope + &it) / bend, (-slope - &it) / bend]);
            roots.into_iter().flatten().collect()
        }
        _ => Vec::new(),
    }
}
