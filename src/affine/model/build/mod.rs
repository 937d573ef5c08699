//! From the tables of a file to a system.

mod drift;
mod mode;
mod names;
mod start;

use crate::affine::model::error::SystemError;
use crate::affine::model::file::{GivenParameter, SystemFile};
use crate::affine::model::observable::Observable;
use crate::affine::model::scalar::Scalar;
use crate::affine::model::system::{LARGEST_DIMENSION, MAX_COUNT, Origin, Row, System, TROUBLE};
use crate::affine::model::tangent::Name;
use mode::ModeReader;
use names::Names;
use std::collections::BTreeMap;
use std::sync::Arc;
use toml::Spanned;

impl SystemFile {
    /// The system that the file describes.
    ///
    /// # Errors
    /// Whatever does not make sense, with its place and what is accepted.
    pub fn system(&self) -> Result<System, SystemError> {
        system(self, None).map_err(|error| self.with_replaced(error))
    }

    /// Reads an affine expression of the file's names, as those of its equations; `place` says in
    /// errors where the text is from.
    ///
    /// ```
    /// use percuss::{gallery, system::SystemFile};
    ///
    /// let ball = SystemFile::read("ball", gallery::BOUNCING_BALL)?;
    /// let observable = ball.observable("x - 2*v", "the axis")?;
    /// assert_eq!(observable.value(0.0, &[1.0, 3.0]), -5.0);
    /// let error = ball.observable("x - w", "the axis").unwrap_err();
    /// assert!(error.to_string().starts_with("the axis: w is not known: accepted are x, v"));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// An expression that is not affine, and unknown names with those that are accepted.
    pub fn observable(&self, text: &str, place: &str) -> Result<Observable, SystemError> {
        let mut names = Names::new(self, None)?;
        let forcing = names.forcing()?;
        let form = names.affine(&Scalar::Text(text.to_owned()));
        let form = form.map_err(|what| SystemError::at(place, &what))?;
        let factors: Row = form.0.into_iter().map(|it| it.value).collect();
        let forcing = forcing.map_or([0.0; 2], |it| [it.omega.to_f64(), it.phi.to_f64()]);
        Ok(Observable::new(&factors, forcing))
    }

    /// The system with the derivatives by a name in the place of its coefficients.
    pub(in crate::affine::model) fn derivatives(&self, by: &Name) -> Result<System, SystemError> {
        system(self, Some(by))
    }
}

/// A word for a kind of trouble.
fn trouble(file: &SystemFile, kind: &Spanned<String>) -> Result<String, SystemError> {
    if TROUBLE.contains(&kind.get_ref().as_str()) {
        return Ok(kind.get_ref().clone());
    }
    let what = format!("{:?} is not accepted: any of {}", kind.get_ref(), TROUBLE.join(", "));
    Err(file.error(&kind.span(), &format!("trouble {what}")))
}

fn system(file: &SystemFile, by: Option<&Name>) -> Result<System, SystemError> {
    let mut names = Names::new(file, by)?;
    let forcing = names.forcing()?;
    names.check_lets()?;
    let tables = &file.tables;
    let mut system = System {
        name: file.kebab(&tables.name)?,
        why: tables.why.clone(),
        trouble: tables.trouble.iter().map(|it| trouble(file, it)).collect::<Result<_, _>>()?,
        source: tables.source.clone(),
        parameters: file.parameters.iter().filter_map(parameter).collect(),
        states: names.states.clone(),
        drift: None,
        scales: names.scales()?,
        time_scale: names.time_scale(forcing.as_ref())?,
        forcing,
        modes: Vec::new(),
        start: None,
        start_rows: Vec::new(),
        start_modes: Vec::new(),
        file: Origin(by.is_none().then(|| Arc::new(file.clone()))),
    };
    let dimension = system.dimension();
    if dimension > LARGEST_DIMENSION {
        let what = format!(
            "{} states are too many: with cos, sin (where the system is forced) and 1 appended \
             there are {dimension}, and up to {LARGEST_DIMENSION} are accepted",
            system.states.len()
        );
        return Err(file.error(&tables.states.span(), &what));
    }
    let places = mode_places(file)?;
    let omega = system.forcing.as_ref().map(|it| it.omega.clone());
    let reader = ModeReader { file, places: &places, omega: omega.as_ref() };
    for table in &tables.mode {
        let here = system.modes.len();
        system.modes.push(reader.mode(&mut names, table, here)?);
    }
    if let Some(start) = &file.start {
        system.start_modes = reader.start_modes(&mut names, start)?;
        let (mut point, rows) = start::read(&mut names, start, &places)?;
        // A derivative's start is in no mode of its own.
        if by.is_none() && !system.start_modes.is_empty() {
            point.mode = system.mode_by_conditions(&point)?;
        }
        system.start = Some(point);
        system.start_rows = rows;
    }
    // The derivatives of coefficients say nothing of what depends on what.
    if by.is_none() {
        system.drift = drift::declared_drifts(file, &system)?;
    }
    Ok(system)
}

/// A parameter's name and value.
fn parameter((name, it): (&String, &GivenParameter)) -> Option<(String, f64)> {
    it.value.number().map(|value| (name.clone(), value.to_f64()))
}

/// The index of each mode by its name.
fn mode_places(file: &SystemFile) -> Result<BTreeMap<String, usize>, SystemError> {
    let mut places = BTreeMap::new();
    for (index, mode) in file.tables.mode.iter().enumerate() {
        if places.insert(file.kebab(&mode.name)?, index).is_some() {
            let what = format!("the mode {:?} is there twice", mode.name.get_ref());
            return Err(file.error(&mode.name.span(), &what));
        }
    }
    if places.is_empty() || places.len() > MAX_COUNT {
        let what = format!("{} modes are not accepted: 1 to {MAX_COUNT} are", places.len());
        return Err(file.error(&file.tables.name.span(), &what));
    }
    Ok(places)
}
