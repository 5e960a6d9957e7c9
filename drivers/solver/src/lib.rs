//! Solver library for C: the forces of each contact of a frame as the hardware saw it. `sptfra_solver.h` states the contract.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::{ptr, slice};

use golden::contacts::MOST;
use golden::design::{Calibration, Design, Samples};
use golden::solver::{Solution, Solver as Inner, Status, Workspace};

/// Done.
pub const OK: c_int = 0;
/// A null pointer, or a taxel that is not there.
pub const BAD_ARGUMENT: c_int = -1;
/// No calibration of this version was given.
pub const NO_VERSION: c_int = -2;
/// The library stopped in the middle.
pub const FAILED: c_int = -3;

/// One contact, laid out as in C.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Taxels of the contact.
    pub taxels: u32,
    /// Status bits.
    pub status: u32,
    /// Where the normal force acts, in metres from the first taxel.
    pub centre: [f64; 2],
    /// `[F_x, F_y, F_z]` in newtons.
    pub force: [f64; 3],
    /// `[T_x, T_y, T_z]` in N m about the middle of the grid at the surface.
    pub torque: [f64; 3],
    /// Friction coefficient.
    pub friction: f64,
    /// Standard error of `(F_x, F_y)` in newtons.
    pub standard_error: f64,
}

/// Forces of a frame, laid out as in C.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    /// Status bits.
    pub status: u32,
    /// Contacts that there are.
    pub contacts: u32,
    /// Those of them in [`Forces::contact`].
    pub separated: u32,
    /// `[F_x, F_y, F_z]` of all contacts in newtons.
    pub force: [f64; 3],
    /// `[T_x, T_y, T_z]` in N m about the middle of the grid at the surface.
    pub torque: [f64; 3],
    /// Friction coefficient.
    pub friction: f64,
    /// Direction of the tangential force in rad.
    pub direction: f64,
    /// Friction along x and y.
    pub friction_xy: [f64; 2],
    /// Standard error of `(F_x, F_y)` in newtons.
    pub standard_error: f64,
    /// Each contact, the one with the largest normal force first, then zeros.
    pub contact: [Contact; MOST],
}

impl From<&Solution> for Forces {
    fn from(solution: &Solution) -> Self {
        let mut forces = Self {
            status: solution.status.0,
            contacts: solution.contacts as u32,
            separated: solution.contacts.min(solution.records.len()) as u32,
            force: solution.resultant,
            torque: solution.torque,
            friction: solution.mu,
            direction: solution.phi,
            friction_xy: [solution.mu_x, solution.mu_y],
            standard_error: solution.standard_error,
            contact: [Contact::default(); MOST],
        };
        for (place, found) in forces.contact.iter_mut().zip(&solution.records) {
            *place = Contact {
                taxels: found.taxels as u32,
                status: found.status.0,
                centre: found.centre_m,
                force: found.force,
                torque: found.torque,
                friction: found.mu,
                standard_error: found.standard_error,
            };
        }
        forces
    }
}

/// A design's solver for each version of its calibration, and memory for a frame.
pub struct Solver {
    design: Design,
    versions: BTreeMap<u8, Inner>,
    workspace: Workspace,
    frame: Vec<f64>,
    solution: Solution,
}

impl Solver {
    /// Of a design file.
    ///
    /// # Errors
    /// What is wrong with the file or its sensor, in words.
    pub fn open(path: &Path) -> Result<Self, String> {
        let design = Design::load(path).map_err(|error| error.to_string())?;
        let inner = Inner::new(&design).map_err(|error| error.to_string())?;
        let (workspace, solution) = (inner.workspace(), Solution::zeros(Status::default(), 0));
        Ok(Self { design, versions: BTreeMap::from([(0, inner)]), workspace, frame: Vec::new(), solution })
    }

    /// Number of taxels.
    pub fn taxels(&self) -> usize {
        self.design.sensor.taxels()
    }

    /// Bytes of a frame.
    pub fn frame_bytes(&self) -> usize {
        self.taxels() * self.design.hardware.samples.bits() as usize / 8
    }

    /// Takes gains, offsets and dead taxels for a version; [`BAD_ARGUMENT`] for a dead taxel that is not there.
    pub fn calibrate(&mut self, version: u8, calibration: Calibration, dead: &[usize]) -> c_int {
        if dead.iter().any(|&taxel| taxel >= self.taxels()) || !dead.is_sorted_by(|a, b| a < b) {
            return BAD_ARGUMENT;
        }
        // As in a design, a taxel of gain 0 is a dead one.
        let is_dead = |taxel: &usize| dead.contains(taxel) || calibration.gain[*taxel] == 0.0;
        let dead = (0..self.taxels()).filter(is_dead).collect();
        let mut design = self.design.clone();
        (design.input.calibration, design.input.dead) = (Some(calibration), dead);
        let Ok(inner) = Inner::new(&design) else { return BAD_ARGUMENT };
        self.versions.insert(version, inner);
        OK
    }

