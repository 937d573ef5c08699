//! A SYSTEM's motions from return to return, as the verbs and the Python package ask for them.

mod counted;

pub use counted::{
    CountedReturns, EventReturns, MAX_RETURNS, ReturnCount, Strobes, Uncounted, WantedReturns,
};

use percuss::affine::{Exponents, NoOrbit, NoReturn, Place, SectionMap, SystemError};

/// The most returns of the transient in which the directions of small changes are found.
const MAX_SETTLING_RETURNS: u64 = 200;

/// The exponents of the motion from a system's start, or why it does not return as often and how
/// often it does. `told` hears of the number of returns that are passed.
///
/// # Errors
/// A system that does not start.
pub fn exponents(
    map: &SectionMap<'_, f64>,
    transient: u64,
    returns: u64,
    told: &mut dyn FnMut(u64),
) -> Result<Result<Exponents, (NoReturn, u64)>, SystemError> {
    let settling = transient.min(MAX_SETTLING_RETURNS);
    let mut before = map.returns(map.system().start()?)?;
    let mut passed = 0;
    // One more, because the run begins at a return.
    for point in before.by_ref().take((transient - settling) as usize + 1) {
        if let Err(why) = point {
            return Ok(Err((why, passed)));
        }
        passed += 1;
        told(passed);
    }
    let begun = passed;
    let found = before.place().and_then(|place| {
        map.exponents(&place, settling, returns, &mut |count| {
            passed = begun + count;
            told(passed);
        })
    });
    Ok(found.map_err(|why| (why, passed)))
}

/// The guess of an orbit, or why there is none.
pub type Guess = Result<Place<f64>, NoOrbit>;

/// The return after the transient from a system's start, and the choices that rounding leaves open
/// on the way there.
///
/// # Errors
/// A system that does not start.
pub fn guess(
    map: &SectionMap<'_, f64>,
    transient: u64,
    seen: impl Fn(),
) -> Result<(Guess, u64), SystemError> {
    let mut returns = map.returns(map.system().start()?)?;
    let wanted = returns.by_ref().take(transient as usize + 1).inspect(|_| seen());
    if let Some(why) = wanted.filter_map(Result::err).last() {
        return Ok((Err(NoOrbit::NoReturn(why)), 0));
    }
    let guess = returns.place().map_err(NoOrbit::NoReturn);
    Ok((guess, returns.undecidable()))
}
