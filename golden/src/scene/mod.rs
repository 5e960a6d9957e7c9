//! Ground truth: frames of normal stress from contacts whose forces are known.
//!
//! The elastic models here are those of a layer or of loads with an extent, not the estimator's own.

mod bessel;
mod bound;
mod choice;
mod field;
mod green;
mod keys;
mod kind;
mod parse;
mod sensor_errors;
mod shape;
mod spectral;
mod surface;
mod traction;
mod transfer;

use std::borrow::Cow;
use std::path::Path;

pub use bound::bound;
pub use choice::ChoiceError;
pub use kind::Kind;
pub(crate) use sensor_errors::stream;
pub use sensor_errors::{Converter, SensorErrors, normal};
pub use shape::Shape;
pub use traction::{Shear, Traction};
pub use transfer::Medium;

use crate::contacts::ContactForces;
use crate::design::{DesignError, Sensor, text_of};
pub(crate) use field::Field;
use spectral::{Resolution, UnitResponses};
pub(crate) use traction::COARSE;

/// What is wrong with a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file, a key or a value.
    #[error(transparent)]
    File(#[from] DesignError),
    /// Depth and distances differ too much.
    #[error(
        "contact {contact}: the taxels reach too far from the contact for a depth of {depth_mm} mm ({waves:.0} wave \
         numbers would be needed along an axis); use a larger depth, a smaller grid, or a centre nearer to it"
    )]
    TooFine {
        /// Which contact, from 1.
        contact: usize,
        /// Depth of the sensor.
        depth_mm: f64,
        /// Wave numbers along one axis.
        waves: f64,
    },
}

/// A contact: normal force, and friction times it along one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Distribution of the load.
    pub shape: Shape,
    /// Centre, in metres from the first taxel.
    pub centre_m: [f64; 2],
    /// Normal force in newtons, positive when pressing.
    pub normal_force_n: f64,
    /// Coefficient of friction: tangential over normal force where the contact slides without turning.
    pub friction: f64,
    /// How the load is spread over the shape, beyond what the shape says.
    pub traction: Traction,
    /// Direction of the tangential force in degrees from x towards y; the directions of a sweep are added to it.
    pub direction_deg: f64,
}

/// Contacts on a sensor, possibly in a sweep of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Geometry of the sensor.
    pub sensor: Sensor,
    /// The layer between surface and taxels.
    pub medium: Medium,
    /// The contacts; their stresses add up.
    pub contacts: Vec<Contact>,
    /// Directions in degrees, one frame each, added to those of all contacts. Without any there is one frame, with
    /// each contact's own direction.
    pub sweep_deg: Vec<f64>,
    /// Errors of the sensor; the true forces stay those of the contacts.
    pub sensor_errors: SensorErrors,
}

