// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiplier of one DSP block of 27 by 18 bits, or of two: coefficient * data.
//
// Latency 1 enabled cycle, one product a cycle. All are two's complement integers. Of two blocks, one has the data's
// lower 17 bits, the other its upper 18; their products are joined behind their registers.

`default_nettype none

module sptfra_multiply #(
    // Two DSP blocks, else one
    parameter WIDE = 0,
    // Derived
    parameter DATA_BITS = WIDE ? 35 : 27
) (
    input  wire clock,
    input  wire enable, // the product follows the operands; else it holds
    input  wire signed [17:0] coefficient,
    input  wire signed [DATA_BITS-1:0] data,
    output wire signed [DATA_BITS+17:0] product
);

    if (WIDE) begin : gen_two_blocks
        wire signed [17:0] data_low = {1'b0, data[16:0]};
        wire signed [DATA_BITS-18:0] data_high = data[DATA_BITS-1:17];
        reg signed [35:0] product_low;
        reg signed [DATA_BITS:0] product_high;

        always @(posedge clock) begin
            if (enable) begin
                product_low <= coefficient * data_low;
                product_high <= coefficient * data_high;
            end
        end

        assign product = {{(DATA_BITS-18){product_low[35]}}, product_low} + {product_high, 17'd0};
    end else begin : gen_one_block
        reg signed [44:0] product_1;

        always @(posedge clock) begin
            if (enable) begin
                product_1 <= coefficient * data;
            end
        end

        assign product = product_1;
    end

endmodule

`default_nettype wire
