// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Level set of Condition 1 over SIDE x SIDE points, and its centroid, which is the friction (mu_x, mu_y).
//
// Rows of points come in, and the least values are kept. The level set lies below B_min + 2^-8 sum |b|. A point weighs
// as the square of its depth, so that it weighs nothing at the edge. For that the rows come again, and five points a
// cycle are weighed, or a whole row.
//
// Latency from the last of the rows to done: 3 SIDE + 37 cycles, or SIDE + 38 with a whole row a cycle.

`default_nettype none

module sptfra_grid_level #(
    // Points along an axis
    parameter integer SIDE = 13,
    // Points weighed in a cycle: 5, or all of a row
    parameter integer AT_ONCE = 5,
    // Bits of a value below the leading bit of sum |b|
    parameter integer FRACTION = 21,
    // From start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0,
    // Derived: bits of a value, and of the margin
    parameter integer VALUE_BITS = FRACTION + 2,
    parameter integer MARGIN_BITS = FRACTION - 7
) (
    input  wire clock,
    input  wire reset,
    input  wire start, // of a frame, before its rows
    input  wire [MARGIN_BITS-1:0] margin, // above the least value, held with the rows and after
    // Rows of points, each held until the next one
    input  wire row_valid,
    input  wire [SIDE*VALUE_BITS-1:0] row_values,
    output wire again, // the next row once more, to be there three cycles later
    // Result, held until the next start
    output wire done, // one cycle
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    output reg  unknown, // nothing limits the friction
    output reg  at_bound // the least B lies on the border
);

    localparam integer GROUPS = (SIDE + AT_ONCE - 1) / AT_ONCE; // of a row, the last one with points that are not there
    localparam integer LAST_IN_GROUP = (SIDE - 1) % AT_ONCE;
    localparam integer WEIGHT_BITS = 24; // of the square of a depth, which is at most the margin
    localparam integer WEIGHT_DROP = 2 * MARGIN_BITS - WEIGHT_BITS; // bits dropped from the square
    localparam [3:0] LAST_ROW = SIDE[3:0] - 4'd1;
    localparam [1:0] LAST_GROUP = GROUPS[1:0] - 2'd1;
    localparam integer LEVELS = $clog2(SIDE);
    localparam integer LEAVES = 1 << LEVELS;
    localparam integer MIN_STAGES = LEVELS + 1; // from a row to its least values being kept

    // ---- Rows as they come: the least values inside and on the border are kept
    reg [3:0] row_in;
    wire outer_row = (row_in == 4'd0) || (row_in == LAST_ROW);
    // Node 1 is the root; the children of node n are 2 n and 2 n + 1; nodes from LEAVES on are the points. The ends of
    // a row, which are on the border, stay out of the tree and are known long before
    wire [VALUE_BITS-1:0] nodes [1:2*LEAVES-1];
    reg [VALUE_BITS-1:0] least_end; // of a row
    reg [VALUE_BITS-1:0] least_of_ends; // of all rows so far
    reg [LEVELS:1] outers;
    reg [LEVELS:1] valids;
    wire [VALUE_BITS-1:0] first_end = row_values[0 +: VALUE_BITS];
    wire [VALUE_BITS-1:0] last_end = row_values[VALUE_BITS*(SIDE-1) +: VALUE_BITS];
    reg [VALUE_BITS-1:0] least_inside;
    reg [VALUE_BITS-1:0] least_on_border;

    genvar index;

    for (index = 0; index < LEAVES; index = index + 1) begin : gen_leaves
        if ((index > 0) && (index < SIDE - 1)) begin : gen_point
            assign nodes[LEAVES + index] = row_values[VALUE_BITS*index +: VALUE_BITS];
        end else begin : gen_none
            assign nodes[LEAVES + index] = {VALUE_BITS{1'b1}};
        end
    end
    for (index = 1; index < LEAVES; index = index + 1) begin : gen_tree
        reg [VALUE_BITS-1:0] node;

        // The first of the lowest nodes has one point, the second of its two
        if (index == LEAVES / 2) begin : gen_second
            always @(posedge clock) begin
                node <= nodes[2*index + 1];
            end
        end else begin : gen_less
            always @(posedge clock) begin
                node <= (nodes[2*index] < nodes[2*index + 1]) ? nodes[2*index] : nodes[2*index + 1];
            end
        end

        assign nodes[index] = node;
    end

    // The border's are those of an outer row as it leaves the tree, and of the ends in every other cycle: there is one
    // before the last row leaves, when all ends are in
    wire [VALUE_BITS-1:0] least_between = nodes[1];
    wire [VALUE_BITS-1:0] of_border = (valids[LEVELS] && outers[LEVELS]) ? least_between : least_of_ends;

    always @(posedge clock) begin
        least_end <= (first_end < last_end) ? first_end : last_end;
        if (valids[1] && (least_end < least_of_ends)) begin
            least_of_ends <= least_end;
        end
        valids <= {valids[LEVELS-1:1], row_valid};
        outers <= {outers[LEVELS-1:1], outer_row};
        if (row_valid) begin
            row_in <= row_in + 4'd1;
        end
        if (of_border < least_on_border) begin
            least_on_border <= of_border;
        end
        if (valids[LEVELS] && !outers[LEVELS] && (least_between < least_inside)) begin
            least_inside <= least_between;
        end
        if (start) begin
            row_in <= 4'd0;
            least_inside <= {VALUE_BITS{1'b1}};
            least_of_ends <= {VALUE_BITS{1'b1}};
            least_on_border <= {VALUE_BITS{1'b1}};
        end
        if (reset) begin
            valids <= {LEVELS{1'b0}};
        end
    end

    // ---- Sequence: the level, when the last row is in the least values; then a row in a cycle, or in three
    localparam integer LEVEL_STAGES = 1; // the level is there two cycles later, when the first depth is
    reg [MIN_STAGES+LEVEL_STAGES:1] all_in; // index k: k cycles after the last row
    reg reading;
    reg [3:0] row;
    reg [1:0] group;

    wire last_group = (group == LAST_GROUP);
    wire last_read = reading && last_group && (row == LAST_ROW);
    reg [VALUE_BITS-1:0] least;
    reg [VALUE_BITS:0] level;

    // Two cycles before the row's first points are weighed
    if (GROUPS == 1) begin : gen_every_cycle
        assign again = all_in[MIN_STAGES+LEVEL_STAGES-1] || all_in[MIN_STAGES+LEVEL_STAGES]
            || (reading && (row < LAST_ROW - 4'd1));
    end else begin : gen_every_row
        assign again = all_in[MIN_STAGES+LEVEL_STAGES-1]
            || (reading && (group == LAST_GROUP - 2'd1) && (row != LAST_ROW));
    end

    always @(posedge clock) begin
        all_in <= {all_in[MIN_STAGES+LEVEL_STAGES-1:1], row_valid && (row_in == LAST_ROW)};
        at_bound <= (least_on_border < least_inside);
        least <= at_bound ? least_on_border : least_inside;
        level <= {1'b0, least} + { {(VALUE_BITS + 1 - MARGIN_BITS){1'b0}}, margin};
        if (reading) begin
            group <= last_group ? 2'd0 : group + 2'd1;
            row <= last_group ? row + 4'd1 : row;
        end
        if (last_read) begin
            reading <= 1'b0;
        end
        if (all_in[MIN_STAGES+LEVEL_STAGES]) begin
            reading <= 1'b1;
            group <= 2'd0;
            row <= 4'd0;
        end
        if (reset) begin
            all_in <= {(MIN_STAGES + LEVEL_STAGES){1'b0}};
            reading <= 1'b0;
        end
    end

    // ---- Depths below the level, squared: index k: k cycles after reading, a row being asked for two
    // cycles before that
    localparam integer STAGES = 5;
    reg [STAGES:1] reads;
    reg [STAGES:1] lasts;
    wire last_5 = lasts[STAGES];
    reg [1:0] group_1;
    reg [3:0] row_1;
    reg [1:0] corners_2; // the first and the last of these points are corners of the grid
    wire [GROUPS*AT_ONCE*VALUE_BITS-1:0] padded_values; // a point that is not there weighs nothing
    wire [AT_ONCE*VALUE_BITS-1:0] group_values_1;
    wire [AT_ONCE-1:0] below_2;
    wire [AT_ONCE*WEIGHT_BITS-1:0] weights_5;

    if (GROUPS * AT_ONCE > SIDE) begin : gen_padded
        assign padded_values = { {((GROUPS * AT_ONCE - SIDE) * VALUE_BITS){1'b1}}, row_values};
    end else begin : gen_full
        assign padded_values = row_values;
    end
    if (GROUPS == 1) begin : gen_row
        assign group_values_1 = padded_values;
    end else begin : gen_group
        assign group_values_1 = padded_values[AT_ONCE*VALUE_BITS*group_1 +: AT_ONCE*VALUE_BITS];
    end
    for (index = 0; index < AT_ONCE; index = index + 1) begin : gen_weights
        reg signed [VALUE_BITS+1:0] depth_2;
        reg [MARGIN_BITS-1:0] depth_3;
        wire signed [44:0] square_4;
        reg [WEIGHT_BITS-1:0] weight_5;

        assign below_2[index] = !depth_2[VALUE_BITS+1] && (depth_2 != {(VALUE_BITS + 2){1'b0}});

        sptfra_multiply square (
            .clock       (clock),
            .enable      (1'b1),
            .coefficient ({ {(18 - MARGIN_BITS){1'b0}}, depth_3}),
            .data        ({ {(27 - MARGIN_BITS){1'b0}}, depth_3}),
            .product     (square_4)
        );

        always @(posedge clock) begin
            depth_2 <= {1'b0, level} - {2'b00, group_values_1[VALUE_BITS*index +: VALUE_BITS]};
            // Not more than the margin
            depth_3 <= depth_2[VALUE_BITS+1] ? {MARGIN_BITS{1'b0}} : depth_2[MARGIN_BITS-1:0];
            weight_5 <= square_4[WEIGHT_DROP +: WEIGHT_BITS];
        end

        assign weights_5[WEIGHT_BITS*index +: WEIGHT_BITS] = weight_5;

        wire _unused = &{1'b0, square_4};
    end

    always @(posedge clock) begin
        reads <= {reads[STAGES-1:1], reading};
        lasts <= {lasts[STAGES-1:1], last_read};
        group_1 <= group;
        row_1 <= row;
        corners_2 <= {2{reads[1] && ((row_1 == 4'd0) || (row_1 == LAST_ROW))}}
            & {group_1 == LAST_GROUP, group_1 == 2'd0};
        if ((corners_2[0] && !below_2[0]) || (corners_2[1] && !below_2[LAST_IN_GROUP])) begin
            unknown <= 1'b0;
        end
        if (start) begin
            unknown <= 1'b1;
        end
        if (reset) begin
            reads <= {STAGES{1'b0}};
            lasts <= {STAGES{1'b0}};
            corners_2 <= 2'd0;
        end
    end

    // ---- Their centroid
    sptfra_grid_centroid #(
        .SIDE        (SIDE),
        .AT_ONCE     (AT_ONCE),
        .WEIGHT_BITS (WEIGHT_BITS)
    ) centroid (
        .clock   (clock),
        .reset   (reset),
        .start   (start),
        .valid   (reads[5]),
        .weights (weights_5),
        .last    (last_5),
        .done    (done),
        .mu_x    (mu_x),
        .mu_y    (mu_y)
    );

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (done)
    );

endmodule

`default_nettype wire
