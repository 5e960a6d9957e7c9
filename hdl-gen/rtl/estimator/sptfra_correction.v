// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Correction of a frame's friction pair: features of the contact, then the network.
//
// The next frame may be searched meanwhile. While one frame is corrected, the features of another may be made. Latency
// from start to done: 11 cycles, one per word of each pass, one per unit of a pass, and 14.

`default_nettype none

module sptfra_correction #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Taxels on either side of the window's middle
    parameter integer HALF_X = 4,
    parameter integer HALF_Y = 4,
    // Words of inputs, passes over them, and hidden units in each
    parameter integer LENGTH = 27,
    parameter integer PASSES = 4,
    parameter integer AT_ONCE = 4,
    // Left shift of a stress times the reciprocal of sum |b|; bits dropped from a unit's sums, and from the output's
    parameter integer STRESS_LEFT = 9,
    parameter integer UNIT_SHIFT = 12,
    parameter integer CORRECTION_SHIFT = 12,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Name of the ROM files, without what they hold
    parameter ROM_NAME = "",
    // Checked in simulation, 0: unchecked: cycles from the features' start to their end
    parameter integer EXPECTED_FEATURES_LATENCY = 0,
    // ... from the first input of the network to the correction
    parameter integer EXPECTED_NETWORK_LATENCY = 0,
    // Derived: orbits, and the bits of their number
    parameter integer ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter integer ROW_WIDTH = (ORBITS > 8) ? $clog2(ORBITS) : 3
) (
    input  wire clock,
    input  wire reset,
    // u_q of an orbit's taxels, image 0 and u_0 in the lowest bits, as the search reads them
    input  wire read_valid,
    input  wire [ROW_WIDTH-1:0] read_orbit,
    input  wire [3*4*27-1:0] read_values,
    // A frame is searched, with its sum |b| held from the next cycle on until the features start
    input  wire search_start,
    input  wire [39:0] stress_sum,
    // Features, with these held from the next cycle on until the window is done
    input  wire features_start,
    input  wire signed [17:0] mu_x, // the centroid of its level set, 16 fraction bits
    input  wire signed [17:0] mu_y,
    output wire features_done, // one cycle
    output wire saturated, // a stress was clipped; held until the next features
    // Correction of what the features hold: a window is shown, then the next ones may start
    input  wire start,
    output wire window_done, // one cycle
    // Result, held until the next start: within 1/4, 16 fraction bits
    output wire done, // one cycle
    output wire signed [17:0] correction_x,
    output wire signed [17:0] correction_y
);

    localparam integer WORD_WIDTH = $clog2(LENGTH);

    wire input_valid;
    wire [WORD_WIDTH-1:0] input_word;
    wire [4*27-1:0] input_values;
    wire first_input;

    sptfra_features #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .ROW_WIDTH        (ROW_WIDTH),
        .HALF_X           (HALF_X),
        .HALF_Y           (HALF_Y),
        .LENGTH           (LENGTH),
        .WORD_WIDTH       (WORD_WIDTH),
        .STRESS_LEFT      (STRESS_LEFT),
        .EXPECTED_LATENCY (EXPECTED_FEATURES_LATENCY)
    ) features (
        .clock          (clock),
        .reset          (reset),
        .start          (search_start),
        .stress_sum     (stress_sum),
        .read_valid     (read_valid),
        .read_orbit     (read_orbit),
        .read_values    (read_values),
        .features_start (features_start),
        .mu_x           (mu_x),
        .mu_y           (mu_y),
        .features_done  (features_done),
        .saturated      (saturated),
        .window_start   (start),
        .input_valid    (input_valid),
        .input_first    (first_input),
        .input_word     (input_word),
        .input_values   (input_values),
        .window_done    (window_done)
    );

    sptfra_network #(
        .LENGTH           (LENGTH),
        .WORD_WIDTH       (WORD_WIDTH),
        .PASSES           (PASSES),
        .AT_ONCE          (AT_ONCE),
        .UNIT_SHIFT       (UNIT_SHIFT),
        .CORRECTION_SHIFT (CORRECTION_SHIFT),
        .ROM_DIR          (ROM_DIR),
        .ROM_NAME         (ROM_NAME),
        .EXPECTED_LATENCY (EXPECTED_NETWORK_LATENCY)
    ) network (
        .clock        (clock),
        .reset        (reset),
        .input_valid  (input_valid),
        .input_word   (input_word),
        .input_values (input_values),
        .start        (first_input),
        .done         (done),
        .correction_x (correction_x),
        .correction_y (correction_y)
    );

endmodule

`default_nettype wire
