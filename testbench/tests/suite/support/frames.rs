//! Input packets for tests: plausible ones, noise, and the ends of every range.

use golden::parity::sign;
use hdl_gen::plan::Plan;
use hdl_gen::plan::product::Product;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// The input packet of a frame of stresses in Pa: float32, in taxel order.
pub fn encode(stress: &[f64]) -> Vec<u32> {
    stress.iter().map(|&value| (value as f32).to_bits()).collect()
}

/// A round contact somewhere on the sensor, dragged in some direction: compression in front of it, tension behind.
pub fn contact(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<u32> {
    let (sensor, full_scale) = (&plan.design.sensor, plan.design.hardware.full_scale_pa);
    let side = |count: usize, pitch: f64| (count - 1) as f64 * pitch;
    let sides = [side(sensor.columns, sensor.pitch_mm[0]), side(sensor.rows, sensor.pitch_mm[1])];
    let centre = sides.map(|side| random.random_range(0.2..0.8) * side);
    let radius = random.random_range(0.2..0.6) * sides[0].max(sides[1]);
    let peak = full_scale * 10_f64.powf(random.random_range(-2.0..-0.1));
    let (friction, angle) = (random.random_range(0.0..0.9), random.random_range(0.0..std::f64::consts::TAU));
    let stress: Vec<f64> = (0..sensor.taxels())
        .map(|taxel| {
            let [x, y] = sensor.position_m(taxel).map(|metres| metres * 1e3);
            let (x, y) = ((x - centre[0]) / radius, (y - centre[1]) / radius);
            let along = x * angle.cos() + y * angle.sin();
            -peak * (1.0 + 2.0 * friction * along) * (-(x * x + y * y)).exp()
        })
        .collect();
    encode(&stress)
}

/// Every taxel at random within the full scale times `share`.
pub fn noise(plan: &Plan, share: f64, random: &mut ChaCha8Rng) -> Vec<u32> {
    let limit = share * plan.design.hardware.full_scale_pa;
    let stress: Vec<f64> = (0..plan.taxels()).map(|_| random.random_range(-limit..=limit)).collect();
    encode(&stress)
}

/// Each packet of pascals, then the same with noise of a few percent, as an average takes them in.
pub fn held(packets: &[Vec<u32>], random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let mut noisy = |&bits: &u32| (f32::from_bits(bits) * random.random_range(0.97..1.03)).to_bits();
    let mut copy = |packet: &Vec<u32>| packet.iter().map(&mut noisy).collect::<Vec<u32>>();
    packets.iter().flat_map(|packet| [packet.clone(), copy(packet), copy(packet)]).collect()
}

/// The packet of a frame's values. What fills its last beat means nothing: it is as large as a sample can be, and where
/// it can be none, no number.
pub fn filled(plan: &Plan, values: impl Iterator<Item = f64>) -> Vec<u32> {
    let streams = plan.streams();
    let behind = streams.beats_in() * streams.samples() - plan.taxels();
    streams.packet(&values.chain(std::iter::repeat_n(f64::INFINITY, behind)).collect::<Vec<_>>())
}

/// Nothing presses.
pub fn empty(plan: &Plan) -> Vec<u32> {
    vec![0; plan.taxels()]
}

/// The ends of the ranges, in the input and, by the signs of matrix rows, inside.
pub fn extremes(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let taxels = plan.taxels();
    let full_scale = plan.design.hardware.full_scale_pa;
    let step = plan.formats.stress.step();
    let floor = plan.thresholds.taxel as f64 * step;
    let each = |value: &dyn Fn(usize) -> f64| encode(&(0..taxels).map(value).collect::<Vec<_>>());
    let sign = |positive: bool| if positive { 1.0 } else { -1.0 };
    let contact = plan.thresholds.contact as f64 * step;
    let (columns, rows) = (plan.design.sensor.columns, plan.design.sensor.rows);
    let diagonal = (columns.min(rows) - 1) * (columns + 1);
    let chosen = random.random_range(0..taxels);
    let other = random.random_range(0..taxels);
    let mut packets = vec![
        empty(plan),
        each(&|_| -0.0),
        each(&|_| -full_scale),
        each(&|_| full_scale),
        each(&|taxel| full_scale * sign(taxel % 2 == 0)),
        each(&|taxel| full_scale * sign((taxel % columns + taxel / columns) % 2 == 1)),
        each(&|taxel| full_scale * sign(taxel < taxels / 2)),
        each(&|taxel| if taxel == chosen { -full_scale } else { 0.0 }),
        each(&|taxel| if taxel == chosen { full_scale } else { 0.0 }),
        each(&|taxel| if taxel == other { full_scale } else { -full_scale }),
        each(&|_| -step),
        each(&|_| step),
        each(&|taxel| step * sign(taxel % 2 == 0)),
        each(&|taxel| if taxel == chosen { -step } else { 0.0 }),
        // Half a step: where rounding decides.
        each(&|taxel| 0.5 * step * (taxel as f64 - 0.5 * taxels as f64)),
        // The noise floor of a taxel, of either sign, and one step beyond: whether there is a direction.
        each(&|_| -floor),
        each(&|taxel| (floor + step) * sign(taxel % 3 == 0)),
        each(&|taxel| if taxel == chosen { floor } else { -9.0 * floor }),
        each(&|taxel| if taxel == chosen { floor + step } else { -9.0 * floor }),
        each(&|taxel| if taxel == chosen { -floor } else { 9.0 * floor }),
        each(&|taxel| if taxel == chosen { -floor - step } else { 9.0 * floor }),
        // The noise floor of the frame, and one step less: whether there is a contact.
        each(&|taxel| if taxel == chosen { -contact } else { 0.0 }),
        each(&|taxel| if taxel == chosen { step - contact } else { 0.0 }),
        // A push along the diagonal of the grid: neither component is the larger one where the pitch is square.
        each(&|taxel| if taxel == 0 { -full_scale } else { 0.9 * full_scale * f64::from(u8::from(taxel == diagonal)) }),
        each(&|taxel| if taxel == diagonal { -step } else { step * f64::from(u8::from(taxel == 0)) }),
        // Beyond the full scale, up to the largest float, and down to the smallest.
        each(&|_| -1.5 * full_scale),
        each(&|taxel| 1e9 * full_scale * sign(taxel % 3 == 0)),
        each(&|taxel| f64::from(f32::MAX) * sign(taxel % 2 == 0)),
        each(&|taxel| f64::from(f32::from_bits(1)) * sign(taxel % 2 == 0)),
        each(&|taxel| if taxel == chosen { 1.001 * full_scale } else { -0.01 * full_scale }),
    ];
    // Most products multiply stress or the weights that come of it: the signs of the longest row drive its sum to the
    // bound from which the formats were chosen.
    packets.extend(plan.products.iter().take(13).map(|product| worst_case(plan, product)));
    packets
}

fn worst_case(plan: &Plan, product: &Product) -> Vec<u32> {
    let full_scale = plan.design.hardware.full_scale_pa;
    let rows = &plan.matrices[product.matrix].rows;
    let weight =
        |row: &&Vec<(u32, [i32; 4])>| row.iter().map(|&(_, channels)| i64::from(channels[0]).abs()).sum::<i64>();
    let mut stress = vec![-full_scale; plan.taxels()];
    for &(column, channels) in rows.iter().max_by_key(weight).into_iter().flatten() {
        let column = column as usize;
        if plan.channels() == 1 {
            stress[column] = if channels[0] > 0 { -full_scale } else { full_scale };
            continue;
        }
        // The first taxel's row, unfolded.
        for (s, taxel) in plan.orbits().images(column % plan.elements()).into_iter().enumerate() {
            let value: f64 = (0..4).map(|channel| sign(channel, s) * f64::from(channels[channel])).sum();
            stress[taxel] = if value > 0.0 { -full_scale } else { full_scale };
        }
    }
    encode(&stress)
}
