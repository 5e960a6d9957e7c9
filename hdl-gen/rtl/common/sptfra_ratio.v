// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Two quotients of one denominator, side by side, a bit a cycle: numerator * 2^(BITS - INTEGER_BITS) / denominator,
// rounded down, for quotients below 2^BITS.
//
// Start in cycle 0 gives done, for one cycle, in cycle BITS + 1. A denominator of zero gives all ones.

`default_nettype none

module sptfra_ratio #(
    // Bits of numerators and denominator, all of them not negative
    parameter integer WIDTH = 40,
    // A numerator is below 2^INTEGER_BITS denominators
    parameter integer INTEGER_BITS = 6,
    // Bits of a quotient
    parameter integer BITS = 22
) (
    input  wire clock,
    input  wire reset, // gives up the divisions under way
    input  wire start, // takes the operands
    input  wire [WIDTH-1:0] numerator_x,
    input  wire [WIDTH-1:0] numerator_y,
    input  wire [WIDTH-1:0] denominator,
    output reg  done, // one cycle
    output reg  [BITS-1:0] quotient_x, // held until the next start
    output reg  [BITS-1:0] quotient_y
);

    // A remainder is below two of the largest multiples of the denominator that are tried, the first one
    localparam integer WIDE = WIDTH + INTEGER_BITS;
    localparam integer COUNT_WIDTH = $clog2(BITS + 1);

    if ((INTEGER_BITS < 1) || (BITS <= INTEGER_BITS)) begin : gen_check
        sptfra_error_a_quotient_needs_integer_and_fraction_bits invalid ();
    end

    reg [COUNT_WIDTH-1:0] left; // bits to come, and one
    reg [WIDE-1:0] divisor; // denominator * 2^(INTEGER_BITS - 1)
    reg [WIDE-1:0] remainder_x;
    reg [WIDE-1:0] remainder_y;
    wire [WIDE:0] trial_x = {1'b0, remainder_x} - {1'b0, divisor};
    wire [WIDE:0] trial_y = {1'b0, remainder_y} - {1'b0, divisor};

    always @(posedge clock) begin
        done <= (left == 2) && !start && !reset;
        if (left != 0) begin
            left <= left - 1'b1;
        end
        if (left > 1) begin
            quotient_x <= {quotient_x[BITS-2:0], !trial_x[WIDE]};
            quotient_y <= {quotient_y[BITS-2:0], !trial_y[WIDE]};
            remainder_x <= (trial_x[WIDE] ? remainder_x : trial_x[WIDE-1:0]) << 1;
            remainder_y <= (trial_y[WIDE] ? remainder_y : trial_y[WIDE-1:0]) << 1;
        end
        if (start) begin
            left <= BITS[COUNT_WIDTH-1:0] + 1'b1;
            divisor <= {1'b0, denominator, {(INTEGER_BITS - 1){1'b0}}};
            remainder_x <= { {INTEGER_BITS{1'b0}}, numerator_x};
            remainder_y <= { {INTEGER_BITS{1'b0}}, numerator_y};
        end
        if (reset) begin
            left <= {COUNT_WIDTH{1'b0}};
        end
    end

endmodule

`default_nettype wire
