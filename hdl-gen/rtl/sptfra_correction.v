// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The correction of a frame's friction: a look at its contact, and what the network makes of it. It has a copy of u_q
// of its own, so that the next frame may be searched meanwhile.

`default_nettype none

module sptfra_correction #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
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
    // 1: with the error that is left; bits dropped from its sum, and what is added to it then
    parameter integer DOUBT = 0,
    parameter integer DOUBT_SHIFT = 12,
    parameter signed [17:0] DOUBT_BASE = 18'sd0,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Name of the ROM files, without what they hold
    parameter ROM_NAME = "design",
    // Checked in simulation, 0: unchecked: cycles from the start to the last input of the network
    parameter integer EXPECTED_LOOK_LATENCY = 0,
    // ... from there to the correction
    parameter integer EXPECTED_NETWORK_LATENCY = 0,
    // Derived: quads, and the bits of their number
    parameter integer QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter integer ROW_WIDTH = (QUADS > 4) ? $clog2(QUADS) : 2
) (
    input  wire clock,
    input  wire reset,
    // u_q of a quad's taxels, member 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire fill_bank,
    input  wire [ROW_WIDTH-1:0] u_quad,
    input  wire [4*DATA_BITS-1:0] u_values,
    // A frame is searched, with its sum |b| held from the next cycle on until its correction starts
    input  wire search_start,
    input  wire [39:0] stress_sum,
    // Start, with these held from the next cycle on
    input  wire start,
    input  wire bank, // of its u_q
    input  wire signed [17:0] mu_x, // the centroid of its level set, 16 fraction bits
    input  wire signed [17:0] mu_y,
    // Result, held until the next start: within 1/4, 16 fraction bits
    output wire done, // one cycle
    output wire signed [17:0] correction_x,
    output wire signed [17:0] correction_y,
    output wire signed [17:0] error_log, // of base 2, of the error that is left over |F_z|, 12 fraction bits
    output wire saturated // a stress was clipped
);

    localparam integer WORD_WIDTH = $clog2(LENGTH);

    wire input_valid;
    wire [WORD_WIDTH-1:0] input_word;
    wire [4*27-1:0] input_values;
    wire look_done;
    wire [ROW_WIDTH-1:0] look_quad;
    wire [3*4*27-1:0] look_values;

    sptfra_taxel_memory #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .DATA_BITS (DATA_BITS),
        .ROW_WIDTH (ROW_WIDTH)
    ) taxels (
        .clock       (clock),
        .u_valid     (u_valid),
        .fill_bank   (fill_bank),
        .u_quad      (u_quad),
        .u_values    (u_values),
        .read_bank   (bank),
        .read_quad   (look_quad),
        .read_values (look_values)
    );

    sptfra_look #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .ROW_WIDTH        (ROW_WIDTH),
        .HALF_X           (HALF_X),
        .HALF_Y           (HALF_Y),
        .LENGTH           (LENGTH),
        .WORD_WIDTH       (WORD_WIDTH),
        .STRESS_LEFT      (STRESS_LEFT),
        .EXPECTED_LATENCY (EXPECTED_LOOK_LATENCY)
    ) look (
        .clock        (clock),
        .reset        (reset),
        .start        (search_start),
        .stress_sum   (stress_sum),
        .look_start   (start),
        .mu_x         (mu_x),
        .mu_y         (mu_y),
        .u_quad       (look_quad),
        .u_values     (look_values),
        .input_valid  (input_valid),
        .input_word   (input_word),
        .input_values (input_values),
        .done         (look_done),
        .saturated    (saturated)
    );

    sptfra_network #(
        .LENGTH           (LENGTH),
        .WORD_WIDTH       (WORD_WIDTH),
        .PASSES           (PASSES),
        .AT_ONCE          (AT_ONCE),
        .UNIT_SHIFT       (UNIT_SHIFT),
        .CORRECTION_SHIFT (CORRECTION_SHIFT),
        .DOUBT            (DOUBT),
        .DOUBT_SHIFT      (DOUBT_SHIFT),
        .DOUBT_BASE       (DOUBT_BASE),
        .ROM_DIR          (ROM_DIR),
        .ROM_NAME         (ROM_NAME),
        .EXPECTED_LATENCY (EXPECTED_NETWORK_LATENCY)
    ) network (
        .clock        (clock),
        .reset        (reset),
        .input_valid  (input_valid),
        .input_word   (input_word),
        .input_values (input_values),
        .start        (look_done),
        .done         (done),
        .correction_x (correction_x),
        .correction_y (correction_y),
        .error_log    (error_log)
    );

endmodule

`default_nettype wire
