// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiplier made of two of 18 by 18 bits, for Lattice ECP5: coefficient * data = low + high modulo 2^45.
//
// Latency 1 enabled cycle, one product a cycle. Operands of 18 and 27 bits and the parts of 45 are two's complement
// integers. The parts are left for the adder behind to join with its own addend.

`default_nettype none

module sptfra_multiply (
    input  wire clock,                      // rising edge
    input  wire enable,                     // the product follows the operands; else it holds
    input  wire signed [17:0] coefficient,  // left operand
    input  wire signed [26:0] data,         // right operand
    output wire signed [44:0] low,          // one part of the product
    output wire signed [44:0] high          // the other
);

    reg signed [35:0] product_low;
    reg signed [27:0] product_high;

    // products with the lower 17 bits of the data and with the upper 10
    wire [26:0] data_bits = $unsigned(data);
    wire [17:0] lower = {1'b0, data_bits[16:0]};
    wire [9:0] upper = data_bits[26:17];
    wire signed [17:0] data_low = $signed(lower);
    wire signed [9:0] data_high = $signed(upper);
    wire signed [44:0] high_wide = $signed({{17{product_high[27]}}, product_high});

    always @(posedge clock) begin
        if (enable) begin
            product_low <= coefficient * data_low;
            product_high <= coefficient * data_high;
        end
    end

    assign low = $signed({{9{product_low[35]}}, product_low});
    assign high = high_wide << 17;

endmodule

`default_nettype wire
