// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Decoder of the stream's samples, float32 or 16-bit integers: number = sample * 2^shift, clipped to limit.
//
// Latency 5 enabled cycles, one sample an enabled cycle.

`default_nettype none

module sptfra_decode #(
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign
    parameter SAMPLE = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16
) (
    input  wire clock,
    input  wire [SAMPLE_BITS-1:0] sample,
    input  wire signed [9:0] shift, // sampled with the sample
    input  wire [26:0] limit, // constant while samples are under way
    output wire signed [26:0] number,
    output wire saturated, // the magnitude is limit or more
    output wire not_finite
);

    generate
        if (SAMPLE == 0) begin : gen_float
            sptfra_float_to_fixed float_to_fixed (
                .clock      (clock),
                .enable     (1'b1),
                .float_bits (sample),
                .shift      (shift),
                .limit      (limit),
                .fixed      (number),
                .saturated  (saturated),
                .not_finite (not_finite)
            );
        end else begin : gen_integer
            sptfra_int_to_fixed #(
                .SIGNED ((SAMPLE == 1) ? 1 : 0)
            ) int_to_fixed (
                .clock     (clock),
                .enable    (1'b1),
                .count     (sample),
                .shift     (shift),
                .limit     (limit),
                .fixed     (number),
                .saturated (saturated)
            );

            assign not_finite = 1'b0;
        end
    endgenerate

endmodule

`default_nettype wire
