//! Every pass over a list of products, alone: what the list computes stays the same.

use golden::float::Float;
use golden::kernel::{self, Kernel};
use golden::matrices::Matrices;
use golden::names::{MatrixName, ReducedName};
use golden::parity::{COMPONENTS, Orbits};
use golden::products::{ByPq, Engine, ProductList, Source, Stored, Vector};
use golden::sensor::Sensor;
use nalgebra::DMatrix;

use crate::matrices::fold;

/// All matrices whole: nothing here knows of folds, blocks or rows of sums.
#[derive(Clone)]
struct Dense {
    sensor: Sensor,
    orbits: Orbits,
    thirteen: Vec<DMatrix<f64>>,
    ten: Vec<DMatrix<f64>>,
}

impl Dense {
    fn new(sensor: &Sensor) -> Self {
        let matrices = Matrices::new(sensor, Kernel::Point).unwrap();
        let thirteen: Vec<_> = MatrixName::ALL.into_iter().map(|name| matrices.dense(name)).collect();
        let [c31, c32, c33] = kernel::matrices(sensor, Kernel::Point);
        let [c33inv, a1, a2, a3] = [0, 1, 2, 3].map(|index: usize| thirteen[index].clone());
        let e = &c33 * &a3;
        let ten = vec![c33inv, &c33 - &e * &c33, &e * &c31, &e * &c32, c33, c31, c32, a1, a2, a3];
        Self { sensor: sensor.clone(), orbits: *matrices.orbits(), thirteen, ten }
    }

    fn of(&self, source: Source) -> (&DMatrix<f64>, usize) {
        match source {
            Source::Thirteen(name) => (&self.thirteen[name.index()], name.parity()),
            Source::Ten(name) => (&self.ten[name.index()], name.parity()),
            Source::Friction => panic!("no matrix"),
        }
    }

    /// The sums of all forces and their torques by Eqs. 11 to 13 from the values of the taxels.
    fn sums_of(&self, pull: &[f64], weight: &[f64]) -> ByPq<f64> {
        let of = |name: ReducedName| &self.ten[name.index()];
        let [pull, weight] = [pull, weight].map(nalgebra::DVector::from_row_slice);
        let vector = |p: usize, q: usize| -> nalgebra::DVector<f64> {
            let a = of([ReducedName::A1, ReducedName::A2, ReducedName::A3][p]);
            let c = of([ReducedName::C33, ReducedName::C31, ReducedName::C32][q]);
            let product = a * (c * if q == 0 { &pull } else { &weight });
            match (p, q) {
                (2, 0) => product - &weight,
                (_, 0) => product,
                _ if q == p + 1 => &weight - product,
                _ => -product,
            }
        };
        let mut sums = ByPq::default();
        for q in 0..3 {
            let [x, y, z] = [0, 1, 2].map(|p| vector(p, q));
            for taxel in 0..self.orbits.taxels() {
                let force = [x[taxel], y[taxel], z[taxel]];
                let torque = self.sensor.torque_of(self.sensor.position_m(taxel), force);
                for (sum, part) in sums.iter_mut().zip(force.into_iter().chain(torque)) {
                    sum[q] += part;
                }
            }
        }
        sums
    }
}

fn real<T: Float>(values: &[T]) -> Vec<f64> {
    values.iter().map(|&value| value.into()).collect()
}

impl Stored<1> for Dense {
    fn times<T: Float>(&self, source: Source, x: &[[T; 1]], result: &mut [[T; 1]], _: &mut [Vec<[T; COMPONENTS]>; 2]) {
        let (matrix, _) = self.of(source);
        for (row, result) in matrix.row_iter().zip(result) {
            *result = [row.iter().zip(x).fold(T::default(), |sum, (&value, [x])| sum + T::of(value) * *x)];
        }
    }

    fn sums<T: Float>(&self, pull: &[[T; 1]], weight: &[[T; 1]]) -> ByPq<T> {
        self.sums_of(&real(pull.as_flattened()), &real(weight.as_flattened())).map(|sums| sums.map(T::of))
    }

    fn arm_m(&self, taxel: usize) -> [f64; 2] {
        self.sensor.arm_m(taxel)
    }
}

impl Stored<4> for Dense {
    fn times<T: Float>(&self, source: Source, x: &[[T; 4]], result: &mut [[T; 4]], _: &mut [Vec<[T; COMPONENTS]>; 2]) {
        let (matrix, parity) = self.of(source);
        let by_component = std::array::from_fn(|component| x.iter().map(|values| values[component].into()).collect());
        let product = fold(matrix, parity, &self.orbits).apply(&by_component);
        for (orbit, result) in result.iter_mut().enumerate() {
            *result = std::array::from_fn(|component| T::of(product[component][orbit]));
        }
    }

    fn sums<T: Float>(&self, pull: &[[T; 4]], weight: &[[T; 4]]) -> ByPq<T> {
        let taxels = |x: &[[T; 4]]| {
            self.orbits
                .unfold(&std::array::from_fn(|component| x.iter().map(|values| values[component].into()).collect()))
        };
        self.sums_of(&taxels(pull), &taxels(weight)).map(|sums| sums.map(T::of))
    }

    fn arm_m(&self, taxel: usize) -> [f64; 2] {
        self.sensor.arm_m(taxel)
    }
}

/// What a list finds of a frame.
struct Results {
    sums: ByPq<f64>,
    u: [Vec<f64>; 3],
    field: [Vec<f64>; 3],
}

const MU: [f64; 2] = [0.4, -0.3];

