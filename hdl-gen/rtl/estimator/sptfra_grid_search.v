// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Grid search: Condition 1 at SIDE x SIDE values of (mu_x, mu_y), 1/4 apart, and the centroid of its level set.
//
// The points are evaluated in parallel, or serially, a row of them at a time.
//
// Latency from start to done, with Q orbits:
//   parallel, one taxel a cycle   4 Q + 49 + 4 SIDE
//   parallel, two taxels a cycle  2 Q + 51 + 2 SIDE
//   serial                        SIDE (4 Q + 4) + 49

`default_nettype none

module sptfra_grid_search #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Points along an axis, 11 or 13; the generator sets 13
    parameter integer SIDE = 13,
    // Points evaluated at a time: all of them, or SIDE
    parameter integer PARALLEL = SIDE * SIDE,
    // Taxels a cycle: 1, or 2 with all points at a time, whose rows are then weighed in one cycle each
    parameter integer TAXELS = 1,
    // Bits of a value below the leading bit of sum |b|
    parameter integer FRACTION = 21,
    // Left shift of u before the right shift by the bits of sum |b|
    parameter integer U_LEFT = 22,
    // Checked in simulation, 0: unchecked: cycles from the start to the first row of points
    parameter integer EXPECTED_VALUES_LATENCY = 0,
    // ... from that row to the centroid
    parameter integer EXPECTED_LEVEL_LATENCY = 0,
    // Derived: orbits, and the bits of their number
    parameter integer ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter integer ROW_WIDTH = (ORBITS > 8) ? $clog2(ORBITS) : 3
) (
    input  wire clock,
    input  wire reset,
    // u_q of an orbit's taxels, image 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire [ROW_WIDTH-1:0] u_orbit,
    input  wire [4*DATA_BITS-1:0] u_values,
    input  wire fill_bank,
    input  wire search_bank,
    // Start, with these held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest, // max |b|
    // All of an orbit as it is first read: u_0 in the lowest bits
    output wire read_valid,
    output wire [ROW_WIDTH-1:0] read_orbit,
    output wire [3*4*27-1:0] read_values,
    // Result, held until the next start
    output wire done, // one cycle
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    output wire unknown, // nothing limits the friction
    output wire at_bound, // the least value lies on the border
    output wire saturated // a value was clipped
);

    localparam integer VALUE_BITS = FRACTION + 2;
    localparam integer MARGIN_BITS = FRACTION - 7;

    wire [MARGIN_BITS-1:0] margin;
    wire row_valid;
    wire again;
    wire [SIDE*VALUE_BITS-1:0] row_values;

    sptfra_grid_values #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .DATA_BITS        (DATA_BITS),
        .ROW_WIDTH        (ROW_WIDTH),
        .SIDE             (SIDE),
        .PARALLEL         (PARALLEL),
        .TAXELS           (TAXELS),
        .FRACTION         (FRACTION),
        .U_LEFT           (U_LEFT),
        .EXPECTED_LATENCY (EXPECTED_VALUES_LATENCY)
    ) values (
        .clock       (clock),
        .reset       (reset),
        .u_valid     (u_valid),
        .u_orbit     (u_orbit),
        .u_values    (u_values),
        .fill_bank   (fill_bank),
        .search_bank (search_bank),
        .start       (start),
        .stress_sum  (stress_sum),
        .largest     (largest),
        .margin      (margin),
        .read_valid  (read_valid),
        .read_orbit  (read_orbit),
        .read_values (read_values),
        .row_valid   (row_valid),
        .again       (again),
        .row_values  (row_values),
        .clipped     (saturated)
    );

    sptfra_grid_level #(
        .SIDE             (SIDE),
        .AT_ONCE          ((TAXELS == 1) ? 5 : SIDE),
        .FRACTION         (FRACTION),
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
        .at_bound   (at_bound)
    );

endmodule

`default_nettype wire
