//! The reduced plan in float32 throughout, as a processor without f64 would compute it. Matrices come from f64 and are
//! rounded. Only for comparison: hardware has fixed point.

use golden::design::{Design, Estimator, Tension};
use golden::estimators::RANGE;
use golden::estimators::line::{LEVEL, MAX_LINE_RATIO};
use golden::parity::COMPONENTS;
use golden::products::{Engine, ProductList};
use golden::reduced::ReducedMatrices;
use golden::solver::{PULLING, Solution, Solver, Status};

/// Bisections of each search: as many as a float32 has bits.
const STEPS: usize = 24;

/// A solver in float32.
#[derive(Debug)]
pub struct Single<'a> {
    design: &'a Design,
    engine: Engine<f32, ReducedMatrices, COMPONENTS>,
}

impl<'a> Single<'a> {
    /// From the matrices of an f64 solver with the reduced plan; `None` for another plan or estimator.
    pub fn new(design: &'a Design, solver: &Solver) -> Option<Self> {
        let line = design.algorithm.estimator == Estimator::Line;
        line.then_some(())?;
        let list = ProductList::paper().fewer_products(true).folded();
        let orbits = solver.matrices().orbits();
        Some(Self { design, engine: Engine::new(list, solver.reduced()?.clone(), orbits.all(), orbits.taxels()) })
    }

    /// The answer to one frame in Pa.
    pub fn solve(&self, frame: &[f64]) -> Solution {
        let m = self.design.sensor.taxels();
        let full_scale = self.design.hardware.full_scale_in_frames() as f32;
        let raw: Vec<f32> = frame.iter().map(|&stress| stress as f32).collect();
        if raw.iter().any(|stress| !stress.is_finite()) {
            return Solution::zeros(Status::NOT_FINITE, m);
        }
        let saturated = raw.iter().any(|stress| stress.abs() >= full_scale);
        let b: Vec<f32> = raw.iter().map(|stress| stress.clamp(-full_scale, full_scale)).collect();
        let floor = self.design.algorithm.noise_floor_pa as f32;
        let stress_sum: f32 = b.iter().map(|stress| stress.abs()).sum();
        if stress_sum < floor * m as f32 {
            return Solution::zeros(Status::NO_CONTACT, m);
        }
        let mut of_frame = self.engine.frame();
        of_frame.stress.copy_from_slice(&b);
        self.engine.until_friction(&mut of_frame);
        let sums = of_frame.sums;
        let mut status = Status::default();
        let u = of_frame.u.each_ref().map(Vec::as_slice);
        let [mu_x, mu_y] = self.friction(&b, floor, &sums, u, stress_sum, &mut status);
        if saturated {
            status.insert(Status::SATURATED);
        }
        if self.design.thin_layer().is_some() {
            status.insert(Status::LOW_CONFIDENCE);
        }
        let pushed = status.contains(Status::DIRECTION_UNKNOWN) || f64::from(mu_x.abs() + mu_y.abs()) >= PULLING;
        if pushed && self.design.input.tension == Tension::Read && b.iter().all(|&stress| stress <= floor) {
            status.insert(Status::NO_TENSION);
        }
        let mut field: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; m]);
        self.engine.field([mu_x, mu_y], &mut of_frame, |p, taxel, force| field[p][taxel] = f64::from(force));
        let [x, y, z, torque @ ..] = sums.map(|[g0, g1, g2]| g0 + mu_x * g1 + mu_y * g2);
        let mu = if z == 0.0 { 0.0 } else { x.hypot(y) / z.abs() };
        Solution {
            resultant: [x, y, z].map(f64::from),
            torque: torque.map(f64::from),
            mu: f64::from(mu),
            phi: f64::from(y.atan2(x)),
            mu_x: f64::from(mu_x),
            mu_y: f64::from(mu_y),
            contacts: 1,
            field,
            ..Solution::zeros(status, 0)
        }
    }

    /// The paper's line search: the direction of push, the line, the middle of the level set on it.
    fn friction(
        &self,
        b: &[f32],
        floor: f32,
        sums: &[[f32; 3]],
        u: [&[f32]; 3],
        stress_sum: f32,
        status: &mut Status,
    ) -> [f32; 2] {
        let line = self.direction(b, floor).and_then(|[dx, dy]| {
            let a = sums[0][1] * dy - sums[1][1] * dx;
            let e = sums[0][2] * dy - sums[1][2] * dx;
            let k = sums[1][0] * dx - sums[0][0] * dy;
            let (independent, numerator, denominator) = if dx.abs() >= dy.abs() { (0, a, e) } else { (1, e, a) };
            let (offset, slope) = (k / denominator, -numerator / denominator);
            let limit = MAX_LINE_RATIO as f32;
            (offset.abs() < limit && slope.abs() < limit).then_some((independent, offset, slope))
        });
        let Some((independent, offset, slope)) = line else {
            status.insert(Status::DIRECTION_UNKNOWN);
            return [0.0; 2];
        };
        let dependent = 1 - independent;
        let along = |from: &[f32], times: f32| -> Vec<f32> {
            from.iter().zip(u[1 + dependent]).map(|(from, other)| from + other * times).collect()
        };
        let (alpha, beta) = (along(u[0], offset), along(u[1 + independent], slope));
        let (t, at_bound) = search(&alpha, &beta, LEVEL as f32 * stress_sum);
        let range = RANGE as f32;
        let wanted = offset + slope * t;
        if at_bound || !(-range..range).contains(&wanted) {
            status.insert(Status::AT_BOUND);
        }
        let mut mu = [0.0; 2];
        mu[independent] = t;
        mu[dependent] = wanted.clamp(-range, range);
        mu
    }

    /// Centroid of compression minus that of tension.
    fn direction(&self, b: &[f32], floor: f32) -> Option<[f32; 2]> {
        let centroid = |sign: f32| {
            let mut sums = [0.0_f32; 3];
            for (taxel, stress) in b.iter().enumerate() {
                let weight = (sign * stress).max(0.0);
                let [x, y] = self.design.sensor.position_m(taxel);
                sums[0] += weight * x as f32;
                sums[1] += weight * y as f32;
                sums[2] += weight;
            }
            [sums[0] / sums[2], sums[1] / sums[2]]
        };
        let both = b.iter().any(|&stress| stress < -floor) && b.iter().any(|&stress| stress > floor);
        let (c, t) = (centroid(-1.0), centroid(1.0));
        both.then(|| [c[0] - t[0], c[1] - t[1]])
    }
}

