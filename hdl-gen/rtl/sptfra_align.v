// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// float32 to whole numbers of steps of 2^unit, rounded towards zero; what does not fit is clipped. Denormals are
// zero.
//
// Latency 3 enabled cycles to the magnitude (distance, coarse shift, fine shift), 4 to the number; one value an
// enabled cycle.

`default_nettype none

module sptfra_align #(
    // Bits of a number, 26 to 64
    parameter WIDTH = 27
) (
    input  wire clock,
    input  wire enable, // every stage advances; else all hold
    input  wire [31:0] float_bits,
    input  wire signed [9:0] unit, // sampled with float_bits
    output reg  [WIDTH-2:0] magnitude,
    output reg  negative, // with magnitude
    output reg  clipped, // the same
    output reg  signed [WIDTH-1:0] fixed
);

    generate
        if ((WIDTH < 26) || (WIDTH > 64)) begin : gen_check_width
            sptfra_error_width_must_be_26_to_64 invalid ();
        end
    endgenerate

    localparam BITS = WIDTH - 1;
    // Shift to the right of a significand that begins at the highest bit, if exponent and unit were 0
    localparam signed [11:0] DISTANCE = BITS + 126;
    localparam [11:0] FARTHEST = BITS;

    // ---- Stage 1: how far to the right
    reg signed [11:0] right_1;
    reg [23:0] significand_1;
    reg is_zero_1;
    reg negative_1;

    always @(posedge clock) begin
        if (enable) begin
            right_1 <= DISTANCE + $signed({{2{unit[9]}}, unit}) - $signed({4'd0, float_bits[30:23]});
            significand_1 <= {1'b1, float_bits[22:0]};
            is_zero_1 <= (float_bits[30:23] == 8'd0);
            negative_1 <= float_bits[31];
        end
    end

    // ---- Stage 2: by eights
    reg [BITS-1:0] coarse_2;
    reg [2:0] fine_2;
    reg clipped_2;
    reg negative_2;
    wire [BITS-1:0] highest_1 = {significand_1, {(BITS-24){1'b0}}};
    wire is_gone_1 = is_zero_1 || (!right_1[11] && ($unsigned(right_1) >= FARTHEST));

    always @(posedge clock) begin
        if (enable) begin
            coarse_2 <= highest_1 >> {right_1[5:3], 3'd0};
            if (is_gone_1) begin
                coarse_2 <= {BITS{1'b0}};
            end
            fine_2 <= right_1[2:0];
            clipped_2 <= right_1[11] && !is_zero_1;
            negative_2 <= negative_1;
        end
    end

    // ---- Stage 3: by ones; stage 4: the sign
    always @(posedge clock) begin
        if (enable) begin
            magnitude <= (coarse_2 >> fine_2) | {BITS{clipped_2}};
            negative <= negative_2;
            clipped <= clipped_2;
            fixed <= negative ? -$signed({1'b0, magnitude}) : $signed({1'b0, magnitude});
        end
    end

endmodule

`default_nettype wire
