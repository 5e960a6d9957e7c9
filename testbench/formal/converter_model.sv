// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The converter to float32 with its function left out: exponent and low bits come out after as many cycles.
module sptfra_fixed_to_float (
    input wire clock,
    input wire enable,
    input wire signed [63:0] fixed,
    input wire signed [9:0] exponent,
    output wire [31:0] float_bits,
    output reg [32*7-1:0] stages // the latest in the lowest bits
);

    assign float_bits = stages[32*6 +: 32];

    always @(posedge clock) begin
        if (enable) begin
            stages <= {stages[32*6-1:0], exponent, fixed[21:0]};
        end
    end

endmodule
