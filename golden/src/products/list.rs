//! Lists of products, and the passes that make one of another. Every pass keeps what the list computes.

use super::step::{Coefficients, Epilogue, Step, Vector};
use crate::names::{MatrixName, ReducedName};

/// What a matrix of a list is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// One of the paper's thirteen, which its filters are for.
    Thirteen(MatrixName),
    /// One of the ten of [`crate::reduced`].
    Ten(ReducedName),
    /// One and the friction components of the frame.
    Friction,
}

/// A matrix as a list multiplies with it: `sign M`, or `sign (I + M)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// M.
    pub source: Source,
    /// 1 or -1.
    pub sign: f64,
    /// Whether ones stand on the diagonal, besides M.
    pub with_identity: bool,
}

impl Form {
    fn of(source: Source, sign: f64) -> Self {
        Self { source, sign, with_identity: false }
    }

    /// How reports write it, for instance `-(I + D30)`.
    pub fn label(&self) -> String {
        let name = match self.source {
            Source::Thirteen(name) => name.to_string(),
            Source::Ten(name) => name.to_string(),
            Source::Friction => "1, mu_x, mu_y".to_owned(),
        };
        let sign = if self.sign < 0.0 { "-" } else { "" };
        if self.with_identity { format!("{sign}(I + {name})") } else { format!("{sign}{name}") }
    }

    /// Its mirror symmetry, see [`crate::parity::FoldedMatrix`].
    pub fn parity(&self) -> usize {
        match self.source {
            Source::Thirteen(name) => name.parity(),
            Source::Ten(name) => name.parity(),
            Source::Friction => 0,
        }
    }
}

/// Products in the order in which a frame needs them, and their matrices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProductList {
    /// The matrices, each once.
    pub matrices: Vec<Form>,
    /// The products.
    pub steps: Vec<Step>,
}

/// How the twelve products of Co follow each other. `A_p b` come first: they need nothing but the stress, so that there
/// is work while the weights are not complete. `g_3q` come next: what follows needs them first.
fn co_order() -> impl Iterator<Item = MatrixName> {
    let [_, a1, a2, a3, others @ .., d30, d31, d32] = MatrixName::ALL;
    [a1, a2, a3, d30, d31, d32].into_iter().chain(others)
}

impl ProductList {
    /// The paper's list: thirteen products, then `u_q = C33 g_3q` (Pinto-Salamanca et al., Sensors 2024, Eqs. 9 to 16).
    ///
    /// Since `w = -|w|`, `D_p0` is negated, and the terms `|w|` and `w` of Eqs. 11 to 13 are ones on the diagonal.
    pub fn paper() -> Self {
        let mut list = Self::default();
        let weights = Form::of(Source::Thirteen(MatrixName::C33inv), 1.0);
        list.push(weights, &[Vector::Stress], Epilogue::ClipNegate, Vector::Weight);
        for name in co_order() {
            let source = Source::Thirteen(name);
            match name.product() {
                None => {
                    // A1, A2, A3 follow C33inv.
                    let p = name.index() as u8;
                    list.push(Form::of(source, 1.0), &[Vector::Stress], Epilogue::Keep, Vector::Partial(p));
                }
                Some((p, q)) => {
                    let form = Form {
                        source,
                        sign: if q == 0 { -1.0 } else { 1.0 },
                        with_identity: matches!((p, q), (3, 0) | (1, 1) | (2, 2)),
                    };
                    let (p, q) = (p as u8, q as u8);
                    let epilogue = if q == 0 { Epilogue::Add(Vector::Partial(p)) } else { Epilogue::Keep };
                    list.push(form, &[Vector::Weight], epilogue, Vector::G(p, q));
                }
            }
        }
        let c33 = list.store(Form::of(Source::Ten(ReducedName::C33), 1.0));
        for q in 0..3 {
            list.multiply(c33, &[Vector::G(3, q)], Epilogue::Keep, Vector::U(q));
        }
        list
    }

