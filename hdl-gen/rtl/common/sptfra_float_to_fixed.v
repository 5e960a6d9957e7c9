// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// float32 to 27-bit fixed point: fixed = float_bits * 2^shift, rounded half away from zero, clipped to +-limit.
//
// Latency 5 cycles (distance, unpack, shift, round, clip), one value a cycle. Denormals count as zero.
// saturated: the rounded magnitude is limit or more. NaN gives 0 with not_finite; an infinity gives +-limit with
// saturated and not_finite.

`default_nettype none

module sptfra_float_to_fixed (
    input  wire clock,                // rising edge
    input  wire [31:0] float_bits,    // IEEE 754 single precision
    input  wire signed [9:0] shift,   // the result's binary point; sampled with float_bits
    input  wire [26:0] limit,         // largest magnitude, below 2^26; constant while conversions are under way
    output wire signed [26:0] fixed,  // the value
    output wire saturated,            // the rounded magnitude reached limit
    output wire not_finite            // float_bits was NaN or an infinity
);

    reg [31:0] float_d;
    reg [11:0] distance;
    reg negative_u;
    reg not_finite_u;
    reg overflow_u;
    reg [23:0] significand;
    reg [4:0] right;
    reg negative_s;
    reg not_finite_s;
    reg overflow_s;
    reg [27:0] doubled;
    reg negative_r;
    reg not_finite_r;
    reg over;
    reg [26:0] rounded;
    reg signed [26:0] value;
    reg clipped;
    reg not_finite_c;

    reg [26:0] magnitude;

    // distance: how far right the significand goes in a 28-bit window with one fraction bit
    wire [11:0] exponent_bits = {4'd0, float_bits[30:23]};
    wire signed [11:0] shift_wide = $signed({{2{shift[9]}}, shift});

    always @(posedge clock) begin
        float_d <= float_bits;
        distance <= (12'd153 - exponent_bits) - $unsigned(shift_wide);
    end

    // unpack
    wire [7:0] exponent = float_d[30:23];
    wire is_special = exponent == 8'd255;
    wire is_zero = exponent == 8'd0;
    wire too_large = distance[11];
    wire too_small = !too_large && (|distance[10:5]);

    always @(posedge clock) begin
        negative_u <= float_d[31];
        not_finite_u <= is_special;
        right <= distance[4:0];
        overflow_u <= too_large && !is_zero;
        significand <= {1'b0, float_d[22:0]} | 24'h800000;
        if (is_zero || too_small) begin
            significand <= 24'd0;
        end
        if (is_special) begin
            significand <= 24'd0;
            overflow_u <= !(|float_d[22:0]);
        end
    end

    // shift
    always @(posedge clock) begin
        negative_s <= negative_u;
        not_finite_s <= not_finite_u;
        overflow_s <= overflow_u;
        doubled <= ({4'd0, significand} << 4) >> right;
    end

    // round half away from zero; the comparison with what is rounded to limit does not wait for that
    wire [27:0] threshold = ({1'b0, limit} << 1) - 28'd1;

    always @(posedge clock) begin
        negative_r <= negative_s;
        not_finite_r <= not_finite_s;
        over <= overflow_s || (doubled >= threshold);
        rounded <= doubled[27:1] + {26'd0, doubled[0]};
    end

    // clip, negate
    always @(*) begin
        if (over) begin
            magnitude = limit;
        end else begin
            magnitude = rounded;
        end
    end

    wire signed [26:0] positive = $signed(magnitude);

    always @(posedge clock) begin
        clipped <= over;
        not_finite_c <= not_finite_r;
        if (negative_r) begin
            value <= -positive;
        end else begin
            value <= positive;
        end
    end

    assign fixed = value;
    assign saturated = clipped;
    assign not_finite = not_finite_c;

endmodule

`default_nettype wire