/// A frame with its true forces.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFrame {
    /// A few words for tables.
    pub label: String,
    /// Stress in pascals, one value for each taxel.
    pub stress: Vec<f64>,
    /// Resultant force `[F_x, F_y, F_z]` in newtons; `F_z < 0` presses.
    pub force: [f64; 3],
    /// Its torque `[T_x, T_y, T_z]` in N m about the middle of the grid at the surface.
    pub torque: [f64; 3],
    /// Tangential over normal resultant.
    pub friction: f64,
    /// Direction of the tangential resultant in radians, `atan2(F_y, F_x)`.
    pub direction: f64,
    /// What each contact does, the one that presses most first; taxels, status and standard error are 0.
    pub contacts: Vec<ContactForces>,
}

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    ///
    /// [`SceneError::File`], with file and key.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::from_toml(&text_of(path)?, &path.display().to_string())
    }

    /// Checks the text of a scene file; `origin` is the name to use in messages.
    ///
    /// # Errors
    ///
    /// As [`Scene::load`], without the reading.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, SceneError> {
        Ok(parse::scene(text, origin)?)
    }

    /// The standing set of frames for a sensor: a round Hertz contact at its centre on a nearly incompressible bonded
    /// layer, friction 0.5, in 36 directions.
    ///
    /// Radius 7 mm and 6 N where the grid allows, as for the first sensor of the paper. On a smaller grid both shrink
    /// and on a coarser one both grow, at the same pressure, so that the stress stays below 100 kPa.
    pub fn standing(sensor: &Sensor) -> Self {
        const RADIUS_MM: f64 = 7.0;
        const FORCE_N: f64 = 6.0;
        // The share of the short side that 7 mm are on the paper's first sensor.
        const SHARE: f64 = 7.0 / 18.0;
        let [pitch_x, pitch_y] = sensor.pitch_mm;
        let side_x = (sensor.columns - 1) as f64 * pitch_x;
        let side_y = (sensor.rows - 1) as f64 * pitch_y;
        // Even on two rows a contact reaches the taxels on either side of it.
        let pitch = pitch_x.max(pitch_y);
        let limit = (SHARE * side_x.min(side_y)).max(0.75 * pitch);
        let radius = RADIUS_MM.max(pitch).min(limit);
        Self {
            sensor: sensor.clone(),
            medium: Medium::BondedLayer { poisson: 0.49 },
            contacts: vec![Contact {
                shape: Shape::Hertz { semi_axes_m: [radius * 1e-3; 2] },
                centre_m: [0.5e-3 * side_x, 0.5e-3 * side_y],
                normal_force_n: FORCE_N * (radius / RADIUS_MM).powi(2),
                friction: 0.5,
                traction: Traction::default(),
                direction_deg: 0.0,
            }],
            sweep_deg: (0..36).map(|step| f64::from(step) * 10.0).collect(),
            sensor_errors: SensorErrors::default(),
        }
    }

    /// Computes the frames.
    ///
    /// The stress of each contact is computed once for each kind of load and then combined for each direction.
    ///
    /// # Errors
    ///
    /// [`SceneError::TooFine`] when a depth is tiny compared with the size of the grid or of a contact.
    pub fn frames(&self) -> Result<Vec<SceneFrame>, SceneError> {
        let scene = self.as_built();
        let points = scene.contacts.iter().any(|contact| scene.needs_points(contact)).then(|| Field::of(&scene));
        let responses = scene
            .contacts
            .iter()
            .enumerate()
            .map(|(index, contact)| match &points {
                Some(field) if scene.needs_points(contact) => Ok(Stress::Points(field)),
                _ => scene.unit_responses(index, contact).map(Stress::Unit),
            })
            .collect::<Result<Vec<_>, _>>()?;
        let directions = match self.sweep_deg.as_slice() {
            [] => vec![None],
            sweep => sweep.iter().copied().map(Some).collect(),
        };
        let mut frames: Vec<_> = directions.into_iter().map(|direction| scene.combine(&responses, direction)).collect();
        for (index, frame) in frames.iter_mut().enumerate() {
            self.sensor_errors.apply(index, &mut frame.stress);
        }
        Ok(frames)
    }

    /// The scene with the depth that the layer really has.
    fn as_built(&self) -> Cow<'_, Self> {
        if self.sensor_errors.depth.to_bits() == 0 {
            return Cow::Borrowed(self);
        }
        let mut scene = self.clone();
        scene.sensor.depth_mm *= 1.0 + self.sensor_errors.depth;
        Cow::Owned(scene)
    }

    /// Whether a contact is more than a shape that slides over taxels that are points.
    fn needs_points(&self, contact: &Contact) -> bool {
        self.sensor_errors.taxel_m.is_some() || contact.traction != Traction::default()
    }

    fn unit_responses(&self, index: usize, contact: &Contact) -> Result<UnitResponses, SceneError> {
        let sensor = &self.sensor;
        let depth = sensor.depth_m();
        if self.medium == Medium::HalfSpace {
            let stress = |taxel| {
                let position = sensor.position_m(taxel);
                contact.shape.half_space([0, 1].map(|axis| position[axis] - contact.centre_m[axis]), depth)
            };
            let stresses: Option<Vec<_>> = (0..sensor.taxels()).map(stress).collect();
            if let Some(stresses) = stresses {
                return Ok([0, 1, 2].map(|load| stresses.iter().map(|stress| stress[load]).collect()));
            }
        }
        spectral_responses(sensor, self.medium, (index, contact), Resolution::fine(self.medium))
    }

    fn combine(&self, responses: &[Stress<'_>], sweep_deg: Option<f64>) -> SceneFrame {
        let mut stress = vec![0.0; self.sensor.taxels()];
        let mut force = [0.0; 3];
        let mut torque = [0.0; 3];
        let mut contacts = Vec::with_capacity(self.contacts.len());
        for (contact, response) in self.contacts.iter().zip(responses) {
            let angle = contact.direction_deg + sweep_deg.unwrap_or(0.0);
            let [normal, along_x, along_y] = match response {
                Stress::Unit(responses) => responses,
                Stress::Points(field) => {
                    let exerted = field.add(contact, angle, &mut stress);
                    for (sums, parts) in [&mut force, &mut torque].into_iter().zip(exerted) {
                        sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
                    }
                    contacts.push(self.forces_of(exerted));
                    continue;
                }
            };
            let pressing = contact.normal_force_n;
            let tangential = contact.friction * pressing;
            let (fx, fy) = (tangential * cos_degrees(angle), tangential * cos_degrees(angle - 90.0));
            for (taxel, sum) in stress.iter_mut().enumerate() {
                *sum += pressing * normal[taxel] + fx * along_x[taxel] + fy * along_y[taxel];
            }
            // Spread as its shape says, which is its own mirror image in x and in y, the load acts at its centre.
            let own = [fx, fy, -pressing];
            let own_torque = self.sensor.torque_of(contact.centre_m, own);
            contacts.push(self.forces_of([own, own_torque]));
            let own = own.into_iter().zip(own_torque);
            for ((sum, moment), (part, arm)) in force.iter_mut().zip(&mut torque).zip(own) {
                (*sum, *moment) = (*sum + part, *moment + arm);
            }
        }
        ContactForces::largest_first(&mut contacts);
        SceneFrame {
            label: match sweep_deg {
                Some(angle) => format!("direction {angle} deg"),
                None => "one frame".to_owned(),
            },
            stress,
            force,
            torque,
            friction: force[0].hypot(force[1]) / force[2].abs(),
            direction: force[1].atan2(force[0]),
            contacts,
        }
    }

    /// What a contact of this force and torque does.
    fn forces_of(&self, [force, torque]: [[f64; 3]; 2]) -> ContactForces {
        let [x, y, z] = force;
        ContactForces {
            centre_m: ContactForces::centre_of(&self.sensor, force, torque),
            force,
            torque,
            mu: x.hypot(y) / z.abs(),
            ..ContactForces::default()
        }
    }
}

