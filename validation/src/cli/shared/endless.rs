//! Phases that never end: what is said of them.

use percuss::Endless;

/// What never happens.
pub(in crate::cli) const fn words(endless: Endless) -> &'static str {
    match endless {
        Endless::NeverReturns => "the mass never returns to the slider",
        Endless::NeverStops => "the slider never stops",
        Endless::RestsForEver => "the mass rests on the slider for ever",
    }
}

/// What to say of a run that ends so.
pub(in crate::cli) fn notice(endless: Endless) -> String {
    format!("{}: the run ends at its horizon", words(endless))
}
