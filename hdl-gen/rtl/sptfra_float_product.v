// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Product of two significands of 24 bits by one multiplier of 18 by 27 bits, used twice: for the lower half of b,
// then for the upper one.
//
// Latency: 3 cycles from start to the product, which holds for that cycle; operands hold meanwhile.

`default_nettype none

module sptfra_float_product (
    input  wire clock,
    input  wire start,
    input  wire [23:0] a,
    input  wire [23:0] b,
    output wire [47:0] product
);

    reg upper; // the half at the multiplier
    wire [11:0] half = upper ? b[23:12] : b[11:0];
    wire signed [44:0] low;
    wire signed [44:0] high;
    reg [35:0] sum; // of the half that was multiplied last
    reg [35:0] sum_before;
    wire [44:0] joined = low + high;

    sptfra_multiply multiply (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({6'd0, half}),
        .data        ({3'd0, a}),
        .low         (low),
        .high        (high)
    );

    always @(posedge clock) begin
        upper <= start;
        sum <= joined[35:0];
        sum_before <= sum;
    end

    wire [35:0] above = sum + {12'd0, sum_before[35:12]};

    assign product = {above, sum_before[11:0]};

    wire _unused = &{1'b0, joined[44:36]};

endmodule

`default_nettype wire
