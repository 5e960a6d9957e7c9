// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// 16-bit integer to 27-bit fixed point: fixed = count * 2^shift, rounded half away from zero, clipped to +-limit. It
// does to an integer what sptfra_float_to_fixed does to the same number, as late.
//
// Latency 5 cycles, one value a cycle. saturated: the rounded magnitude is limit or more.

`default_nettype none

module sptfra_int_to_fixed #(
    // 1: two's complement; 0: from 0 on
    parameter SIGNED = 1
) (
    input  wire clock,
    input  wire [15:0] count,
    input  wire signed [9:0] shift, // sampled with count
    input  wire [26:0] limit, // constant while conversions are under way
    output reg  signed [26:0] fixed,
    output reg  saturated
);

    // Twice the value is count * 2^28, shifted right by 27 - shift: 44 bits, of which the lowest decides the rounding
    localparam signed [11:0] LEFTMOST = 12'sd27;
    localparam signed [11:0] RIGHTMOST = 12'sd44; // from here on it is 0

    wire negative = (SIGNED != 0) && count[15];
    wire signed [11:0] distance = LEFTMOST - $signed({{2{shift[9]}}, shift});
    wire [27:0] threshold = {limit, 1'b0} - 28'd1; // the least that is rounded to limit

    reg [4:1] negatives;
    reg [15:0] magnitude_1;
    reg [5:0] right_1;
    reg too_far_1;
    reg [43:0] coarse_2;
    reg [2:0] right_2;
    reg beyond_2;
    reg [43:0] doubled_3;
    reg beyond_3;
    reg [26:0] rounded_4;
    reg over_4;
    wire [26:0] magnitude_4 = over_4 ? limit : rounded_4;

    always @(posedge clock) begin
        negatives <= {negatives[3:1], negative};
        magnitude_1 <= negative ? -count : count;
        right_1 <= (distance >= RIGHTMOST) ? RIGHTMOST[5:0] : distance[5:0];
        too_far_1 <= distance[11]; // to the left
        coarse_2 <= {magnitude_1, 28'd0} >> {right_1[5:3], 3'd0};
        right_2 <= right_1[2:0];
        beyond_2 <= too_far_1 && (magnitude_1 != 16'd0);
        doubled_3 <= coarse_2 >> right_2;
        beyond_3 <= beyond_2;
        rounded_4 <= doubled_3[27:1] + {26'd0, doubled_3[0]};
        over_4 <= beyond_3 || (doubled_3 >= {16'd0, threshold});
        fixed <= negatives[4] ? -$signed(magnitude_4) : $signed(magnitude_4);
        saturated <= over_4;
    end

    wire _unused = &{1'b0, distance};

endmodule

`default_nettype wire
