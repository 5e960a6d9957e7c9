// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The converter of Bz with its function left out: three bits of a word come out after as many cycles.
module sptfra_float_to_fixed (
    input wire clock,
    input wire [31:0] float_bits,
    input wire signed [9:0] shift,
    input wire [26:0] limit,
    output wire signed [26:0] fixed,
    output wire saturated,
    output wire not_finite,
    output reg [14:0] stages // stage 1 in the lowest bits
);

    assign fixed = {26'd0, stages[12]};
    assign saturated = stages[13];
    assign not_finite = stages[14];

    always @(posedge clock) begin
        stages <= {stages[11:0], float_bits[2:0]};
    end

endmodule
