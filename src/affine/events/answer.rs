//! The kinds of numbers in which a solver answers.

use super::cause::Cause;
use super::event::Event;
use super::request::Request;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::System;
use std::fmt::Debug;

/// The numbers in which a solver answers: `f64`, for speed; a number of more digits, such as
/// [`Bits212`](crate::Bits212), without bounds of its errors; or [`Proved`](crate::Proved), whose
/// digits are proved.
///
/// ```
/// use percuss::{Bits212, Proved, System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let fast = ball.solver::<f64>()?;
/// let long = ball.solver::<Bits212>()?;
/// let proved = ball.solver::<Proved>()?;
/// assert_eq!(fast.run().events(5)?.count(), long.run().events(5)?.count());
/// assert_eq!(proved.run().events(5)?.count(), 5);
/// # Ok::<(), percuss::SystemError>(())
/// ```
pub trait Answer: sealed::Sealed + Sized {
    /// The number of an answer.
    type Value: Clone + Debug + 'static;

    /// A system prepared for runs.
    #[doc(hidden)]
    type Prepared;

    #[doc(hidden)]
    fn prepare(system: &System, backward: bool) -> Result<Self::Prepared, SystemError>;

    #[doc(hidden)]
    fn system(prepared: &Self::Prepared) -> &System;

    #[doc(hidden)]
    fn is_backward(prepared: &Self::Prepared) -> bool;

    #[doc(hidden)]
    fn begin<'a>(
        prepared: &'a Self::Prepared,
        request: &Request,
    ) -> Result<Box<dyn Running<'a, Self::Value> + Send + 'a>, SystemError>;
}

pub(super) mod sealed {
    pub trait Sealed {}
}

/// A run as an object, so that the solver is not compiled again where runs are asked for.
pub trait Running<'a, V> {
    /// The start, as an event.
    fn start(&self) -> Event<'a, V>;

    /// The next event, sample or ending.
    fn next(&mut self) -> Option<Event<'a, V>>;

    /// Lets a run without samples that has ended at its horizon go on to a later time, and says
    /// whether it does.
    fn go_on(&mut self, _until: f64) -> bool {
        false
    }

    /// The number of choices so far that rounding leaves open.
    fn undecidable(&self) -> u64;

    /// The cause of an ending that was not decided.
    fn cause(&self) -> Option<Cause>;

    /// The bits of the arithmetic that the run is in.
    fn bits(&self) -> u32;
}
