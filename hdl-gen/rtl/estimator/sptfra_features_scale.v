// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The scale of the features: 1 / sum |b|, during the grid search.
//
// The leading bit of sum |b| goes to the top, then 2^56 is divided by it: the reciprocal of 17 bits is there 8 cycles
// and a division after start.

`default_nettype none

module sptfra_features_scale (
    input  wire clock,
    input  wire reset,
    // Reciprocal: sum |b| is held from the cycle after start on
    input  wire start,
    input  wire [39:0] stress_sum,
    output wire [5:0] sum_bits, // of stress_sum
    output reg  signed [17:0] reciprocal // 2^-(16 + sum_bits) a step
);

    localparam integer SUM_BITS = 40;
    localparam integer RECIPROCAL_BITS = 16;
    localparam [63:0] NUMERATOR = 64'd1 << (SUM_BITS + RECIPROCAL_BITS);


    // ---- sum |b|, its leading bit at the top
    wire [5:0] found_bits;
    reg [5:0] bits;
    reg [39:0] sum_octets;
    reg [39:0] normalised;
    reg [2:0] prepare; // cycles since the start
    wire [5:0] to_top = SUM_BITS[5:0] - bits;

    assign sum_bits = bits;

    sptfra_leading_bit #(
        .WIDTH (SUM_BITS)
    ) leading_bit (
        .clock (clock),
        .value (stress_sum),
        .bits  (found_bits)
    );

    // ---- Reciprocal
    reg inverting;
    wire divide_done;
    wire [63:0] quotient;
    wire invert = (prepare == 3'd6);

    sptfra_divider divider (
        .clock       (clock),
        .reset       (reset),
        .start       (invert),
        .numerator   (NUMERATOR),
        .denominator ({8'd0, normalised}),
        .quotient    (quotient),
        .done        (divide_done)
    );

    always @(posedge clock) begin
        bits <= found_bits;
        sum_octets <= stress_sum << {to_top[5:3], 3'd0};
        normalised <= sum_octets << to_top[2:0];
        if (prepare != 3'd0) begin
            prepare <= prepare + 3'd1;
        end
        if (invert) begin
            prepare <= 3'd0;
            inverting <= 1'b1;
        end
        if (start) begin
            prepare <= 3'd1;
        end
        if (divide_done && inverting) begin
            inverting <= 1'b0;
            reciprocal <= (quotient[63:17] == 47'd0) ? {1'b0, quotient[16:0]} : 18'sd131071;
        end
        if (reset) begin
            prepare <= 3'd0;
            inverting <= 1'b0;
        end
    end

endmodule

`default_nettype wire
