//! The module on a bench of its own.

use std::fmt::Write as _;
use std::fs;

use hdl_gen::blocks::regions::{counted, parameters, parted};
use hdl_gen::model::contacts::regions::Found;

use super::cases::Case;
use crate::support::player::{verilator, write_broken};

/// The module with inputs that are registers of whatever, and outputs that are all looked at.
pub fn instance(case: &Case) -> String {
    let (contacts, width) = (case.contacts, case.taxel_width());
    let parameters = parameters(&case.sensor, contacts, case.latency).verilog();
    format!(
        "    reg [25:0] weight;
    reg [{width}-1:0] address;
    wire [{width}-1:0] weight_address, list_taxel;
    wire [2:0] region;
    wire [7:0] bodies;
    wire [3:0] kept;
    wire [16*{contacts}-1:0] taxels;
    wire [({width}+1)*{contacts}-1:0] sizes;
    wire counted, parted;
    always @(posedge clock) begin
        weight <= weight + 1'b1;
        address <= address + 1'b1;
    end
    sptfra_regions {parameters} subject (.clock(clock), .reset(weight[0]), .start(weight[1]), .largest(weight),
        .weight_address(weight_address), .weight(weight), .counted(counted), .bodies(bodies), .kept(kept), .taxels(taxels),
        .parted(parted), .region_address(address), .region(region), .list_address(address), .list_taxel(list_taxel),
        .sizes(sizes));
    wire _unused = &{{1'b0, weight_address, counted, bodies, kept, taxels, parted, region, list_taxel, sizes}};
"
    )
}

/// What the bench writes of a case: of each frame its count, in how many cycles, and of several bodies the rest; then the
/// count again, as it stands before the next frame.
pub fn lines(case: &Case, expected: &[Found]) -> String {
    let width = case.taxel_width() as usize + 1;
    let mut text = String::new();
    for found in expected {
        let packed = |bits: usize, values: &[u32]| {
            let digits = values.iter().rev().map(|value| format!("{value:0bits$b}")).collect::<String>();
            format!("{digits:0>all$}", all = bits * case.contacts)
        };
        let count = format!("{} {} {}", found.bodies, found.kept(), packed(16, &found.taxels));
        let _ = writeln!(text, "{} {count}", counted(&case.sensor, case.latency));
        if found.kept() > 1 {
            let _ = writeln!(text, "{} {}", parted(&case.sensor, case.contacts), packed(width, &found.sizes));
            for (region, taxel) in found.regions.iter().zip(&found.list) {
                let _ = writeln!(text, "{region} {taxel}");
            }
        }
        let _ = writeln!(text, "{count}");
    }
    text
}

/// Says which line is the first that differs.
pub fn assert_same(case: &Case, text: &str, expected: &[Found]) {
    let wanted = lines(case, expected);
    if text != wanted {
        let number = text.lines().zip(wanted.lines()).take_while(|(text, wanted)| text == wanted).count();
        let line = |text: &str| text.lines().nth(number).unwrap_or("nothing").to_owned();
        panic!("{}: line {number}: {} instead of {}", case.name(), line(text), line(&wanted));
    }
}

/// Plays all cases at once: what the bench writes of each, or what a check of the module says. A fault is a
/// module, a text in it and what takes its place.
pub fn play(cases: &[Case], fault: Option<&(&str, &str, &str)>) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: String| folder.path().join(name);
    let mut bench = "module bench(input clock);\n".to_owned();
    let mut longest = 0;
    for case in cases {
        let words: Vec<String> = case.frames.iter().flatten().map(|weight| format!("{weight:x}\n")).collect();
        let largest: Vec<String> =
            case.frames.iter().map(|frame| format!("{:x}\n", frame.iter().max().unwrap())).collect();
        let name = case.name();
        fs::write(place(format!("{name}.weights")), words.concat()).expect("writable");
        fs::write(place(format!("{name}.largest")), largest.concat()).expect("writable");
        longest = longest.max(case.cycles());
        bench += &player(case);
    }
    fs::write(place("bench.v".to_owned()), bench + "endmodule\n").expect("writable");
    if let Some((module, from, to)) = fault {
        write_broken(folder.path(), &format!("sptfra_regions_{module}"), from, to);
    }
    let said = verilator(folder.path(), longest + 10);
    if !said.is_empty() {
        return Err(said);
    }
    let text = |case: &Case| fs::read_to_string(place(format!("{}.out", case.name()))).expect("written");
    Ok(cases.iter().map(text).collect())
}

/// A bench's part that plays a case: weights are there from start to count alone; then all regions and lists are read. Of
/// some frames with one body the next one starts in the cycle of the count; some are begun, cut off by a reset of one cycle
/// at any time, and begun again right behind it.
fn player(case: &Case) -> String {
    let (name, contacts, latency) = (case.name(), case.contacts, case.latency);
    let (frames, taxels, width) = (case.frames.len(), case.sensor.taxels(), case.taxel_width());
    let parameters = parameters(&case.sensor, contacts, latency).verilog();
    let all = frames * taxels;
    let longest = counted(&case.sensor, latency) + parted(&case.sensor, contacts);
    format!(
        "    generate if (1) begin : {name}
        reg [25:0] weights [0:{all}-1];
        reg [25:0] largests [0:{frames}-1];
        reg [25:0] late [0:{latency}];
        wire [{width}-1:0] weight_address, list_taxel;
        wire [2:0] region;
        wire [7:0] bodies;
        wire [3:0] kept;
        wire [16*{contacts}-1:0] taxels;
        wire [({width}+1)*{contacts}-1:0] sizes;
        integer frame, cycles, wait_cycles, reset, index, file, left;
        wire counts, parts;
        wire counted = counts && reset == 0;
        wire parted = parts && reset == 0;
        reg go, there, reads, over, tried, cut;
        reg [{width}:0] address;
        wire ends = counted && !cut && (kept < 2) && frame % 3 == 0;
        wire start = go || (ends && frame + 1 < {frames});
        wire [31:0] of = start && !go ? frame + 1 : frame;
        initial begin
            {{go, there, reads, over, tried, cut}} = 6'd0;
            {{frame, cycles, left}} = 96'd0;
            address = 0;
            reset = 3;
            wait_cycles = 5;
            $readmemh(\"{name}.weights\", weights);
            $readmemh(\"{name}.largest\", largests);
            file = $fopen(\"{name}.out\", \"w\");
        end
        sptfra_regions {parameters} subject (.clock(clock), .reset(reset != 0), .start(start),
            .largest(start || there ? largests[of] : 26'h2aaaaaa), .weight_address(weight_address),
            .weight(late[{latency}-1]), .counted(counts), .bodies(bodies), .kept(kept), .taxels(taxels),
            .parted(parts), .region_address(address[{width}-1:0]), .region(region),
            .list_address(address[{width}-1:0]), .list_taxel(list_taxel), .sizes(sizes));
        always @(posedge clock) if (!over) begin
            if (reset != 0) reset <= reset - 1;
            late[0] <= there && weight_address < {taxels} ? weights[frame * {taxels} + weight_address] : 26'h3ffffff;
            for (index = 1; index < {latency}; index = index + 1) late[index] <= late[index-1];
            go <= 0;
            if (wait_cycles != 0) begin
                wait_cycles <= wait_cycles - 1;
                go <= wait_cycles == 1;
            end
            if (start && of % 5 == 3 && !tried) begin
                cut <= 1;
                left <= of * 37 % {longest};
            end
            cycles <= start || counted ? 1 : cycles + 1;
            if (counted) begin
                there <= 0;
                if (!cut) $fwrite(file, \"%0d %0d %0d %b\\n\", cycles, bodies, kept, taxels);
            end
            if (parted && !cut) $fwrite(file, \"%0d %b\\n\", cycles, sizes);
            if (start) there <= 1;
            if (parted) begin
                reads <= 1;
                address <= 1;
            end else if (reads) begin
                if (!cut) $fwrite(file, \"%0d %0d\\n\", region, list_taxel);
                address <= address + 1;
            end
            if (cut) begin
                left <= left - 1;
                if (left == 0) begin
                    {{cut, there, reads, tried}} <= 4'd1;
                    reset <= 1;
                    wait_cycles <= 1;
                    address <= 0;
                end
            end else if (ends || (counted && kept < 2) || (reads && address == {taxels})) begin
                $fwrite(file, \"%0d %0d %b\\n\", bodies, kept, taxels);
                reads <= 0;
                address <= 0;
                frame <= frame + 1;
                tried <= 0;
                if (frame + 1 == {frames}) begin
                    over <= 1;
                    $fclose(file);
                end else if (!ends) wait_cycles <= 1 + frame % 4;
            end
        end
    end endgenerate\n"
    )
}
