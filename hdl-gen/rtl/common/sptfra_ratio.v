// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Two quotients of one denominator, or one, side by side, a bit a cycle:
// numerator * 2^(BITS - INTEGER_BITS) / denominator, rounded down, for quotients below 2^BITS.
//
// Start in cycle 0 gives done, for one cycle, in cycle BITS + 1. A denominator of zero gives all ones.

`default_nettype none

module sptfra_ratio #(
    // Bits of numerators and denominator, all of them not negative
    parameter integer WIDTH = 40,
    // A numerator is below 2^INTEGER_BITS denominators
    parameter integer INTEGER_BITS = 6,
    // Bits of a quotient
    parameter integer BITS = 22,
    // Quotients: x and y, or x alone
    parameter integer QUOTIENTS = 2
) (
    input  wire clock,
    input  wire reset, // gives up the divisions under way
    input  wire start, // takes the operands
    input  wire [WIDTH-1:0] numerator_x,
    input  wire [WIDTH-1:0] numerator_y,
    input  wire [WIDTH-1:0] denominator,
    output reg  done, // one cycle
    output wire [BITS-1:0] quotient_x, // held until the next start
    output wire [BITS-1:0] quotient_y // 0 with one
);

    // A remainder is below two of the largest multiples of the denominator that are tried, the first one
    localparam integer WIDE = WIDTH + INTEGER_BITS;
    localparam integer COUNT_WIDTH = $clog2(BITS + 1);

    if ((INTEGER_BITS < 1) || (BITS <= INTEGER_BITS)) begin : gen_check
        sptfra_error_a_quotient_needs_integer_and_fraction_bits invalid ();
    end

    reg [COUNT_WIDTH-1:0] left; // bits to come, and one
    reg [WIDE-1:0] divisor; // denominator * 2^(INTEGER_BITS - 1)

    always @(posedge clock) begin
        done <= (left == 2) && !start && !reset;
        if (left != 0) begin
            left <= left - 1'b1;
        end
        if (start) begin
            left <= BITS[COUNT_WIDTH-1:0] + 1'b1;
            divisor <= {1'b0, denominator, {(INTEGER_BITS - 1){1'b0}}};
        end
        if (reset) begin
            left <= {COUNT_WIDTH{1'b0}};
        end
    end

    wire [2*WIDTH-1:0] numerators = {numerator_y, numerator_x};
    wire [QUOTIENTS*BITS-1:0] quotients;
    genvar index;

    assign quotient_x = quotients[BITS-1:0];
    assign quotient_y = (QUOTIENTS == 2) ? quotients[QUOTIENTS*BITS-1 -: BITS] : {BITS{1'b0}};

    for (index = 0; index < QUOTIENTS; index = index + 1) begin : gen_quotients
        reg [BITS-1:0] quotient;
        reg [WIDE-1:0] remainder;
        wire [WIDE:0] trial = {1'b0, remainder} - {1'b0, divisor};

        assign quotients[BITS*index +: BITS] = quotient;

        always @(posedge clock) begin
            if (left > 1) begin
                quotient <= {quotient[BITS-2:0], !trial[WIDE]};
                remainder <= (trial[WIDE] ? remainder : trial[WIDE-1:0]) << 1;
            end
            if (start) begin
                remainder <= { {INTEGER_BITS{1'b0}}, numerators[WIDTH*index +: WIDTH]};
            end
        end
    end

    wire _unused = &{1'b0, numerators};

endmodule

`default_nettype wire
