// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane: sums coefficient * data in one DSP block of 27 by 18 bits, or in two.
//
// Latency 3 cycles (operands, products, accumulator), one product a cycle. All are two's complement integers. One
// block takes 18 by 27 bits; sums of up to 15 products never wrap its accumulator. Two blocks take 27 by 35 bits.
// They round each product / 2^17 to the nearest integer, ties upwards: cut bits would add up to a bias. A DSP48E2
// takes the product with the lower 17 bits, shifted by 17, from the block below.

`default_nettype none

module sptfra_mac #(
    // Two DSP blocks, else one
    parameter WIDE = 0,
    // Derived
    parameter COEFFICIENT_BITS = WIDE ? 27 : 18,
    parameter DATA_BITS = WIDE ? 35 : 27
) (
    input  wire clock,
    input  wire reset, // discards products under way, keeps the accumulator
    input  wire valid, // the operands count
    input  wire first, // with valid: start a new sum with this product
    input  wire signed [COEFFICIENT_BITS-1:0] coefficient,
    input  wire signed [DATA_BITS-1:0] data,
    output wire signed [47:0] accumulator // the sum, three cycles after the operands; holds without valid ones
);

    reg valid_a;
    reg first_a;
    reg signed [COEFFICIENT_BITS-1:0] coefficient_a;
    reg signed [DATA_BITS-1:0] data_a;
    reg valid_m;
    reg first_m;
    reg signed [47:0] sum;
    wire signed [47:0] addend;

    assign accumulator = sum;

    always @(posedge clock) begin
        valid_a <= valid && !reset;
        first_a <= first;
        coefficient_a <= coefficient;
        data_a <= data;
        valid_m <= valid_a && !reset;
        first_m <= first_a;
        // Adding to a selected zero, rather than selecting the sum, is what fits the adder of a DSP block
        if (valid_m) begin
            sum <= (first_m ? 48'sd0 : sum) + addend;
        end
    end

    if (WIDE) begin : gen_two_blocks
        localparam signed [44:0] HALF = 45'sd65536; // of what is dropped
        wire signed [17:0] data_low = {1'b0, data_a[16:0]};
        wire signed [17:0] data_high = data_a[34:17];
        reg signed [44:0] low;
        reg signed [44:0] high;

        always @(posedge clock) begin
            low <= coefficient_a * data_low + HALF;
            high <= coefficient_a * data_high;
        end

        assign addend = $signed({{3{high[44]}}, high}) + $signed({{20{low[44]}}, low[44:17]});

        wire _unused = &{1'b0, low[16:0]};
    end else begin : gen_one_block
        reg signed [44:0] product;

        always @(posedge clock) begin
            product <= coefficient_a * data_a;
        end

        // Extended in a wire of its own: it is what a DSP block takes
        assign addend = {{3{product[44]}}, product};
    end

endmodule

`default_nettype wire
