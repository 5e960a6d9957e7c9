// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Samples to stress by gains and offsets of a calibration in RAM: a gain is an exponent for the decoder and a mantissa.
//
// Sample to stress: 10 cycles, one a cycle. Names end in the number of cycles since the sample came in.

`default_nettype none

module sptfra_calibrate #(
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign, 3 a curve's value
    parameter SAMPLE = 0,
    // A step of a curve's value is 2^VALUE_LSB Pa
    parameter integer VALUE_LSB = 0,
    // Largest magnitude of a number: what reaches it is beyond the full scale by every gain
    parameter [26:0] NUMBER_BOUND = 27'd67108863,
    parameter OFFSET_BITS = 29,
    // Bits dropped of the product
    parameter COUNT_SHIFT = 14,
    // Full scale, less what rounding may take from it, and what a larger stress becomes
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : (SAMPLE == 3) ? 27 : 16
) (
    input  wire clock,
    input  wire advance,
    input  wire [SAMPLE_BITS-1:0] sample,
    // Of a curve's value: its count was at an end of the curve, or no number
    input  wire beyond,
    input  wire no_number,
    // The taxel's gain, {exponent, mantissa}, and offset: a cycle after its sample
    input  wire [27:0] gain_1,
    input  wire [OFFSET_BITS-1:0] offset_1,
    // Stress
    output reg  signed [26:0] stress,
    output reg  saturated,
    output wire not_finite
);

    localparam signed [47:0] HALF = (48'sd1 <<< COUNT_SHIFT) >>> 1;

    // ---- Number: behind the memory stands a register
    reg [SAMPLE_BITS-1:0] sample_1;
    reg [SAMPLE_BITS-1:0] sample_2;
    reg [2:1] beyond_to;
    reg [7:1] no_number_to;
    reg signed [9:0] exponent_2;
    reg [6*18-1:0] mantissas; // of stages 7 to 2
    reg [7*OFFSET_BITS-1:0] offsets_to; // of stages 8 to 2
    wire signed [26:0] number_7;
    wire number_saturated_7;
    wire not_finite_7;

    always @(posedge clock) begin
        if (advance) begin
            sample_1 <= sample;
            sample_2 <= sample_1;
            beyond_to <= {beyond_to[1], beyond};
            no_number_to <= {no_number_to[6:1], no_number};
            exponent_2 <= $signed(gain_1[27:18]);
            mantissas <= {mantissas[5*18-1:0], gain_1[17:0]};
            offsets_to <= {offsets_to[6*OFFSET_BITS-1:0], offset_1};
        end
    end

    generate
        if (SAMPLE == 3) begin : gen_value
            sptfra_int_to_fixed #(
                .BITS (27),
                .BIAS (VALUE_LSB)
            ) rescale (
                .clock     (clock),
                .enable    (advance),
                .count     (sample_2),
                .beyond    (beyond_to[2]),
                .shift     (exponent_2),
                .limit     (NUMBER_BOUND),
                .fixed     (number_7),
                .saturated (number_saturated_7)
            );

            assign not_finite_7 = no_number_to[7];
        end else begin : gen_sample
            sptfra_decode #(
                .SAMPLE (SAMPLE)
            ) decode (
                .clock      (clock),
                .enable     (advance),
                .sample     (sample_2),
                .shift      (exponent_2),
                .limit      (NUMBER_BOUND),
                .number     (number_7),
                .saturated  (number_saturated_7),
                .not_finite (not_finite_7)
            );

            wire _unused_value = &{1'b0, VALUE_LSB != 0, beyond_to, no_number_to};
        end
    endgenerate

    // ---- Product, sum, clipping
    wire signed [44:0] product_low_8; // the product is their sum
    wire signed [44:0] product_high_8;
    wire signed [47:0] product_half = {{3{product_low_8[44]}}, product_low_8}
        + {{3{product_high_8[44]}}, product_high_8} + HALF;
    wire [OFFSET_BITS-1:0] offset_8 = offsets_to[7*OFFSET_BITS-1 -: OFFSET_BITS];
    wire signed [47:0] offset_wide_8 = {{(48-OFFSET_BITS){offset_8[OFFSET_BITS-1]}}, offset_8};
    reg signed [47:0] sum_9;
    reg [10:8] not_finite_to;
    wire above = (sum_9 >= FULL_SCALE);
    wire below = (sum_9 <= -FULL_SCALE);

    assign not_finite = not_finite_to[10];

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (advance),
        .coefficient (mantissas[6*18-1 -: 18]),
        .data        (number_7),
        .low         (product_low_8),
        .high        (product_high_8)
    );

    always @(posedge clock) begin
        if (advance) begin
            sum_9 <= (product_half >>> COUNT_SHIFT) + offset_wide_8;
            stress <= above ? STRESS_BOUND : below ? -STRESS_BOUND : sum_9[26:0];
            saturated <= above || below;
            not_finite_to <= {not_finite_to[9:8], not_finite_7};
        end
    end

    // A number at its bound is beyond the full scale by every gain that a bank takes
    wire _unused = &{1'b0, number_saturated_7};

endmodule

`default_nettype wire
