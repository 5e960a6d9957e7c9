// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Quotient or square root of significands, a bit a cycle: a / b, or the root of a, of 2 a if it is doubled.
//
// Significands are from 1 to 2, with 23 fraction bits. Digits have 25 fraction bits, rounded down; rest says whether
// something is left. In each cycle a digit's weight is tried: the remainder, doubled since the digit before, less b,
// or less twice the root so far and the weight. From start to done: 27 cycles for a quotient, 26 for a root.

`default_nettype none

module sptfra_float_digits (
    input  wire clock,
    input  wire reset,            // gives up what is under way
    input  wire start,            // with these; b is held until done
    input  wire root,             // held, too
    input  wire doubled,
    input  wire [23:0] a,
    input  wire [23:0] b,
    output reg  done,             // one cycle
    output reg  [25:0] digits,    // held until the next start
    output wire rest
);

    reg [28:0] remainder; // 25 fraction bits, as all below
    reg [25:0] weight; // one bit of it is set, none when nothing is under way
    wire [28:0] subtrahend = root ? ({2'd0, digits, 1'b0} | {3'd0, weight}) : {3'd0, b, 2'd0};
    wire [29:0] trial = {1'b0, remainder} - {1'b0, subtrahend};
    wire fits = !trial[29];

    assign rest = (remainder != 29'd0);

    always @(posedge clock) begin
        done <= weight[0];
        weight <= weight >> 1;
        if (weight != 26'd0) begin
            remainder <= (fits ? trial[28:0] : remainder) << 1;
            digits <= digits | (fits ? weight : 26'd0);
        end
        if (start) begin
            // A root begins behind its first digit, which is 1
            weight <= root ? 26'h1000000 : 26'h2000000;
            digits <= root ? 26'h2000000 : 26'd0;
            if (!root) begin
                remainder <= {3'd0, a, 2'd0};
            end else if (doubled) begin
                remainder <= {1'b0, a[22], !a[22], a[21:0], 4'd0};
            end else begin
                remainder <= {3'd0, a[22:0], 3'd0};
            end
        end
        if (reset) begin
            weight <= 26'd0;
            done <= 1'b0;
        end
    end

endmodule

`default_nettype wire
