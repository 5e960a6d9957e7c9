// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Where Condition 1 is least in the (mu_x, mu_y) plane: its values over a grid of points, their level set's centroid.
//
// Few points have a cell each, which sees one taxel after the other; many are walked over, in cells of a few taxels.

`default_nettype none

module sptfra_plane_search #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Points along an axis, 5 or 15, each with a cell; 0: a walk over 21 x 21 points
    parameter integer POINTS_SIDE = 15,
    // Left shift of u before the right shift by the bits of sum |b|, for the points
    parameter integer U_LEFT = 24,
    // Taxels that the points see in a cycle: 1, or 2, with a row of points weighed in one
    parameter integer TAXELS = 1,
    // Cells of the walk, as many for each member of a quad
    parameter integer CELLS = 28,
    // Taxels of a cell, a power of two, at least 4
    parameter integer CELL_ELEMENTS = 4,
    // Right shift that turns max |b| into 8 times the walk's dead zone, and sum |b| into the level above its least
    // value
    parameter integer SHARE_SHIFT = 5,
    // Checked in simulation, 0: unchecked: cycles from the start to the first row of points, or value of the walk
    parameter integer EXPECTED_PLANE_LATENCY = 0,
    // ... from that row, or the last value, to the centroid
    parameter integer EXPECTED_LEVEL_LATENCY = 0,
    // Derived: quads, and the bits of their number
    parameter integer QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter integer ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3
) (
    input  wire clock,
    input  wire reset,
    // u_q of a quad's taxels, member 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire [ROW_WIDTH-1:0] u_quad,
    input  wire [4*DATA_BITS-1:0] u_values,
    input  wire fill_bank,
    input  wire search_bank,
    // Start, with these held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest, // max |b|
    // All of a quad as it is read, of points only: u_0 in the lowest bits
    output wire read_valid,
    output wire [ROW_WIDTH-1:0] read_quad,
    output wire [3*4*27-1:0] read_values,
    // Result, held until the next start
    output wire done, // one cycle
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    output wire unknown, // nothing limits the friction
    output wire at_bound, // the least value lies on the border
    output wire saturated // a value was clipped
);

    // Of a value of the walk: a sum of stresses without their sign
    localparam integer VALUE_BITS = 31 + $clog2(COLUMNS * ROWS);

    generate
        if (POINTS_SIDE != 0) begin : gen_points
            wire [15:0] margin;
            wire row_valid;
            wire again;
            wire [POINTS_SIDE*28-1:0] row_values;
            wire clipped_u;
            wire clipped_least;

            sptfra_points #(
                .COLUMNS          (COLUMNS),
                .ROWS             (ROWS),
                .DATA_BITS        (DATA_BITS),
                .ROW_WIDTH        (ROW_WIDTH),
                .SIDE             (POINTS_SIDE),
                .TAXELS           (TAXELS),
                .U_LEFT           (U_LEFT),
                .EXPECTED_LATENCY (EXPECTED_PLANE_LATENCY)
            ) points (
                .clock       (clock),
                .reset       (reset),
                .u_valid     (u_valid),
                .u_quad      (u_quad),
                .u_values    (u_values),
                .fill_bank   (fill_bank),
                .search_bank (search_bank),
                .start       (start),
                .stress_sum  (stress_sum),
                .largest     (largest),
                .margin      (margin),
                .read_valid  (read_valid),
                .read_quad   (read_quad),
                .read_values (read_values),
                .row_valid   (row_valid),
                .again       (again),
                .row_values  (row_values),
                .clipped     (clipped_u)
            );

            sptfra_points_level #(
                .SIDE             (POINTS_SIDE),
                .AT_ONCE          ((TAXELS == 1) ? 5 : POINTS_SIDE),
                .EXPECTED_LATENCY (EXPECTED_LEVEL_LATENCY)
            ) level_set (
                .clock      (clock),
                .reset      (reset),
                .start      (start),
                .margin     (margin),
                .row_valid  (row_valid),
                .row_values (row_values),
                .again      (again),
                .done       (done),
                .mu_x       (mu_x),
                .mu_y       (mu_y),
                .unknown    (unknown),
                .at_bound   (at_bound),
                .saturated  (clipped_least)
            );

            assign saturated = clipped_u || clipped_least;

            wire _unused = &{1'b0, CELLS != 0, CELL_ELEMENTS != 0, SHARE_SHIFT != 0};
        end else begin : gen_walk
            wire value_valid;
            wire [VALUE_BITS-1:0] value;

            sptfra_plane #(
                .COLUMNS          (COLUMNS),
                .ROWS             (ROWS),
                .DATA_BITS        (DATA_BITS),
                .ROW_WIDTH        (ROW_WIDTH),
                .CELLS            (CELLS),
                .CELL_ELEMENTS    (CELL_ELEMENTS),
                .SHARE_SHIFT      (SHARE_SHIFT),
                .VALUE_BITS       (VALUE_BITS),
                .EXPECTED_LATENCY (EXPECTED_PLANE_LATENCY)
            ) plane (
                .clock       (clock),
                .reset       (reset),
                .u_valid     (u_valid),
                .u_quad      (u_quad),
                .u_values    (u_values),
                .fill_bank   (fill_bank),
                .search_bank (search_bank),
                .start       (start),
                .largest     (largest),
                .value_valid (value_valid),
                .value       (value)
            );

            sptfra_level_set #(
                .VALUE_BITS       (VALUE_BITS),
                .SHARE_SHIFT      (SHARE_SHIFT),
                .EXPECTED_LATENCY (EXPECTED_LEVEL_LATENCY)
            ) level_set (
                .clock       (clock),
                .reset       (reset),
                .start       (start),
                .stress_sum  (stress_sum),
                .value_valid (value_valid),
                .value       (value),
                .done        (done),
                .mu_x        (mu_x),
                .mu_y        (mu_y),
                .unknown     (unknown),
                .at_bound    (at_bound)
            );

            assign saturated = 1'b0;
            assign read_valid = 1'b0;
            assign read_quad = {ROW_WIDTH{1'b0}};
            assign read_values = {(3 * 4 * 27){1'b0}};

            wire _unused = &{1'b0, U_LEFT != 0, TAXELS != 0};
        end
    endgenerate

endmodule

`default_nettype wire