/// The middle of where the sum of rectifiers is within `allowance` of its least value on [-1, 1], and whether that value is
/// at an end.
fn search(alpha: &[f32], beta: &[f32], allowance: f32) -> (f32, bool) {
    let value = |t: f32| -> f32 { alpha.iter().zip(beta).map(|(a, b)| (a + t * b).max(0.0)).sum() };
    let slope = |t: f32| -> f32 { alpha.iter().zip(beta).filter(|(a, b)| *a + t * *b > 0.0).map(|(_, b)| b).sum() };
    let bisect = |mut from: f32, mut to: f32, is_before: &dyn Fn(f32) -> bool| {
        for _ in 0..STEPS {
            let middle = from.midpoint(to);
            if is_before(middle) { from = middle } else { to = middle }
        }
        from.midpoint(to)
    };
    let optimum = bisect(-1.0, 1.0, &|t| slope(t) < 0.0);
    let level = value(optimum) + allowance;
    let left = bisect(-1.0, optimum, &|t| value(t) > level);
    let right = bisect(optimum, 1.0, &|t| value(t) <= level);
    (left.midpoint(right), slope(-1.0) >= 0.0 || slope(1.0) < 0.0)
}

#[cfg(test)]
mod tests {
    use golden::metrics::field_error;

    use super::*;
    use testbench::frame_set::FrameSet;

    #[test]
    fn it_is_the_f64_solver_but_for_rounding() {
        for (columns, rows) in [(10, 10), (7, 5)] {
            let text = format!(
                "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
                 name = \"pad\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n"
            );
            let design = Design::from_toml(&text, "pad").expect("a design");
            let solver = Solver::new(&design).expect("a solver");
            let single = Single::new(&design, &solver).expect("the reduced plan");
            for stress in FrameSet::standing(&design.sensor).expect("frames").stress.iter().step_by(5) {
                let (one, other) = (solver.solve(stress).expect("solved"), single.solve(stress));
                assert_eq!(one.status, other.status);
                let error = field_error(&one.field, &other.field);
                assert!(error > 0.0 && error < 1e-3, "{error}");
            }
        }
    }
}
