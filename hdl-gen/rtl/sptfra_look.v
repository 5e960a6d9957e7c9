// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What the correction sees of a contact: the stress of the normal forces alone, in a window around its centre.
//
// Along its way: scale (1 / sum |b|, while the plane is searched), stress (taxel by taxel, its compression's moments),
// scale again (their centroid), window (folded into parity classes, for the network).

`default_nettype none

module sptfra_look #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of the number of a quad
    parameter integer ROW_WIDTH = 5,
    // Taxels on either side of the window's middle
    parameter integer HALF_X = 4,
    parameter integer HALF_Y = 4,
    // Words of the network's inputs
    parameter integer LENGTH = 27,
    // Bits of a word's number
    parameter integer WORD_WIDTH = 5,
    // Left shift of a stress times the reciprocal, before the right shift by the bits of sum |b|
    parameter integer STRESS_LEFT = 9,
    // From look_start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // A frame, with its sum |b| held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    // Its centroid of the level set is there, and held
    input  wire look_start,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // u_q of the taxels, three cycles after they are asked for
    output wire [ROW_WIDTH-1:0] u_quad,
    output wire [1:0] u_member,
    output wire [1:0] u_q,
    input  wire signed [26:0] u_value,
    // Inputs of the network
    output wire input_valid,
    output wire [WORD_WIDTH-1:0] input_word,
    output wire [4*27-1:0] input_values, // class 0 in the lowest bits
    output wire done, // one cycle, with the last of them
    output wire saturated // a share was clipped; held until the next start
);

    localparam integer X_WIDTH = (COLUMNS <= 2) ? 1 : $clog2(COLUMNS);
    localparam integer Y_WIDTH = (ROWS <= 2) ? 1 : $clog2(ROWS);

    // ---- Scale
    wire [5:0] sum_bits;
    wire signed [17:0] reciprocal;
    wire stresses_there;
    wire [47:0] weight_sum;
    wire [47:0] moment_x;
    wire [47:0] moment_y;
    wire centroid_there;
    wire [23:0] centroid_x;
    wire [23:0] centroid_y;

    sptfra_look_scale scale (
        .clock      (clock),
        .reset      (reset),
        .start      (start),
        .stress_sum (stress_sum),
        .sum_bits   (sum_bits),
        .reciprocal (reciprocal),
        .divide     (stresses_there),
        .weight_sum (weight_sum),
        .moment_x   (moment_x),
        .moment_y   (moment_y),
        .done       (centroid_there),
        .centroid_x (centroid_x),
        .centroid_y (centroid_y)
    );

    // ---- Stress
    wire share_valid;
    wire [Y_WIDTH+X_WIDTH-1:0] share_place;
    wire [24:0] share;

    sptfra_look_stress #(
        .COLUMNS     (COLUMNS),
        .ROWS        (ROWS),
        .ROW_WIDTH   (ROW_WIDTH),
        .X_WIDTH     (X_WIDTH),
        .Y_WIDTH     (Y_WIDTH),
        .STRESS_LEFT (STRESS_LEFT)
    ) stress (
        .clock       (clock),
        .reset       (reset),
        .clear       (start),
        .sum_bits    (sum_bits),
        .reciprocal  (reciprocal),
        .start       (look_start),
        .mu_x        (mu_x),
        .mu_y        (mu_y),
        .u_quad      (u_quad),
        .u_member    (u_member),
        .u_q         (u_q),
        .u_value     (u_value),
        .share_valid (share_valid),
        .share_place (share_place),
        .share       (share),
        .done        (stresses_there),
        .weight_sum  (weight_sum),
        .moment_x    (moment_x),
        .moment_y    (moment_y),
        .saturated   (saturated)
    );

    // ---- Window
    sptfra_look_window #(
        .COLUMNS    (COLUMNS),
        .ROWS       (ROWS),
        .X_WIDTH    (X_WIDTH),
        .Y_WIDTH    (Y_WIDTH),
        .HALF_X     (HALF_X),
        .HALF_Y     (HALF_Y),
        .LENGTH     (LENGTH),
        .WORD_WIDTH (WORD_WIDTH)
    ) window (
        .clock        (clock),
        .reset        (reset),
        .share_valid  (share_valid),
        .share_place  (share_place),
        .share        (share),
        .clear        (start),
        .start        (centroid_there),
        .centroid_x   (centroid_x),
        .centroid_y   (centroid_y),
        .mu_x         (mu_x),
        .mu_y         (mu_y),
        .input_valid  (input_valid),
        .input_word   (input_word),
        .input_values (input_values),
        .done         (done)
    );

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (look_start),
        .done  (done)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

endmodule

`default_nettype wire
