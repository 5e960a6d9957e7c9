// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The stream's samples to stress: float32 pascals to fixed point, or counts, float32 or integers, which a curve and
// taxels' gains make stresses.
//
// Sample to stress: 5 cycles, with a curve CURVE_LEVELS + 7 more, with counts 4 more. By a calibration in RAM: 10
// cycles, with a curve CURVE_LEVELS + 12 more. One a cycle.

`default_nettype none

module sptfra_samples #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign
    parameter SAMPLE = 0,
    // Exponent of the number's step, negated, and its largest magnitude, of the stress or of the counts; with EXPONENTS
    // each taxel has one of its own
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    // Whether the stream carries counts: see sptfra_counts, with CALIBRATED sptfra_calibrate
    parameter COUNTS = 0,
    parameter CALIBRATED = 0,
    parameter PER_TAXEL = 0,
    parameter EXPONENTS = 0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    parameter COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    // Curve between counts and stress, of 2^CURVE_LEVELS segments, if there is one: see sptfra_curve
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    parameter integer CURVE_LSB = 0, // with CALIBRATED, a step of its values is 2^CURVE_LSB Pa
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with; those of the taxels
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    parameter TAXEL_NAME = ROM_NAME,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter LEVELS = (CURVE_LEVELS != 0) ? CURVE_LEVELS : 1
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Samples of the stream
    input  wire accept,
    input  wire [SAMPLE_BITS-1:0] sample,
    input  wire last,
    // When the number, or the curve's value, is there
    input  wire next_taxel, // the number is of a taxel, the next one of the taxel after it
    input  wire frame_ends, // the next one is of the first taxel
    // Of a calibration in RAM: see sptfra_banks. The gain comes a cycle after the number or the value
    input  wire [27:0] bank_gain,
    input  wire [OFFSET_BITS-1:0] bank_offset,
    input  wire [27*(1<<LEVELS)-1:0] bank_knots,
    input  wire [6:0] bank_segments,
    input  wire signed [26:0] bank_last,
    input  wire [26:0] bank_reach,
    output wire [LEVELS-1:0] segment,
    input  wire [77:0] bank_line,
    // Stress
    output wire signed [26:0] stress,
    output wire saturated,
    output wire not_finite
);

    localparam signed [9:0] SHIFT = NUMBER_SHIFT[9:0];

    // ---- To fixed point
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
        if ((CALIBRATED == 0) || (CURVE_LEVELS != 0)) begin : gen_decode
            sptfra_decode #(
                .SAMPLE (SAMPLE)
            ) decode (
                .clock      (clock),
                .enable     (advance),
                .sample     (sample),
                .shift      (shift),
                .limit      ((CALIBRATED != 0) ? bank_reach : NUMBER_BOUND),
                .number     (number),
                .saturated  (number_saturated),
                .not_finite (number_not_finite)
            );
        end else begin : gen_later
            assign number = 27'sd0;
            assign number_saturated = 1'b0;
            assign number_not_finite = 1'b0;
            wire _unused_shift = &{1'b0, shift};
        end
    endgenerate

    // ---- Counts along the curve
    wire signed [26:0] count;
    wire count_saturated;
    wire count_not_finite;

    generate
        if (CURVE_LEVELS != 0) begin : gen_curve
            localparam [31:0] SEGMENTS = 1 << CURVE_LEVELS;
            wire [77:0] line;

            if (CALIBRATED != 0) begin : gen_bank
                assign line = bank_line;
            end else begin : gen_lines
                sptfra_rom #(
                    .WIDTH         (78),
                    .DEPTH         (1 << CURVE_LEVELS),
                    .ADDRESS_WIDTH (CURVE_LEVELS),
                    .ROM_DIR       (ROM_DIR),
                    .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_curve.mem"})
                ) lines (
                    .clock   (clock),
                    .enable  (advance),
                    .address (segment),
                    .data    (line)
                );
            end

            sptfra_curve #(
                .LEVELS (CURVE_LEVELS)
            ) curve (
                .clock             (clock),
                .advance           (advance),
                .number            (number),
                .number_saturated  (number_saturated),
                .number_not_finite (number_not_finite),
                .value             (count),
                .saturated         (count_saturated),
                .not_finite        (count_not_finite),
                .knots             ((CALIBRATED != 0) ? bank_knots : CURVE_KNOTS),
                .count             ((CALIBRATED != 0) ? bank_segments : SEGMENTS[6:0]),
                .last              ((CALIBRATED != 0) ? bank_last : CURVE_LAST),
                .segment           (segment),
                .line_1            (line)
            );
        end else begin : gen_straight
            assign count = number;
            assign count_saturated = number_saturated;
            assign count_not_finite = number_not_finite;
            assign segment = {LEVELS{1'b0}};
            wire _unused = &{1'b0, CURVE_KNOTS, CURVE_LAST};
        end
    endgenerate

    // ---- Counts to stress
    generate
        if (CALIBRATED != 0) begin : gen_calibrated
            localparam FROM_CURVE = (CURVE_LEVELS != 0) ? 1 : 0;
            wire [((FROM_CURVE != 0) ? 27 : SAMPLE_BITS)-1:0] from;

            if (FROM_CURVE != 0) begin : gen_value
                assign from = count;
            end else begin : gen_sample
                assign from = sample;
                wire _unused_count = &{1'b0, count};
            end

            sptfra_calibrate #(
                .SAMPLE       ((FROM_CURVE != 0) ? 3 : SAMPLE),
                .VALUE_LSB    (CURVE_LSB),
                .OFFSET_BITS  (OFFSET_BITS),
                .COUNT_SHIFT  (COUNT_SHIFT),
                .FULL_SCALE   (FULL_SCALE),
                .STRESS_BOUND (STRESS_BOUND)
            ) calibrate (
                .clock      (clock),
                .advance    (advance),
                .sample     (from),
                .beyond     (count_saturated),
                .no_number  (count_not_finite),
                .gain_1     (bank_gain),
                .offset_1   (bank_offset),
                .stress     (stress),
                .saturated  (saturated),
                .not_finite (not_finite)
            );

            wire _unused = next_taxel || frame_ends || (PER_TAXEL != 0) || (GAIN != 0);
        end else if (COUNTS != 0) begin : gen_counts
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

    wire _unused_bank = &{1'b0, bank_gain, bank_offset, bank_knots, bank_segments, bank_last, bank_reach, bank_line,
        CURVE_LSB != 0};

    generate
        if (EXPONENTS == 0) begin : gen_none
            wire _unused = reset || accept || last || (TAXELS != 0) || (ROM_DIR != "") || (ROM_NAME != "")
                || (TAXEL_NAME != "");
        end
    endgenerate

endmodule

`default_nettype wire
