// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One taxel's part in Condition 1 at the points of the (mu_x, mu_y) plane: X_i = u0 - dead zone + mu_x u1 for each
// column of points, Y_j = mu_y u2 for each row. Shifts and additions only; a taxel a cycle, six cycles from u to X, Y.
//
// mu is a multiple of 3/16. A step of X and Y is 2^-23 of the power of two above sum |b|: the leading bit of the sum is
// the frame's own scale. A u beyond two such powers is clipped.

`default_nettype none

module sptfra_points_taxel #(
    // Points along an axis, an odd number up to 15
    parameter integer SIDE = 15,
    // Left shift of u before the right shift by the bits of sum |b|: to one bit finer than X
    parameter integer U_LEFT = 24
) (
    input  wire clock,
    input  wire reset,
    // A frame's sum and largest, held from the cycle after start on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest,
    output wire [15:0] margin, // 2^-8 sum |b|, and 1; there 6 cycles after start
    // A taxel, from the fourth cycle after start on
    input  wire valid,
    input  wire signed [26:0] u0,
    input  wire signed [26:0] u1,
    input  wire signed [26:0] u2,
    // Its parts, the first of a row in the lowest bits
    output wire [SIDE*27-1:0] along_x,
    output wire [SIDE*27-1:0] along_y,
    output reg  clipped // a u of the frame was
);

    localparam integer REACH = SIDE / 2;
    localparam integer FRACTION = 23;
    localparam integer SHARE_SHIFT = 8; // dead zone and margin are 2^-8 of the largest and of the sum
    localparam integer U_BITS = 25; // of u, normalised
    localparam integer TWICE_BITS = U_BITS + 2; // of twice u, and what rounding adds
    localparam integer WIDE = 27 + ((U_LEFT > TWICE_BITS) ? U_LEFT : TWICE_BITS); // before the scale is taken off
    localparam integer STEP_SHIFT = 4; // a step of mu is three times 2^-STEP_SHIFT
    localparam integer MULTIPLE_BITS = U_BITS + 5; // of up to 7 steps
    localparam integer PART_BITS = 27 + STEP_SHIFT; // before the fraction is dropped

    generate
        if ((SIDE % 2 == 0) || (SIDE > 15)) begin : gen_check
            sptfra_error_points_along_an_axis_must_be_odd_and_at_most_15 invalid ();
        end
    endgenerate

    // ---- Scale of the frame: the bits of sum |b|, there three cycles after start
    wire [5:0] sum_bits;
    reg [5:0] scale; // the same, from the fourth cycle on
    reg [39+FRACTION-SHARE_SHIFT:0] sum_octets;
    reg [39+FRACTION-SHARE_SHIFT:0] sum_shifted;
    reg [26+FRACTION-SHARE_SHIFT:0] largest_octets;
    reg [26+FRACTION-SHARE_SHIFT:0] largest_shifted;
    wire [FRACTION-SHARE_SHIFT-1:0] dead_zone = largest_shifted[FRACTION-SHARE_SHIFT-1:0];

    sptfra_leading_bit #(
        .WIDTH (40)
    ) leading_bit (
        .clock (clock),
        .value (stress_sum),
        .bits  (sum_bits)
    );

    always @(posedge clock) begin
        scale <= sum_bits;
        sum_octets <= {stress_sum, {(FRACTION - SHARE_SHIFT){1'b0}}} >> {scale[5:3], 3'd0};
        sum_shifted <= sum_octets >> scale[2:0];
        largest_octets <= {largest, {(FRACTION - SHARE_SHIFT){1'b0}}} >> {scale[5:3], 3'd0};
        largest_shifted <= largest_octets >> scale[2:0];
    end

    // One more, so that the least value is below the level in any case
    assign margin = {1'b0, sum_shifted[FRACTION-SHARE_SHIFT-1:0]} + 16'd1;

    // ---- u normalised, rounded and clipped: index k: k cycles after u
    wire [3*27-1:0] given = {u2, u1, u0};
    wire [3*U_BITS-1:0] u_3;
    wire [2:0] clips_2;
    reg [2:1] valids;

    genvar index;

    generate
        for (index = 0; index < 3; index = index + 1) begin : gen_u
            wire signed [WIDE-1:0] wide = { {(WIDE - 27){given[27*index + 26]}}, given[27*index +: 27]} << U_LEFT;
            reg signed [WIDE-1:0] octets_1;
            wire signed [WIDE-1:0] bits_1 = octets_1 >>> scale[2:0];
            reg signed [TWICE_BITS-1:0] twice_2;
            reg sign_2;
            reg is_whole_2; // twice_2 has all of it
            reg [U_BITS-1:0] normal_3;
            wire signed [TWICE_BITS-1:0] rounded_2 = (twice_2 + 1) >>> 1;
            wire fits_2 = is_whole_2
                && (rounded_2[TWICE_BITS-1:U_BITS-1] == {(TWICE_BITS - U_BITS + 1){rounded_2[TWICE_BITS-1]}});

            always @(posedge clock) begin
                octets_1 <= wide >>> {scale[5:3], 3'd0};
                twice_2 <= bits_1[TWICE_BITS-1:0];
                sign_2 <= octets_1[WIDE-1];
                // Of the bits above, those that a shift of up to 7 brings down, and the others
                is_whole_2 <= (bits_1[TWICE_BITS+6:TWICE_BITS-1] == {8{octets_1[WIDE-1]}})
                    && (octets_1[WIDE-1:TWICE_BITS+7] == {(WIDE - TWICE_BITS - 7){octets_1[WIDE-1]}});
                normal_3 <= fits_2 ? rounded_2[U_BITS-1:0] : {sign_2, {(U_BITS - 1){!sign_2}}};
            end

            wire _unused_bits = &{1'b0, bits_1};

            assign clips_2[index] = !fits_2;
            assign u_3[U_BITS*index +: U_BITS] = normal_3;
        end
    endgenerate

    always @(posedge clock) begin
        valids <= {valids[1], valid};
        if (valids[2] && (clips_2 != 3'd0)) begin
            clipped <= 1'b1;
        end
        if (start) begin
            clipped <= 1'b0;
        end
        if (reset) begin
            valids <= 2'd0;
        end
    end

    // ---- Three times u1 and u2, and their multiples
    wire signed [U_BITS-1:0] u0_3 = u_3[U_BITS*0 +: U_BITS];
    reg signed [U_BITS:0] base_4; // u0 - dead zone
    reg signed [U_BITS:0] base_5;
    wire [2*8*MULTIPLE_BITS-1:0] multiples_5; // of u1, then of u2: 0 to 7 steps

    always @(posedge clock) begin
        base_4 <= {u0_3[U_BITS-1], u0_3} - { {(U_BITS + 1 - FRACTION + SHARE_SHIFT){1'b0}}, dead_zone};
        base_5 <= base_4;
    end

    generate
        for (index = 0; index < 2; index = index + 1) begin : gen_multiples
            wire signed [U_BITS-1:0] u = u_3[U_BITS*(index + 1) +: U_BITS];
            wire signed [MULTIPLE_BITS-1:0] u_wide = { {(MULTIPLE_BITS - U_BITS){u[U_BITS-1]}}, u};
            reg signed [MULTIPLE_BITS-1:0] step_4;
            reg [8*MULTIPLE_BITS-1:0] times_5;

            always @(posedge clock) begin
                step_4 <= u_wide + (u_wide <<< 1);
                times_5[MULTIPLE_BITS*0 +: MULTIPLE_BITS] <= {MULTIPLE_BITS{1'b0}};
                times_5[MULTIPLE_BITS*1 +: MULTIPLE_BITS] <= step_4;
                times_5[MULTIPLE_BITS*2 +: MULTIPLE_BITS] <= step_4 <<< 1;
                times_5[MULTIPLE_BITS*3 +: MULTIPLE_BITS] <= (step_4 <<< 1) + step_4;
                times_5[MULTIPLE_BITS*4 +: MULTIPLE_BITS] <= step_4 <<< 2;
                times_5[MULTIPLE_BITS*5 +: MULTIPLE_BITS] <= (step_4 <<< 2) + step_4;
                times_5[MULTIPLE_BITS*6 +: MULTIPLE_BITS] <= (step_4 <<< 2) + (step_4 <<< 1);
                times_5[MULTIPLE_BITS*7 +: MULTIPLE_BITS] <= (step_4 <<< 3) - step_4;
            end

            assign multiples_5[8*MULTIPLE_BITS*index +: 8*MULTIPLE_BITS] = times_5;
        end

        // ---- The parts, rounded down
        for (index = 0; index < SIDE; index = index + 1) begin : gen_parts
            localparam integer STEPS = (index < REACH) ? REACH - index : index - REACH;
            wire signed [MULTIPLE_BITS-1:0] of_u1 = multiples_5[MULTIPLE_BITS*STEPS +: MULTIPLE_BITS];
            wire signed [MULTIPLE_BITS-1:0] of_u2 = multiples_5[MULTIPLE_BITS*(8 + STEPS) +: MULTIPLE_BITS];
            wire signed [PART_BITS-1:0] base = { {(PART_BITS - U_BITS - 1 - STEP_SHIFT){base_5[U_BITS]}}, base_5,
                {STEP_SHIFT{1'b0}}};
            wire signed [PART_BITS-1:0] wide_u1 = { {(PART_BITS - MULTIPLE_BITS){of_u1[MULTIPLE_BITS-1]}}, of_u1};
            wire signed [PART_BITS-1:0] wide_u2 = { {(PART_BITS - MULTIPLE_BITS){of_u2[MULTIPLE_BITS-1]}}, of_u2};
            reg signed [PART_BITS-1:0] x_6;
            reg signed [PART_BITS-1:0] y_6;

            always @(posedge clock) begin
                x_6 <= (index < REACH) ? base - wide_u1 : base + wide_u1;
                y_6 <= (index < REACH) ? -wide_u2 : wide_u2;
            end

            assign along_x[27*index +: 27] = x_6[PART_BITS-1:STEP_SHIFT];
            assign along_y[27*index +: 27] = y_6[PART_BITS-1:STEP_SHIFT];

            wire _unused_part = &{1'b0, x_6[STEP_SHIFT-1:0], y_6[STEP_SHIFT-1:0]};
        end
    endgenerate

    wire _unused = &{1'b0, sum_shifted, largest_shifted};

endmodule

`default_nettype wire
