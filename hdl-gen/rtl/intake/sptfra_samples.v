// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The stream's samples to stress: float32 pascals to fixed point, or counts, float32 or integers, which a curve and
// taxels' gains make stresses.
//
// Sample to number: 5 cycles, where each taxel's gain has an exponent for it 7. With a curve CURVE_LEVELS + 7 more to
// its value. With counts 4 more to the stress, behind a curve 7. One a cycle.

`default_nettype none

module sptfra_samples #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign
    parameter SAMPLE = 0,
    // Exponent of the number's step, negated, and its largest magnitude, of the stress or of the counts
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    // 1: the stream carries counts; 0: pascals
    parameter COUNTS = 0,
    // 1: constants and curve come from the banks of a calibration
    parameter CALIBRATED = 0,
    // 1: each taxel has an exponent, a gain and an offset of its own; 0: EXPONENT and GAIN, and no offset
    parameter PER_TAXEL = 0,
    // Exponent with which a count is decoded, and gain with 16 fraction bits
    parameter signed [9:0] EXPONENT = 10'sd0,
    parameter signed [17:0] GAIN = 18'sd65536,
    // Counts to stress, see sptfra_counts: bits of an offset, bits dropped of a product, limits
    parameter OFFSET_BITS = 27,
    parameter integer COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Curve between counts and stress, of 2^CURVE_LEVELS segments, if there is one: see sptfra_curve
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    // Prefix of the ROM file names, what they begin with, and what those of the taxels' constants begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    parameter TAXEL_NAME = ROM_NAME,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter LEVELS = (CURVE_LEVELS != 0) ? CURVE_LEVELS : 1,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // Samples of the stream
    input  wire [SAMPLE_BITS-1:0] sample,
    input  wire sample_taken, // it is of a taxel, the next one of the taxel after it
    input  wire sample_ends, // the next one is of the first taxel
    // The same when the number, or the curve's value, is there
    input  wire value_taken,
    input  wire value_ends,
    // Of a calibration in RAM: see sptfra_banks
    output wire [TAXEL_WIDTH-1:0] exponent_taxel,
    output reg  [TAXEL_WIDTH-1:0] gain_taxel,
    input  wire [OFFSET_BITS+27:0] bank_constants,
    input  wire [27*(1<<LEVELS)+60:0] bank_curve,
    output wire [LEVELS-1:0] segment,
    input  wire [77:0] bank_line,
    // Stress
    output wire signed [26:0] stress,
    output wire saturated,
    output wire not_finite
);

    localparam signed [9:0] SHIFT = NUMBER_SHIFT[9:0];
    localparam SHIFTS = (CURVE_LEVELS != 0) ? 1 : 0;

    wire [27*(1<<LEVELS)-1:0] bank_knots;
    wire [6:0] bank_segments;
    wire signed [26:0] bank_last;
    wire [26:0] bank_reach;

    assign {bank_knots, bank_segments, bank_last, bank_reach} = bank_curve;

    // ---- To fixed point
    wire signed [26:0] number;
    wire number_saturated;
    wire number_not_finite;
    wire signed [9:0] exponent;
    wire [SAMPLE_BITS-1:0] decoded;
    wire signed [9:0] shift;
    wire [26:0] limit = ((CALIBRATED != 0) && (SHIFTS != 0)) ? bank_reach : NUMBER_BOUND;

    if ((PER_TAXEL != 0) && (SHIFTS == 0)) begin : gen_exponents
        // Behind the memory stands a register
        reg [SAMPLE_BITS-1:0] sample_1;
        reg [SAMPLE_BITS-1:0] sample_2;
        reg signed [9:0] exponent_2;

        assign decoded = sample_2;
        assign shift = exponent_2;

        always @(posedge clock) begin
            sample_1 <= sample;
            sample_2 <= sample_1;
            exponent_2 <= exponent;
        end
    end else begin : gen_exponent
        assign decoded = sample;
        assign shift = SHIFT;
    end

    if (SAMPLE == 0) begin : gen_float
        sptfra_float_to_fixed float_to_fixed (
            .clock      (clock),
            .float_bits (decoded),
            .shift      (shift),
            .limit      (limit),
            .fixed      (number),
            .saturated  (number_saturated),
            .not_finite (number_not_finite)
        );
    end else begin : gen_integer
        sptfra_int_to_fixed #(
            .SIGNED ((SAMPLE == 1) ? 1 : 0)
        ) int_to_fixed (
            .clock     (clock),
            .count     (decoded),
            .shift     (shift),
            .limit     (limit),
            .fixed     (number),
            .saturated (number_saturated)
        );

        assign number_not_finite = 1'b0;
    end

    // ---- Counts along the curve
    wire signed [26:0] count;
    wire count_saturated;
    wire count_not_finite;

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
                .enable  (1'b1),
                .address (segment),
                .data    (line)
            );
        end

        sptfra_curve #(
            .LEVELS (CURVE_LEVELS)
        ) curve (
            .clock             (clock),
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

    // ---- Counts to stress. Exponent, gain and offset come a cycle after their taxel
    reg [TAXEL_WIDTH-1:0] sampled;

    assign exponent_taxel = (SHIFTS != 0) ? gain_taxel : sampled;

    always @(posedge clock) begin
        if (sample_taken) begin
            sampled <= sampled + 1'b1;
        end
        if (value_taken) begin
            gain_taxel <= gain_taxel + 1'b1;
        end
        if (reset || sample_ends) begin
            sampled <= {TAXEL_WIDTH{1'b0}};
        end
        if (reset || value_ends) begin
            gain_taxel <= {TAXEL_WIDTH{1'b0}};
        end
    end

    if (COUNTS != 0) begin : gen_counts
        wire [17:0] gain;
        wire [OFFSET_BITS-1:0] offset;

        if (PER_TAXEL == 0) begin : gen_shared
            assign {exponent, gain, offset} = {EXPONENT, GAIN, {OFFSET_BITS{1'b0}}};
        end else if (CALIBRATED != 0) begin : gen_bank
            assign {exponent, gain, offset} = bank_constants;
        end else begin : gen_roms
            wire [9:0] exponent_bits;

            assign exponent = exponent_bits;

            sptfra_rom #(
                .WIDTH         (10),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((TAXEL_NAME == "") ? "" : {TAXEL_NAME, "_exponents.mem"})
            ) exponents (
                .clock   (clock),
                .enable  (1'b1),
                .address (exponent_taxel),
                .data    (exponent_bits)
            );

            sptfra_rom #(
                .WIDTH         (18),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((TAXEL_NAME == "") ? "" : {TAXEL_NAME, "_gains.mem"})
            ) gains (
                .clock   (clock),
                .enable  (1'b1),
                .address (gain_taxel),
                .data    (gain)
            );

            sptfra_rom #(
                .WIDTH         (OFFSET_BITS),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((TAXEL_NAME == "") ? "" : {TAXEL_NAME, "_offsets.mem"})
            ) offsets (
                .clock   (clock),
                .enable  (1'b1),
                .address (gain_taxel),
                .data    (offset)
            );
        end

        sptfra_counts #(
            .SHIFTS       (SHIFTS),
            .OFFSET_BITS  (OFFSET_BITS),
            .SHIFT        (COUNT_SHIFT),
            .FULL_SCALE   (FULL_SCALE),
            .STRESS_BOUND (STRESS_BOUND)
        ) counts (
            .clock             (clock),
            .number            (count),
            .number_saturated  (count_saturated),
            .number_not_finite (count_not_finite),
            .exponent_1        (exponent),
            .gain_1            (gain),
            .offset_1          (offset),
            .stress            (stress),
            .saturated         (saturated),
            .not_finite        (not_finite)
        );
    end else begin : gen_stress
        assign exponent = 10'sd0;
        assign stress = count;
        assign saturated = count_saturated;
        assign not_finite = count_not_finite;
        wire _unused = &{1'b0, exponent, OFFSET_BITS != 0, COUNT_SHIFT != 0, FULL_SCALE, STRESS_BOUND,
            TAXEL_NAME != ""};
    end

    wire _unused_bank = &{1'b0, EXPONENT, GAIN, bank_constants, bank_knots, bank_segments, bank_last,
        bank_reach, bank_line, ROM_DIR != "", ROM_NAME != ""};

endmodule

`default_nettype wire
