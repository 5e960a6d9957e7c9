// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// 64-bit fixed point to float32: float_bits = fixed * 2^exponent, rounded to nearest even.
//
// Latency 7 enabled cycles (magnitude, four of normalisation, rounding, zeros and infinities), one value an enabled
// cycle. Zero gives +0; what rounds to less than 2^-126 becomes a zero of its sign, what exceeds the largest finite
// number an infinity.

`default_nettype none

module sptfra_fixed_to_float (
    input  wire clock,                  // rising edge
    input  wire enable,                 // every stage advances; else all hold
    input  wire signed [63:0] fixed,    // two's complement integer
    input  wire signed [9:0] exponent,  // power of two it is multiplied by; sampled with fixed
    output wire [31:0] float_bits       // IEEE 754 single precision
);

    reg negative_m;
    reg [63:0] magnitude;
    reg signed [10:0] scale_m;
    reg negative_g;
    reg [63:0] whole;
    reg first_group;
    reg second_group;
    reg third_group;
    reg signed [10:0] scale_g;
    reg negative_c;
    reg [63:0] coarse;
    reg [1:0] coarse_zeros;
    reg signed [10:0] scale_c;
    reg negative_f;
    reg [63:0] by_four;
    reg [3:0] fine_zeros;
    reg signed [10:0] scale_f;
    reg negative_n;
    reg [39:0] normal;
    reg sticky_n;
    reg [10:0] biased;
    reg negative_r;
    reg is_zero_r;
    reg [33:0] rounded;
    reg [31:0] result;

    reg [63:0] by_one;
    reg [1:0] zeros_one;

    // sign and magnitude; the biased exponent if the leading one were bit 63
    wire [63:0] pattern = $unsigned(fixed);

    always @(posedge clock) begin
        if (enable) begin
            negative_m <= pattern[63];
            magnitude <= pattern;
            if (pattern[63]) begin
                magnitude <= ~pattern + 64'd1;
            end
            scale_m <= $signed({exponent[9], exponent}) + 11'sd190;
        end
    end

    // groups of 16 bits with a one among them
    always @(posedge clock) begin
        if (enable) begin
            negative_g <= negative_m;
            scale_g <= scale_m;
            whole <= magnitude;
            first_group <= |magnitude[63:48];
            second_group <= |magnitude[47:32];
            third_group <= |magnitude[31:16];
        end
    end

    // leading zeros in steps of 16
    always @(posedge clock) begin
        if (enable) begin
            negative_c <= negative_g;
            scale_c <= scale_g;
            if (first_group) begin
                coarse <= whole;
                coarse_zeros <= 2'd0;
            end else if (second_group) begin
                coarse <= whole << 16;
                coarse_zeros <= 2'd1;
            end else if (third_group) begin
                coarse <= whole << 32;
                coarse_zeros <= 2'd2;
            end else begin
                coarse <= whole << 48;
                coarse_zeros <= 2'd3;
            end
        end
    end

    // leading zeros in steps of 4
    wire [3:0] found_zeros = {2'd0, coarse_zeros} << 2;

    always @(posedge clock) begin
        if (enable) begin
            negative_f <= negative_c;
            scale_f <= scale_c;
            if (|coarse[63:60]) begin
                by_four <= coarse;
                fine_zeros <= found_zeros;
            end else if (|coarse[59:56]) begin
                by_four <= coarse << 4;
                fine_zeros <= found_zeros | 4'd1;
            end else if (|coarse[55:52]) begin
                by_four <= coarse << 8;
                fine_zeros <= found_zeros | 4'd2;
            end else begin
                by_four <= coarse << 12;
                fine_zeros <= found_zeros | 4'd3;
            end
        end
    end

    // leading zeros in steps of 1
    always @(*) begin
        if (by_four[63]) begin
            by_one = by_four;
            zeros_one = 2'd0;
        end else if (by_four[62]) begin
            by_one = by_four << 1;
            zeros_one = 2'd1;
        end else if (by_four[61]) begin
            by_one = by_four << 2;
            zeros_one = 2'd2;
        end else begin
            by_one = by_four << 3;
            zeros_one = 2'd3;
        end
    end

    wire [10:0] zeros = ({7'd0, fine_zeros} << 2) | {9'd0, zeros_one};
    wire [10:0] scale_bits = $unsigned(scale_f);

    always @(posedge clock) begin
        if (enable) begin
            negative_n <= negative_f;
            normal <= by_one[63:24];
            sticky_n <= |by_four[23:0];
            biased <= scale_bits - zeros;
        end
    end

    // round to nearest even: a carry out of the fraction raises the exponent above it
    wire sticky = sticky_n || (|normal[14:0]);
    wire up = normal[15] && (sticky || normal[16]);

    always @(posedge clock) begin
        if (enable) begin
            negative_r <= negative_n;
            is_zero_r <= !normal[39];
            rounded <= (({23'd0, biased} << 23) | {11'd0, normal[38:16]}) + {33'd0, up};
        end
    end

    // zeros and infinities
    wire [10:0] exponent_out = rounded[33:23];
    wire vanishes = exponent_out[10] || (exponent_out == 11'd0);
    wire overflows = exponent_out >= 11'd255;
    wire [31:0] sign = {31'd0, negative_r} << 31;

    always @(posedge clock) begin
        if (enable) begin
            if (vanishes || is_zero_r) begin
                result <= sign;
            end else if (overflows) begin
                result <= sign | 32'h7f800000;
            end else begin
                result <= sign | {1'b0, rounded[30:0]};
            end
        end
    end

    assign float_bits = result;

    // Bits left unread on purpose.
    wire _unused = &{1'b0, by_one};

endmodule

`default_nettype wire
