// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The stream's words to stress: float32 pascals to fixed point, or float32 counts, which a curve and taxels' gains make
// stresses.
//
// Word to stress: 5 cycles, with counts 9, with a curve CURVE_LEVELS + 7 more; one a cycle.

`default_nettype none

module sptfra_samples #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Exponent of the number's step, negated, and its largest magnitude, of the stress or of the counts; with EXPONENTS
    // each taxel has one of its own
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    // Whether the stream carries counts: see sptfra_counts
    parameter COUNTS = 0,
    parameter PER_TAXEL = 0,
    parameter EXPONENTS = 0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    parameter COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    // Curve between counts and stress, of 2^CURVE_LEVELS segments, if there is one: see sptfra_curve
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_FIRST = 27'sd0,
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with; those of the taxels
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    parameter TAXEL_NAME = ROM_NAME
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Words of the stream
    input  wire accept,
    input  wire [31:0] word,
    input  wire last,
    // When the number, or the curve's value, is there
    input  wire next_taxel, // the number is of a taxel, the next one of the taxel after it
    input  wire frame_ends, // the next one is of the first taxel
    // Stress
    output wire signed [26:0] stress,
    output wire saturated,
    output wire not_finite
);

    localparam signed [9:0] SHIFT = NUMBER_SHIFT[9:0];

    // ---- float32 to fixed point
    wire signed [26:0] number;
    wire number_saturated;
    wire number_not_finite;
    wire signed [9:0] shift;

    generate
        if (EXPONENTS != 0) begin : gen_exponents
            sptfra_exponents #(
                .TAXELS   (TAXELS),
                .ROM_DIR  (ROM_DIR),
                .ROM_NAME (TAXEL_NAME)
            ) exponents (
                .clock    (clock),
                .reset    (reset),
                .accept   (accept),
                .last     (last),
                .exponent (shift)
            );
        end else begin : gen_exponent
            assign shift = SHIFT;
        end
    endgenerate

    sptfra_float_to_fixed float_to_fixed (
        .clock      (clock),
        .enable     (advance),
        .float_bits (word),
        .shift      (shift),
        .limit      (NUMBER_BOUND),
        .fixed      (number),
        .saturated  (number_saturated),
        .not_finite (number_not_finite)
    );

    // ---- Counts along the curve
    wire signed [26:0] count;
    wire count_saturated;
    wire count_not_finite;

    generate
        if (CURVE_LEVELS != 0) begin : gen_curve
            sptfra_curve #(
                .LEVELS   (CURVE_LEVELS),
                .KNOTS    (CURVE_KNOTS),
                .FIRST    (CURVE_FIRST),
                .LAST     (CURVE_LAST),
                .ROM_DIR  (ROM_DIR),
                .ROM_NAME (ROM_NAME)
            ) curve (
                .clock             (clock),
                .advance           (advance),
                .number            (number),
                .number_saturated  (number_saturated),
                .number_not_finite (number_not_finite),
                .value             (count),
                .saturated         (count_saturated),
                .not_finite        (count_not_finite)
            );
        end else begin : gen_straight
            assign count = number;
            assign count_saturated = number_saturated;
            assign count_not_finite = number_not_finite;
            wire _unused = &{1'b0, CURVE_KNOTS, CURVE_FIRST, CURVE_LAST};
        end
    endgenerate

    // ---- Counts to stress
    generate
        if (COUNTS != 0) begin : gen_counts
            sptfra_counts #(
                .TAXELS       (TAXELS),
                .PER_TAXEL    (PER_TAXEL),
                .GAIN         (GAIN),
                .OFFSET_BITS  (OFFSET_BITS),
                .SHIFT        (COUNT_SHIFT),
                .FULL_SCALE   (FULL_SCALE),
                .STRESS_BOUND (STRESS_BOUND),
                .ROM_DIR      (ROM_DIR),
                .ROM_NAME     (TAXEL_NAME)
            ) counts (
                .clock             (clock),
                .reset             (reset),
                .advance           (advance),
                .next_taxel        (next_taxel),
                .frame_ends        (frame_ends),
                .number            (count),
                .number_saturated  (count_saturated),
                .number_not_finite (count_not_finite),
                .stress            (stress),
                .saturated         (saturated),
                .not_finite        (not_finite)
            );
        end else begin : gen_stress
            assign stress = count;
            assign saturated = count_saturated;
            assign not_finite = count_not_finite;
            wire _unused = next_taxel || frame_ends || (PER_TAXEL != 0) || (GAIN != 0) || (OFFSET_BITS != 0)
                || (COUNT_SHIFT != 0) || (FULL_SCALE != 0) || (STRESS_BOUND != 0);
        end
    endgenerate

    generate
        if (EXPONENTS == 0) begin : gen_none
            wire _unused = reset || accept || last || (TAXELS != 0) || (ROM_DIR != "") || (ROM_NAME != "")
                || (TAXEL_NAME != "");
        end
    endgenerate

endmodule

`default_nettype wire
