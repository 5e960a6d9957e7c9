// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Centroid of the weighted points of a SIDE x SIDE grid of (mu_x, mu_y), 1/4 apart.
//
// Five points come in a cycle, or a row, row by row. Latency from the last ones to done: 26 cycles, or 27.

`default_nettype none

module sptfra_grid_centroid #(
    // Points along an axis
    parameter integer SIDE = 13,
    // Points that come in a cycle: 5, the last of a row with weights of 0, or all of a row
    parameter integer AT_ONCE = 5,
    // Bits of a weight, at most 2^(WEIGHT_BITS - 2)
    parameter integer WEIGHT_BITS = 24
) (
    input  wire clock,
    input  wire reset,
    // Weights
    input  wire start, // before the first one
    input  wire valid,
    input  wire [AT_ONCE*WEIGHT_BITS-1:0] weights, // of the least mu_x in the lowest bits
    input  wire last, // with valid: these are the last ones
    // Result, held until the next start
    output reg  done, // one cycle
    output reg  signed [17:0] mu_x, // 16 fraction bits
    output reg  signed [17:0] mu_y
);

    localparam integer REACH = SIDE / 2;
    localparam integer FIVES = (AT_ONCE + 4) / 5;
    localparam integer GROUPS = (SIDE + AT_ONCE - 1) / AT_ONCE; // of a row

    genvar index;

    // ---- The weights' sum and their moments: of those of a cycle about their first, by additions, and of that one
    // about the middle of the grid times what they weigh together. Index k: k cycles after the weights, five at a time;
    // of a row at once a cycle more from 3 on
    localparam integer GROUP_BITS = WEIGHT_BITS + ((FIVES == 1) ? 4 : 7); // of the sum of them, times up to 4, or 14
    localparam integer STAGES = (FIVES == 1) ? 2 : 3; // to both sums of those of a cycle
    localparam integer SUM_BITS = WEIGHT_BITS + 8; // of all weights, which need two less
    localparam integer MOMENT_BITS = SUM_BITS + 1; // of a moment's magnitude, up to REACH times their sum
    wire [FIVES*GROUP_BITS-1:0] sums_2; // of each five
    wire [FIVES*GROUP_BITS-1:0] moments_2; // ... about their own first
    wire [GROUP_BITS-1:0] group_sum; // of all
    wire [GROUP_BITS-1:0] group_moment;
    reg signed [17:0] column; // of the first of these, from the middle
    reg signed [17:0] row;
    reg first;
    reg [STAGES:1] valids;
    wire group_valid = valids[STAGES];
    reg [SUM_BITS-1:0] weight_sum;
    reg [MOMENT_BITS:0] moment_within;
    wire signed [47:0] moment_of_first;
    wire signed [47:0] moment_y;
    localparam signed [17:0] LEAST = -REACH[17:0];
    localparam integer LAST_FIRST = AT_ONCE * (GROUPS - 1) - REACH;
    localparam signed [17:0] GREATEST_FIRST = LAST_FIRST[17:0];
    localparam signed [17:0] STEP = AT_ONCE[17:0];

    wire [5*FIVES*WEIGHT_BITS-1:0] padded; // the last five are filled up with weights of 0

    if (5 * FIVES > AT_ONCE) begin : gen_padded
        assign padded = { {((5 * FIVES - AT_ONCE) * WEIGHT_BITS){1'b0}}, weights};
    end else begin : gen_full
        assign padded = weights;
    end
    for (index = 0; index < FIVES; index = index + 1) begin : gen_fives
        wire [5*WEIGHT_BITS-1:0] five = padded[5*WEIGHT_BITS*index +: 5*WEIGHT_BITS];
        wire [GROUP_BITS-1:0] w0 = { {(GROUP_BITS - WEIGHT_BITS){1'b0}}, five[WEIGHT_BITS*0 +: WEIGHT_BITS]};
        wire [GROUP_BITS-1:0] w1 = { {(GROUP_BITS - WEIGHT_BITS){1'b0}}, five[WEIGHT_BITS*1 +: WEIGHT_BITS]};
        wire [GROUP_BITS-1:0] w2 = { {(GROUP_BITS - WEIGHT_BITS){1'b0}}, five[WEIGHT_BITS*2 +: WEIGHT_BITS]};
        wire [GROUP_BITS-1:0] w3 = { {(GROUP_BITS - WEIGHT_BITS){1'b0}}, five[WEIGHT_BITS*3 +: WEIGHT_BITS]};
        wire [GROUP_BITS-1:0] w4 = { {(GROUP_BITS - WEIGHT_BITS){1'b0}}, five[WEIGHT_BITS*4 +: WEIGHT_BITS]};
        reg [GROUP_BITS-1:0] sum_012_1;
        reg [GROUP_BITS-1:0] sum_34_1;
        reg [GROUP_BITS-1:0] moment_12_1;
        reg [GROUP_BITS-1:0] moment_34_1;
        reg [GROUP_BITS-1:0] sum_2;
        reg [GROUP_BITS-1:0] moment_2;

        always @(posedge clock) begin
            sum_012_1 <= w0 + w1 + w2;
            sum_34_1 <= w3 + w4;
            moment_12_1 <= w1 + (w2 << 1);
            moment_34_1 <= w3 + (w3 << 1) + (w4 << 2);
            sum_2 <= sum_012_1 + sum_34_1;
            moment_2 <= moment_12_1 + moment_34_1;
        end

        assign sums_2[GROUP_BITS*index +: GROUP_BITS] = sum_2;
        assign moments_2[GROUP_BITS*index +: GROUP_BITS] = moment_2;
    end
    if (FIVES == 1) begin : gen_five
        assign group_sum = sums_2;
        assign group_moment = moments_2;
    end else begin : gen_row
        // The second five begin 5 points after the first, the third 10
        wire [GROUP_BITS-1:0] second = sums_2[GROUP_BITS*1 +: GROUP_BITS];
        wire [GROUP_BITS-1:0] third = sums_2[GROUP_BITS*2 +: GROUP_BITS];
        wire [GROUP_BITS-1:0] once = second + (third << 1);
        reg [GROUP_BITS-1:0] sum_3;
        reg [GROUP_BITS-1:0] moment_3;

        always @(posedge clock) begin
            sum_3 <= sums_2[0 +: GROUP_BITS] + second + third;
            moment_3 <= moments_2[0 +: GROUP_BITS] + moments_2[GROUP_BITS*1 +: GROUP_BITS]
                + moments_2[GROUP_BITS*2 +: GROUP_BITS] + once + (once << 2);
        end

        assign group_sum = sum_3;
        assign group_moment = moment_3;
    end

    sptfra_mac of_first (
        .clock       (clock),
        .reset       (reset),
        .valid       (group_valid),
        .first       (first),
        .coefficient (column),
        .data        (group_sum[26:0]),
        .accumulator (moment_of_first)
    );

    sptfra_mac of_row (
        .clock       (clock),
        .reset       (reset),
        .valid       (group_valid),
        .first       (first),
        .coefficient (row),
        .data        (group_sum[26:0]),
        .accumulator (moment_y)
    );

    always @(posedge clock) begin
        valids <= {valids[STAGES-1:1], valid};
        if (group_valid) begin
            first <= 1'b0;
            weight_sum <= weight_sum + { {(SUM_BITS - GROUP_BITS){1'b0}}, group_sum};
            moment_within <= moment_within + { {(MOMENT_BITS + 1 - GROUP_BITS){1'b0}}, group_moment};
            column <= (column == GREATEST_FIRST) ? LEAST : column + STEP;
            row <= (column == GREATEST_FIRST) ? row + 18'sd1 : row;
        end
        if (start) begin
            first <= 1'b1;
            weight_sum <= {SUM_BITS{1'b0}};
            moment_within <= {(MOMENT_BITS + 1){1'b0}};
            column <= LEAST;
            row <= LEAST;
        end
        if (reset) begin
            valids <= {STAGES{1'b0}};
        end
    end

    // ---- Centroid: mu = 1 / 4 of the moments over the sum of the weights
    localparam integer WHOLE_BITS = 3; // of that quotient, up to REACH
    localparam integer RATIO_BITS = WHOLE_BITS + 14;
    localparam integer DIVIDE_STAGES = 5 + STAGES; // from the last weights to the division
    reg [DIVIDE_STAGES:1] drains;
    reg signed [MOMENT_BITS:0] moment_x_6;
    reg signed [MOMENT_BITS:0] moment_y_6;
    reg [MOMENT_BITS:0] magnitude_x_7;
    reg [MOMENT_BITS:0] magnitude_y_7;
    wire divide_done;
    wire [RATIO_BITS-1:0] ratio_x;
    wire [RATIO_BITS-1:0] ratio_y;

    sptfra_ratio #(
        .WIDTH        (MOMENT_BITS),
        .INTEGER_BITS (WHOLE_BITS),
        .BITS         (RATIO_BITS)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (drains[DIVIDE_STAGES]),
        .numerator_x (magnitude_x_7[MOMENT_BITS-1:0]),
        .numerator_y (magnitude_y_7[MOMENT_BITS-1:0]),
        .denominator ({1'b0, weight_sum}),
        .done        (divide_done),
        .quotient_x  (ratio_x),
        .quotient_y  (ratio_y)
    );

    always @(posedge clock) begin
        drains <= {drains[DIVIDE_STAGES-1:1], last};
        moment_x_6 <= moment_of_first[MOMENT_BITS:0] + moment_within;
        moment_y_6 <= moment_y[MOMENT_BITS:0];
        magnitude_x_7 <= moment_x_6[MOMENT_BITS] ? -moment_x_6 : moment_x_6;
        magnitude_y_7 <= moment_y_6[MOMENT_BITS] ? -moment_y_6 : moment_y_6;
        done <= divide_done;
        if (divide_done) begin
            mu_x <= moment_x_6[MOMENT_BITS] ? -{1'b0, ratio_x} : {1'b0, ratio_x};
            mu_y <= moment_y_6[MOMENT_BITS] ? -{1'b0, ratio_y} : {1'b0, ratio_y};
        end
        if (reset) begin
            drains <= {DIVIDE_STAGES{1'b0}};
            done <= 1'b0;
        end
    end

    wire _unused = &{1'b0, group_sum, moment_of_first, moment_y, magnitude_x_7, magnitude_y_7};

endmodule

`default_nettype wire
