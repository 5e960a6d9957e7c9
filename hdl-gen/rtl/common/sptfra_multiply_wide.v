// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiplier of two DSP blocks of 27 by 18 bits: coefficient * data = low + high.
//
// Latency 1 enabled cycle, one product a cycle. low is the product with the data's lower 17 bits, high that with its
// upper 18.

`default_nettype none

module sptfra_multiply_wide (
    input  wire clock,                      // rising edge
    input  wire enable,                     // the product follows the operands; else it holds
    input  wire signed [17:0] coefficient,  // left operand
    input  wire signed [34:0] data,         // right operand
    output wire signed [52:0] low,          // one part of the product
    output wire signed [52:0] high          // the other
);

    wire signed [17:0] data_low = {1'b0, data[16:0]};
    wire signed [17:0] data_high = data[34:17];
    reg signed [35:0] product_low;
    reg signed [35:0] product_high;

    always @(posedge clock) begin
        if (enable) begin
            product_low <= coefficient * data_low;
            product_high <= coefficient * data_high;
        end
    end

    assign low = {{17{product_low[35]}}, product_low};
    assign high = {product_high, 17'd0};

endmodule

`default_nettype wire
