// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Centroid of the weighted points of a SIDE x SIDE grid of (mu_x, mu_y), 3/16 apart, of which five come in a cycle, row
// by row. From the last ones to done: 27 cycles.

`default_nettype none

module sptfra_points_centroid #(
    // Points along an axis, an odd multiple of 5
    parameter integer SIDE = 15,
    // Bits of a weight, up to 24
    parameter integer WEIGHT_BITS = 24
) (
    input  wire clock,
    input  wire reset,
    // Weights
    input  wire start, // before the first one
    input  wire valid,
    input  wire [5*WEIGHT_BITS-1:0] weights, // of the least mu_x in the lowest bits
    input  wire last, // with valid: these are the last ones
    // Result, held until the next start
    output reg  done, // one cycle
    output reg  signed [17:0] mu_x, // 16 fraction bits
    output reg  signed [17:0] mu_y
);

    localparam integer REACH = SIDE / 2;
    localparam integer AT_ONCE = 5;

    genvar index;

    // ---- The weights' sum and their moments: of the five about their first, by additions, and of that one about
    // the middle of the grid times what they weigh together. Index k: k cycles after the weights
    localparam integer FIVE_BITS = WEIGHT_BITS + 4; // of the sum of five times up to 4
    wire [FIVE_BITS-1:0] w [0:AT_ONCE-1];
    reg [FIVE_BITS-1:0] sum_012_1;
    reg [FIVE_BITS-1:0] sum_34_1;
    reg [FIVE_BITS-1:0] moment_12_1;
    reg [FIVE_BITS-1:0] moment_34_1;
    reg [FIVE_BITS-1:0] sum_2;
    reg [FIVE_BITS-1:0] moment_2;
    reg signed [17:0] column_2; // of the first of the five, from the middle
    reg signed [17:0] row_2;
    reg first_2;
    reg valid_1;
    reg valid_2;
    reg [47:0] weight_sum;
    reg [47:0] moment_within;
    wire signed [47:0] moment_of_first;
    wire signed [47:0] moment_y;
    localparam signed [17:0] LEAST = -REACH[17:0];
    localparam integer LAST_FIRST = REACH + 1 - AT_ONCE;
    localparam signed [17:0] GREATEST_FIRST = LAST_FIRST[17:0];
    localparam signed [17:0] FIVE = AT_ONCE[17:0];

    generate
        for (index = 0; index < AT_ONCE; index = index + 1) begin : gen_wide
            assign w[index] = {4'd0, weights[WEIGHT_BITS*index +: WEIGHT_BITS]};
        end
    endgenerate

    sptfra_mac of_first (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid_2),
        .first       (first_2),
        .coefficient (column_2),
        .data        (sum_2[26:0]),
        .accumulator (moment_of_first)
    );

    sptfra_mac of_row (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid_2),
        .first       (first_2),
        .coefficient (row_2),
        .data        (sum_2[26:0]),
        .accumulator (moment_y)
    );

    always @(posedge clock) begin
        valid_1 <= valid;
        valid_2 <= valid_1;
        sum_012_1 <= w[0] + w[1] + w[2];
        sum_34_1 <= w[3] + w[4];
        moment_12_1 <= w[1] + (w[2] << 1);
        moment_34_1 <= w[3] + (w[3] << 1) + (w[4] << 2);
        sum_2 <= sum_012_1 + sum_34_1;
        moment_2 <= moment_12_1 + moment_34_1;
        if (valid_2) begin
            first_2 <= 1'b0;
            weight_sum <= weight_sum + { {(48 - FIVE_BITS){1'b0}}, sum_2};
            moment_within <= moment_within + { {(48 - FIVE_BITS){1'b0}}, moment_2};
            column_2 <= (column_2 == GREATEST_FIRST) ? LEAST : column_2 + FIVE;
            row_2 <= (column_2 == GREATEST_FIRST) ? row_2 + 18'sd1 : row_2;
        end
        if (start) begin
            first_2 <= 1'b1;
            weight_sum <= 48'd0;
            moment_within <= 48'd0;
            column_2 <= LEAST;
            row_2 <= LEAST;
        end
        if (reset) begin
            valid_1 <= 1'b0;
            valid_2 <= 1'b0;
        end
    end

    // ---- Centroid: mu = 3 / 16 of the moments over the sum of the weights
    localparam integer WHOLE_BITS = 5; // of three times that quotient, up to 3 REACH
    localparam integer RATIO_BITS = WHOLE_BITS + 12;
    localparam integer DIVIDE_STAGES = 8; // from the last weights to the division
    reg [DIVIDE_STAGES:1] drains;
    reg signed [47:0] moment_x_6;
    reg signed [47:0] moment_y_6;
    reg [47:0] magnitude_x_7;
    reg [47:0] magnitude_y_7;
    reg [47:0] triple_x_8;
    reg [47:0] triple_y_8;
    wire divide_done;
    wire [RATIO_BITS-1:0] ratio_x;
    wire [RATIO_BITS-1:0] ratio_y;

    sptfra_ratio #(
        .WIDTH        (48),
        .INTEGER_BITS (WHOLE_BITS),
        .BITS         (RATIO_BITS)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (drains[DIVIDE_STAGES]),
        .numerator_x (triple_x_8),
        .numerator_y (triple_y_8),
        .denominator (weight_sum),
        .done        (divide_done),
        .quotient_x  (ratio_x),
        .quotient_y  (ratio_y)
    );

    always @(posedge clock) begin
        drains <= {drains[DIVIDE_STAGES-1:1], last};
        moment_x_6 <= moment_of_first + moment_within;
        moment_y_6 <= moment_y;
        magnitude_x_7 <= moment_x_6[47] ? -moment_x_6 : moment_x_6;
        magnitude_y_7 <= moment_y_6[47] ? -moment_y_6 : moment_y_6;
        triple_x_8 <= (magnitude_x_7 << 1) + magnitude_x_7;
        triple_y_8 <= (magnitude_y_7 << 1) + magnitude_y_7;
        done <= divide_done;
        if (divide_done) begin
            mu_x <= moment_x_6[47] ? -{1'b0, ratio_x} : {1'b0, ratio_x};
            mu_y <= moment_y_6[47] ? -{1'b0, ratio_y} : {1'b0, ratio_y};
        end
        if (reset) begin
            drains <= {DIVIDE_STAGES{1'b0}};
            done <= 1'b0;
        end
    end

    wire _unused = &{1'b0, sum_2};

endmodule

`default_nettype wire