fn execute<T: Float, S: Stored<W>, const W: usize>(
    list: ProductList,
    stored: S,
    images: Vec<[usize; W]>,
    stress: &[f64],
) -> Results {
    let engine: Engine<T, S, W> = Engine::new(list, stored, images, stress.len());
    let mut frame = engine.frame();
    frame.stress = stress.iter().map(|&stress| T::of(stress)).collect();
    engine.until_friction(&mut frame);
    let mut field: [Vec<f64>; 3] = std::array::from_fn(|_| vec![f64::NAN; stress.len()]);
    engine.field(MU.map(T::of), &mut frame, |p, taxel, force| field[p][taxel] = force.into());
    Results { sums: frame.sums.map(|sums| sums.map(Into::into)), u: frame.u.each_ref().map(|u| real(u)), field }
}

fn by_taxel(list: ProductList, dense: &Dense, stress: &[f64]) -> Results {
    execute::<f64, _, 1>(list, dense.clone(), (0..stress.len()).map(|taxel| [taxel]).collect(), stress)
}

fn by_orbit(list: ProductList, dense: &Dense, stress: &[f64]) -> Results {
    execute::<f64, _, 4>(list, dense.clone(), dense.orbits.all(), stress)
}

fn assert_same(one: &Results, other: &Results, share: f64) {
    let close = |one: &[f64], other: &[f64], what: &str| {
        let largest = one.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        for (one, other) in one.iter().zip(other) {
            let nowhere = one.is_nan() && other.is_nan();
            assert!(nowhere || (one - other).abs() <= share * largest, "{what}: {one} {other}");
        }
    };
    close(one.sums.as_flattened(), other.sums.as_flattened(), "sums");
    for index in 0..3 {
        close(&one.u[index], &other.u[index], "u");
        close(&one.field[index], &other.field[index], "field");
    }
}

/// Sensors of even and odd sides, the second square, each with stress without any symmetry.
fn cases() -> Vec<(Dense, Vec<f64>)> {
    [([5, 4], [4.0, 3.0]), ([4, 4], [3.0, 3.0]), ([5, 3], [2.0, 3.0])]
        .into_iter()
        .map(|([columns, rows], pitch_mm)| {
            let sensor = Sensor { columns, rows, pitch_mm, depth_mm: 3.0 };
            let stress = (0..columns * rows).map(|taxel| 500.0 * (1.7 * taxel as f64).sin() - 300.0).collect();
            (Dense::new(&sensor), stress)
        })
        .collect()
}

#[test]
fn fewer_products_are_the_papers() {
    for (dense, stress) in cases() {
        let paper = ProductList::paper();
        assert_eq!((paper.matrices.len(), paper.steps.len()), (14, 16));
        let fewer = paper.fewer_products(true);
        assert_eq!((fewer.matrices.len(), fewer.steps.len()), (11, 11));
        assert_same(&by_taxel(paper, &dense, &stress), &by_taxel(fewer, &dense, &stress), 1e-10);
    }
}

#[test]
fn without_a_field_the_search_finds_the_same() {
    for (dense, stress) in cases() {
        let list = ProductList::paper().fewer_products(false);
        assert_eq!(list.before_friction(), list.steps.len());
        let (with, without) =
            (by_taxel(ProductList::paper(), &dense, &stress), by_taxel(list.folded(), &dense, &stress));
        assert!(without.field.iter().flatten().all(|force| force.is_nan()), "nothing is put there");
        assert_same(&Results { field: without.field.clone(), ..with }, &without, 1e-10);
    }
}

#[test]
fn a_folded_list_computes_the_same() {
    for (dense, stress) in cases() {
        let list = ProductList::paper().fewer_products(true);
        let (whole, folded) = (by_taxel(list.clone(), &dense, &stress), by_orbit(list.folded(), &dense, &stress));
        assert_same(&whole, &folded, 1e-12);
    }
}

#[test]
fn a_mirrored_list_computes_the_same_with_three_matrices_less() {
    let (dense, stress) = cases().swap_remove(1);
    let folded = ProductList::paper().fewer_products(true).folded();
    let mirrored = folded.clone().mirrored(dense.orbits.columns());
    assert_eq!((folded.matrices.len(), mirrored.matrices.len()), (11, 8));
    assert_eq!(mirrored.steps.iter().filter(|step| step.mirrored.is_some()).count(), 3);
    assert_same(&by_orbit(folded, &dense, &stress), &by_orbit(mirrored, &dense, &stress), 1e-12);
}

/// In another arithmetic, but for its rounding.
#[test]
fn a_list_is_the_same_in_single_precision() {
    let (dense, stress) = cases().swap_remove(0);
    let list = ProductList::paper().fewer_products(true).folded();
    let single = execute::<f32, _, 4>(list.clone(), dense.clone(), dense.orbits.all(), &stress);
    assert_same(&by_orbit(list, &dense, &stress), &single, 1e-4);
}

#[test]
fn every_vector_has_a_slot_of_its_own() {
    use Vector::{Explained, Force, G, Partial, Pull, Residual, Stress, U, Weight};
    let mut all = vec![Stress, Weight, Pull, Explained];
    for p in 1..4 {
        all.extend([Partial(p), Force(p), U(p - 1), Residual(p - 1), G(p, 0), G(p, 1), G(p, 2)]);
    }
    let mut slots: Vec<usize> = all.into_iter().map(Vector::slot).collect();
    slots.sort_unstable();
    assert_eq!(slots, (0..Vector::COUNT).collect::<Vec<_>>());
}
