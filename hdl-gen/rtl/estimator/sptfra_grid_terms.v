// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A taxel's terms in Condition 1: X_i = u0 - dead zone + mu_x u1 for each column, Y_j = mu_y u2 for each row.
//
// Shifts and additions only, as mu is a multiple of 1/4. A step of X and Y is 2^-FRACTION of the power of two above
// sum |b|: block floating point, with a scale for each frame. A u beyond that power is clipped. X and Y are rounded
// down.
//
// Latency from u to X and Y: 6 cycles. Throughput: a taxel a cycle.

`default_nettype none

module sptfra_grid_terms #(
    // Points along an axis
    parameter integer SIDE = 13,
    // Rows of the grid whose Y is wanted: SIDE, or 1
    parameter integer AT_ONCE = SIDE,
    // Bits of a term below the leading bit of sum |b|
    parameter integer FRACTION = 21,
    // Left shift of u before the right shift by the bits of sum |b|: to one bit finer than X
    parameter integer U_LEFT = 22,
    // Derived: bits of X, which is below 4 powers, of Y, which is below 2, and of the margin
    parameter integer X_BITS = FRACTION + 3,
    parameter integer Y_BITS = FRACTION + 2,
    parameter integer MARGIN_BITS = FRACTION - 7
) (
    input  wire clock,
    input  wire reset,
    // A frame's sum and largest, held from the cycle after start on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest,
    output wire [MARGIN_BITS-1:0] margin, // 2^-8 sum |b|, and 1; there 6 cycles after start
    // A taxel, from the fourth cycle after start on
    input  wire valid,
    input  wire signed [26:0] u0,
    input  wire signed [26:0] u1,
    input  wire signed [26:0] u2,
    // The row that is wanted of one, five cycles after u
    input  wire [3:0] row,
    // Its terms, the least mu in the lowest bits
    output wire [SIDE*X_BITS-1:0] along_x,
    output wire [AT_ONCE*Y_BITS-1:0] along_y,
    output reg  clipped // a u of the frame was
);

    if (SIDE != 13) begin : gen_check_side
        sptfra_error_a_side_has_13_points invalid ();
    end

    localparam integer REACH = SIDE / 2;
    localparam integer SHARE_SHIFT = 8; // dead zone and margin are 2^-8 of the largest and of the sum
    localparam integer U_BITS = FRACTION + 1; // of u, normalised
    localparam integer TWICE_BITS = U_BITS + 2; // of twice u, and what rounding adds
    localparam integer WIDE = 27 + ((U_LEFT > TWICE_BITS) ? U_LEFT : TWICE_BITS); // before the scale is taken off
    localparam integer STEP_SHIFT = 2; // a step of mu is 2^-STEP_SHIFT
    localparam integer MULTIPLES = 7; // of a step: 0 to 6
    localparam integer MULTIPLE_BITS = U_BITS + 3;
    localparam integer WIDE_X = X_BITS + STEP_SHIFT; // before the fraction is dropped
    localparam integer WIDE_Y = Y_BITS + STEP_SHIFT;

    // ---- Scale of the frame: the bits of sum |b|, there three cycles after start
    wire [5:0] sum_bits;
    reg [5:0] scale; // the same, from the fourth cycle on
    reg [39+FRACTION-SHARE_SHIFT:0] sum_fours; // a shift by fours, then by 0 to 3: each bit is one of four in each LUT
    reg [39+FRACTION-SHARE_SHIFT:0] sum_shifted;
    reg [26+FRACTION-SHARE_SHIFT:0] largest_fours;
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
        sum_fours <= {stress_sum, {(FRACTION - SHARE_SHIFT){1'b0}}} >> {scale[5:2], 2'd0};
        sum_shifted <= sum_fours >> scale[1:0];
        largest_fours <= {largest, {(FRACTION - SHARE_SHIFT){1'b0}}} >> {scale[5:2], 2'd0};
        largest_shifted <= largest_fours >> scale[1:0];
    end

    // One more, so that the least value is below the level in any case
    assign margin = {1'b0, sum_shifted[FRACTION-SHARE_SHIFT-1:0]} + {{(MARGIN_BITS - 1){1'b0}}, 1'b1};

    // ---- u normalised, rounded and clipped: index k: k cycles after u
    wire [3*27-1:0] given = {u2, u1, u0};
    wire [3*U_BITS-1:0] u_3;
    wire [2:0] clips_2;
    reg [2:1] valids;

    genvar index;

    for (index = 0; index < 3; index = index + 1) begin : gen_u
        wire signed [WIDE-1:0] wide = { {(WIDE - 27){given[27*index + 26]}}, given[27*index +: 27]} << U_LEFT;
        reg signed [WIDE-1:0] fours_1;
        wire signed [WIDE-1:0] bits_1 = fours_1 >>> scale[1:0];
        reg signed [TWICE_BITS-1:0] twice_2;
        reg sign_2;
        reg is_whole_2; // twice_2 has all of it
        reg [U_BITS-1:0] normal_3;
        wire signed [TWICE_BITS-1:0] rounded_2 = (twice_2 + 1) >>> 1;
        wire fits_2 = is_whole_2
            && (rounded_2[TWICE_BITS-1:U_BITS-1] == {(TWICE_BITS - U_BITS + 1){rounded_2[TWICE_BITS-1]}});

        always @(posedge clock) begin
            fours_1 <= wide >>> {scale[5:2], 2'd0};
            twice_2 <= bits_1[TWICE_BITS-1:0];
            sign_2 <= fours_1[WIDE-1];
            // Of the bits above, those that a shift of up to 3 brings down, and the others
            is_whole_2 <= (bits_1[TWICE_BITS+2:TWICE_BITS-1] == {4{fours_1[WIDE-1]}})
                && (fours_1[WIDE-1:TWICE_BITS+3] == {(WIDE - TWICE_BITS - 3){fours_1[WIDE-1]}});
            normal_3 <= fits_2 ? rounded_2[U_BITS-1:0] : {sign_2, {(U_BITS - 1){!sign_2}}};
        end

        wire _unused_bits = &{1'b0, bits_1};

        assign clips_2[index] = !fits_2;
        assign u_3[U_BITS*index +: U_BITS] = normal_3;
    end

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

    // ---- Multiples of u1 and u2: index k: k cycles after u
    wire signed [U_BITS-1:0] u0_3 = u_3[U_BITS*0 +: U_BITS];
    reg signed [U_BITS:0] base_4; // u0 - dead zone
    reg signed [U_BITS:0] base_5;
    wire [2*MULTIPLES*MULTIPLE_BITS-1:0] multiples_5; // of u1, then of u2

    always @(posedge clock) begin
        base_4 <= {u0_3[U_BITS-1], u0_3} - { {(U_BITS + 1 - FRACTION + SHARE_SHIFT){1'b0}}, dead_zone};
        base_5 <= base_4;
    end

    for (index = 0; index < 2; index = index + 1) begin : gen_multiples
        wire signed [U_BITS-1:0] u = u_3[U_BITS*(index + 1) +: U_BITS];
        reg signed [MULTIPLE_BITS-1:0] step_4;
        reg [MULTIPLES*MULTIPLE_BITS-1:0] times_5;

        always @(posedge clock) begin
            step_4 <= { {(MULTIPLE_BITS - U_BITS){u[U_BITS-1]}}, u};
            times_5[MULTIPLE_BITS*0 +: MULTIPLE_BITS] <= {MULTIPLE_BITS{1'b0}};
            times_5[MULTIPLE_BITS*1 +: MULTIPLE_BITS] <= step_4;
            times_5[MULTIPLE_BITS*2 +: MULTIPLE_BITS] <= step_4 <<< 1;
            times_5[MULTIPLE_BITS*3 +: MULTIPLE_BITS] <= (step_4 <<< 1) + step_4;
            times_5[MULTIPLE_BITS*4 +: MULTIPLE_BITS] <= step_4 <<< 2;
            times_5[MULTIPLE_BITS*5 +: MULTIPLE_BITS] <= (step_4 <<< 2) + step_4;
            times_5[MULTIPLE_BITS*6 +: MULTIPLE_BITS] <= (step_4 <<< 2) + (step_4 <<< 1);
        end

        assign multiples_5[MULTIPLES*MULTIPLE_BITS*index +: MULTIPLES*MULTIPLE_BITS] = times_5;
    end

    // ---- The terms
    for (index = 0; index < SIDE; index = index + 1) begin : gen_along_x
        localparam integer STEPS = (index < REACH) ? REACH - index : index - REACH;
        wire signed [MULTIPLE_BITS-1:0] times = multiples_5[MULTIPLE_BITS*STEPS +: MULTIPLE_BITS];
        wire signed [WIDE_X-1:0] base = { {(X_BITS - U_BITS - 1){base_5[U_BITS]}}, base_5, {STEP_SHIFT{1'b0}}};
        wire signed [WIDE_X-1:0] wide = { {(WIDE_X - MULTIPLE_BITS){times[MULTIPLE_BITS-1]}}, times};
        reg signed [WIDE_X-1:0] x_6;

        always @(posedge clock) begin
            x_6 <= (index < REACH) ? base - wide : base + wide;
        end

        assign along_x[X_BITS*index +: X_BITS] = x_6[WIDE_X-1:STEP_SHIFT];

        wire _unused_x = &{1'b0, x_6[STEP_SHIFT-1:0]};
    end
    for (index = 0; index < AT_ONCE; index = index + 1) begin : gen_along_y
        localparam integer STEPS = (index < REACH) ? REACH - index : index - REACH;
        wire is_negative;
        wire signed [MULTIPLE_BITS-1:0] times;
        reg signed [WIDE_Y-1:0] y_6;

        if (AT_ONCE == 1) begin : gen_one
            wire [MULTIPLES*MULTIPLE_BITS-1:0] of_u2
                = multiples_5[2*MULTIPLES*MULTIPLE_BITS-1:MULTIPLES*MULTIPLE_BITS];
            wire [3:0] steps = is_negative ? REACH[3:0] - row : row - REACH[3:0];

            assign is_negative = (row < REACH[3:0]);
            assign times = of_u2[MULTIPLE_BITS*steps[2:0] +: MULTIPLE_BITS];

            wire _unused_steps = &{1'b0, steps[3]};
        end else begin : gen_each
            assign is_negative = (index < REACH);
            assign times = multiples_5[MULTIPLE_BITS*(MULTIPLES + STEPS) +: MULTIPLE_BITS];
        end

        always @(posedge clock) begin
            y_6 <= is_negative ? -times : times;
        end

        assign along_y[Y_BITS*index +: Y_BITS] = y_6[WIDE_Y-1:STEP_SHIFT];

        wire _unused_y = &{1'b0, y_6[STEP_SHIFT-1:0]};
    end

    wire _unused = &{1'b0, sum_shifted, largest_shifted, multiples_5, row};

endmodule

`default_nettype wire
