// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiplier of one DSP block of 27 by 18 bits: coefficient * data = low + high, high being zero.
//
// Latency 1 enabled cycle, one product a cycle. Operands of 18 and 27 bits and products of 45 are two's complement
// integers. The two parts let the adder behind be the same as on fabrics that multiply in two pieces.

`default_nettype none

module sptfra_multiply (
    input  wire clock,                      // rising edge
    input  wire enable,                     // the product follows the operands; else it holds
    input  wire signed [17:0] coefficient,  // left operand
    input  wire signed [26:0] data,         // right operand
    output wire signed [44:0] low,          // one part of the product
    output wire signed [44:0] high          // the other
);

    reg signed [44:0] product;

    always @(posedge clock) begin
        if (enable) begin
            product <= coefficient * data;
        end
    end

    assign low = product;
    assign high = 45'sd0;

endmodule

`default_nettype wire
