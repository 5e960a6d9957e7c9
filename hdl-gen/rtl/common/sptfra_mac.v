// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane: sums coefficient * data in one DSP block of 27 by 18 bits.
//
// Latency 3 cycles (operands, product, accumulator), one product a cycle. Operands of 18 and 27 bits and the
// accumulator of 48 are two's complement integers; the binary point is the user's. The accumulator wraps; a sum of up
// to 15 products, and any sum whose coefficients add up to less than 2^21 in magnitude, never does.

`default_nettype none

module sptfra_mac (
    input  wire clock,                      // rising edge
    input  wire reset,                      // synchronous, high: discards products under way, keeps the accumulator
    input  wire valid,                      // the operands count
    input  wire first,                      // with valid: start a new sum with this product
    input  wire signed [17:0] coefficient,  // left operand
    input  wire signed [26:0] data,         // right operand
    output wire signed [47:0] accumulator   // the sum, three cycles after the operands; holds without valid ones
);

    reg valid_a;
    reg first_a;
    reg signed [17:0] coefficient_a;
    reg signed [26:0] data_a;
    reg valid_m;
    reg first_m;
    reg signed [44:0] product;
    reg signed [47:0] sum;

    reg signed [47:0] base;

    // operands
    always @(posedge clock) begin
        valid_a <= valid && !reset;
        first_a <= first;
        coefficient_a <= coefficient;
        data_a <= data;
    end

    // product
    always @(posedge clock) begin
        valid_m <= valid_a && !reset;
        first_m <= first_a;
        product <= coefficient_a * data_a;
    end

    // sum: adding to a selected zero, rather than selecting the sum, is what fits the adder of a DSP block
    wire signed [47:0] addend = $signed({{3{product[44]}}, product});

    always @(*) begin
        base = sum;
        if (first_m) begin
            base = 48'sd0;
        end
    end

    always @(posedge clock) begin
        if (valid_m) begin
            sum <= base + addend;
        end
    end

    assign accumulator = sum;

endmodule

`default_nettype wire
