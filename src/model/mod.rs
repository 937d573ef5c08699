//! A validated model, how it is started, and the instants and entries of its motion.

pub mod entry;
pub mod instant;
pub mod start;

use crate::error::InputError;
use crate::flow::constants::Constants;
use crate::flow::forcing::EntryAngle;
use crate::flow::steps::Steps;
use crate::model::instant::Instant;
use crate::numeric::angle;
use crate::numeric::two_word::TwoWord;
use crate::parameters::Parameters;

/// Parameters that have been checked, with the constants of the closed forms.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    parameters: Parameters,
    constants: Constants<f64>,
    steps: Steps,
    phi: TwoWord,
}

impl Model {
    /// Checks the parameters and prepares the closed forms.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] names the first parameter outside its range.
    pub fn new(parameters: Parameters) -> Result<Self, InputError> {
        parameters.check()?;
        let (_, phi) = angle::reduce(TwoWord::new(parameters.phi));
        let (constants, steps) = (Constants::new(&parameters), Steps::new(&parameters));
        Ok(Self { parameters, constants, steps, phi })
    }

    /// The time tau of an instant of this model (instants count forcing cycles of its omega),
    /// rounded to one word.
    #[must_use]
    pub fn time(&self, instant: &Instant) -> f64 {
        instant.tau(self.parameters.omega)
    }

    /// The parameters as given.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// One forcing period, 2 pi/omega.
    #[must_use]
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.parameters.omega
    }

    pub(crate) fn constants(&self) -> &Constants<f64> {
        &self.constants
    }

    /// phi within one turn, in two words.
    #[doc(hidden)]
    #[must_use]
    pub const fn phi(&self) -> TwoWord {
        self.phi
    }

    pub(crate) fn steps(&self) -> &Steps {
        &self.steps
    }

    /// Sine and cosine of omega tau + phi.
    pub(crate) fn forcing_angle(&self, instant: &Instant) -> EntryAngle<f64> {
        instant.forcing(self.phi)
    }

    /// The instant a time `elapsed` later, with the forcing angle there.
    #[inline(always)]
    pub(crate) fn instant_after(
        &self,
        instant: &Instant,
        elapsed: TwoWord,
    ) -> (Instant, EntryAngle<f64>) {
        instant.after_with_forcing(elapsed, self.parameters.omega, self.phi)
    }

    /// The external force a cos(omega tau + phi) + b and its first two derivatives.
    #[must_use]
    pub fn force(&self, instant: &Instant) -> [f64; 3] {
        let [harmonic, rate, rate2] = self.harmonic_force(instant);
        [self.parameters.b + harmonic, rate, rate2]
    }

    /// a cos(omega tau + phi) at an instant, with its first two derivatives.
    pub(crate) fn harmonic_force(&self, instant: &Instant) -> [f64; 3] {
        let EntryAngle { sin, cos, .. } = self.forcing_angle(instant);
        let Parameters { a, omega, .. } = self.parameters;
        [a * cos, -(a * omega * sin), -(a * omega * omega * cos)]
    }
}