/// The stress of one contact.
enum Stress<'a> {
    /// For each kind of load of 1 N.
    Unit(UnitResponses),
    /// Summed over points of the contact, anew for each direction.
    Points(&'a Field),
}

/// Responses of all taxels to 1 N pressing, along x and along y, for one contact; good to about 1e-4 of the peak and
/// many times faster than [`Scene::frames`].
///
/// # Errors
///
/// [`SceneError::TooFine`], as [`Scene::frames`].
pub(crate) fn unit_responses(sensor: &Sensor, medium: Medium, contact: &Contact) -> Result<UnitResponses, SceneError> {
    spectral_responses(sensor, medium, (0, contact), Resolution::COARSE)
}

/// Responses of all taxels to a unit contact and its number, by the spectrum of its load.
fn spectral_responses(
    sensor: &Sensor,
    medium: Medium,
    (index, contact): (usize, &Contact),
    resolution: Resolution,
) -> Result<UnitResponses, SceneError> {
    let offsets = [
        (0..sensor.columns).map(|ix| sensor.position_m(ix)[0] - contact.centre_m[0]).collect(),
        (0..sensor.rows).map(|iy| sensor.position_m(iy * sensor.columns)[1] - contact.centre_m[1]).collect(),
    ];
    spectral::responses(medium, contact.shape, sensor.depth_m(), &offsets, resolution)
        .map_err(|waves| SceneError::TooFine { contact: index + 1, depth_mm: sensor.depth_mm, waves })
}

/// Cosine of an angle in degrees; exact where the cosine is 0 or 1, so that a push along an axis has no trace of the
/// other axis.
fn cos_degrees(degrees: f64) -> f64 {
    if degrees.rem_euclid(180.0).to_bits() == 90_f64.to_bits() {
        return 0.0;
    }
    degrees.rem_euclid(360.0).to_radians().cos()
}