    /// The first pass: the same forces from ten products, four of which the search waits for.
    ///
    /// ```text
    /// u0 = b - K0 y+    u1 = -K1 |w|    u2 = -K2 |w|      K0 = (I - E) C33    K1 = E C31    K2 = E C32    E = C33 A3
    /// r = C33 y+ - mu_x C31 |w| - mu_y C32 |w|            f_p = A_p r + [mu_x |w|, mu_y |w|, -|w|]
    /// ```
    ///
    /// The sums `G_pq` are dot products, which ride in front of `K0 y+`. Without a `field` the list ends with `u`.
    #[must_use]
    pub fn fewer_products(&self, field: bool) -> Self {
        use Vector::{Explained, Force, Pull, Residual, Stress, U, Weight};
        let mut list = Self::default();
        let form = |name, sign| Form::of(Source::Ten(name), sign);
        list.push(form(ReducedName::C33inv, 1.0), &[Stress], Epilogue::Part, Weight);
        list.push(form(ReducedName::K1, -1.0), &[Weight], Epilogue::Unfold, U(1));
        list.push(form(ReducedName::K0, -1.0), &[Pull, Weight], Epilogue::AddStress, U(0));
        list.push(form(ReducedName::K2, -1.0), &[Weight], Epilogue::Unfold, U(2));
        for step in &mut list.steps {
            step.sums = step.result == U(0);
        }
        if field {
            list.push(form(ReducedName::C33, 1.0), &[Pull], Epilogue::Store, Residual(0));
            list.push(form(ReducedName::C31, -1.0), &[Weight], Epilogue::Store, Residual(1));
            list.push(form(ReducedName::C32, -1.0), &[Weight], Epilogue::Store, Residual(2));
            let parts = [Residual(0), Residual(1), Residual(2)];
            list.push(Form::of(Source::Friction, 1.0), &parts, Epilogue::Store, Explained);
            for (p, name) in [ReducedName::A1, ReducedName::A2, ReducedName::A3].into_iter().enumerate() {
                list.push(form(name, 1.0), &[Explained], Epilogue::Unfold, Force(1 + p as u8));
            }
        }
        list
    }

    /// The parity fold: vectors by orbit and component, matrices of a quarter of the size, see [`crate::parity`]. For a
    /// list with forces and sums of its own, as fewer products have them.
    #[must_use]
    pub fn folded(mut self) -> Self {
        for step in &mut self.steps {
            step.parity = self.matrices[step.matrix].parity();
        }
        self
    }

    /// The diagonal mirror, for a folded list of a sensor that is square in sides and pitch, of `side` by `side`
    /// orbits: K2, C32 and A2 are K1, C31 and A1 mirrored, and only those are stored.
    #[must_use]
    pub fn mirrored(self, side: usize) -> Self {
        let mut list = Self::default();
        for mut step in self.steps {
            let form = self.matrices[step.matrix];
            let image = mirror_image(form);
            step.matrix = list.store(image);
            if image != form {
                (step.mirrored, step.parity) = (Some(side), image.parity());
            }
            list.steps.push(step);
        }
        list
    }

    /// Whether forces are products, and not yet to be put together from the coefficients `g_pq`.
    pub fn has_forces(&self) -> bool {
        self.steps.iter().any(|step| matches!(step.result, Vector::Force(_)))
    }

    /// Number of products before the first that needs the friction.
    pub fn before_friction(&self) -> usize {
        let needs = |step: &Step| step.coefficients == Coefficients::Friction;
        self.steps.iter().position(needs).unwrap_or(self.steps.len())
    }

    /// Stores a matrix, if it is not there, and says where.
    fn store(&mut self, form: Form) -> usize {
        self.matrices.iter().position(|stored| *stored == form).unwrap_or_else(|| {
            self.matrices.push(form);
            self.matrices.len() - 1
        })
    }

    fn push(&mut self, form: Form, operands: &[Vector], epilogue: Epilogue, result: Vector) {
        let matrix = self.store(form);
        self.multiply(matrix, operands, epilogue, result);
    }

    fn multiply(&mut self, matrix: usize, operands: &[Vector], epilogue: Epilogue, result: Vector) {
        let friction = self.matrices[matrix].source == Source::Friction;
        self.steps.push(Step {
            matrix,
            operands: operands.to_vec(),
            coefficients: if friction { Coefficients::Friction } else { Coefficients::Rom },
            sums: false,
            parity: 0,
            mirrored: None,
            epilogue,
            result,
        });
    }
}

/// The matrix that is stored for another: what is wanted along y is what is there along x, mirrored at the diagonal.
fn mirror_image(form: Form) -> Form {
    let name = match form.source {
        Source::Ten(ReducedName::K2) => ReducedName::K1,
        Source::Ten(ReducedName::C32) => ReducedName::C31,
        Source::Ten(ReducedName::A2) => ReducedName::A1,
        _ => return form,
    };
    Form { source: Source::Ten(name), ..form }
}