    /// Solves a frame of [`Solver::frame_bytes`] bytes in the machine's order; `None` if the version has no calibration.
    pub fn solve(&mut self, version: u8, bytes: &[u8]) -> Option<Forces> {
        let inner = self.versions.get(&version)?;
        self.frame.clear();
        match self.design.hardware.samples {
            Samples::Float32 => {
                self.frame.extend(bytes.as_chunks().0.iter().map(|&sample| f64::from(f32::from_ne_bytes(sample))));
            }
            Samples::Int16 => {
                self.frame.extend(bytes.as_chunks().0.iter().map(|&sample| f64::from(i16::from_ne_bytes(sample))));
            }
            Samples::Uint16 => {
                self.frame.extend(bytes.as_chunks().0.iter().map(|&sample| f64::from(u16::from_ne_bytes(sample))));
            }
        }
        // A frame of another length has no contacts to be asked for.
        inner.solve_into(&mut self.workspace, &self.frame, &mut self.solution).ok()?;
        Some(Forces::from(&self.solution))
    }
}

/// Runs what must not unwind into C.
fn guarded(work: impl FnOnce() -> c_int) -> c_int {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(FAILED)
}

/// Opens a design; null on an error, which `message` states.
///
/// # Safety
/// `design` is a string with a zero at its end, or null; `message` has `room` bytes, or is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sptfra_solver_open(design: *const c_char, message: *mut c_char, room: usize) -> *mut Solver {
    let opened = catch_unwind(|| {
        if design.is_null() {
            return Err("no design was named".to_owned());
        }
        // SAFETY: not null, and the caller's word for the zero at its end.
        let path = unsafe { CStr::from_ptr(design) }.to_str().map_err(|_| "the path is not UTF-8".to_owned())?;
        Solver::open(Path::new(path))
    });
    let why = match opened {
        Ok(Ok(solver)) => return Box::into_raw(Box::new(solver)),
        Ok(Err(why)) => why,
        Err(_) => "the library stopped in the middle".to_owned(),
    };
    if !message.is_null() && room > 0 {
        let length = why.len().min(room - 1);
        // SAFETY: the caller's word for `room` bytes.
        unsafe {
            ptr::copy_nonoverlapping(why.as_ptr().cast::<c_char>(), message, length);
            *message.add(length) = 0;
        }
    }
    ptr::null_mut()
}

/// Closes a solver.
///
/// # Safety
/// `solver` is from [`sptfra_solver_open`] and not closed yet, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sptfra_solver_close(solver: *mut Solver) {
    if !solver.is_null() {
        // SAFETY: made by `Box::into_raw`.
        drop(unsafe { Box::from_raw(solver) });
    }
}

/// Takes the calibration of a version.
///
/// # Safety
/// `solver` is open; `gain` and `offset` have a value for each taxel, `dead` has `dead_count`; or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sptfra_solver_calibrate(
    solver: *mut Solver,
    version: u8,
    gain: *const f64,
    offset: *const f64,
    dead: *const u16,
    dead_count: usize,
) -> c_int {
    // SAFETY: the caller's word that it is open.
    let Some(solver) = (unsafe { solver.as_mut() }) else { return BAD_ARGUMENT };
    if gain.is_null() || offset.is_null() || (dead.is_null() && dead_count > 0) {
        return BAD_ARGUMENT;
    }
    guarded(|| {
        let taxels = solver.taxels();
        // SAFETY: not null, and the caller's word for as many values.
        let [gain, offset] = [gain, offset].map(|of| unsafe { slice::from_raw_parts(of, taxels) }.to_vec());
        let dead: &[u16] =
            // SAFETY: likewise.
            if dead_count == 0 { &[] } else { unsafe { slice::from_raw_parts(dead, dead_count) } };
        solver.calibrate(
            version,
            Calibration { gain, offset },
            &dead.iter().map(|&taxel| taxel.into()).collect::<Vec<_>>(),
        )
    })
}

/// Solves a frame by the calibration of a version.
///
/// # Safety
/// `solver` is open; `frame` has the sensor's samples; `forces` has room for [`Forces`]; or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sptfra_solver_solve(
    solver: *mut Solver,
    version: u8,
    frame: *const c_void,
    forces: *mut Forces,
) -> c_int {
    // SAFETY: the caller's word that it is open, and for the room.
    let (Some(solver), Some(forces)) = (unsafe { (solver.as_mut(), forces.as_mut()) }) else { return BAD_ARGUMENT };
    if frame.is_null() {
        return BAD_ARGUMENT;
    }
    guarded(|| {
        // SAFETY: not null, and the caller's word for as many samples.
        let bytes = unsafe { slice::from_raw_parts(frame.cast::<u8>(), solver.frame_bytes()) };
        let Some(found) = solver.solve(version, bytes) else { return NO_VERSION };
        *forces = found;
        OK
    })
}
