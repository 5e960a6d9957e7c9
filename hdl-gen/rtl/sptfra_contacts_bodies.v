// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Normal forces of an answer as weights, whole numbers of a frame's step: what presses counts, what pulls is 0. By
// them the bodies are counted, and the taxels go to the nearest.

`default_nettype none

module sptfra_contacts_bodies #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bodies that have a region
    parameter CONTACTS = 4,
    // Distances of neighbours in micrometres
    parameter STEP_X = 2000,
    parameter STEP_Y = 2000,
    parameter STEP_DIAGONAL = 2828,
    // Cycles, see sptfra_regions
    parameter integer EXPECTED_COUNTED = 0,
    parameter integer EXPECTED_PARTED = 0,
    // Derived
    parameter TAXEL_WIDTH = (COLUMNS * ROWS > 8) ? $clog2(COLUMNS * ROWS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire signed [9:0] unit, // power of two of a step; held
    // What presses most; it is a weight 3 cycles later, and taken in the last cycle of weighs_largest
    input  wire weighs_largest,
    input  wire [31:0] presses,
    // Normal forces, float32: 1 cycle
    output wire [TAXEL_WIDTH-1:0] normal_address,
    input  wire [31:0] normal_word,
    // See sptfra_regions
    input  wire start,
    output wire counted,
    output wire [7:0] bodies,
    output wire [3:0] kept,
    output wire [16*CONTACTS-1:0] taxels,
    output wire parted,
    input  wire [TAXEL_WIDTH-1:0] region_address,
    output wire [2:0] region,
    input  wire [TAXEL_WIDTH-1:0] list_address,
    output wire [TAXEL_WIDTH-1:0] list_taxel,
    output wire [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes
);

    wire [25:0] magnitude;
    wire negative;
    wire clipped;
    wire signed [26:0] fixed;
    wire [25:0] weight = negative ? magnitude : 26'd0;
    reg  [25:0] largest;

    sptfra_align #(
        .WIDTH (27)
    ) align (
        .clock      (clock),
        .enable     (1'b1),
        .float_bits (weighs_largest ? presses : normal_word),
        .unit       (unit),
        .magnitude  (magnitude),
        .negative   (negative),
        .clipped    (clipped),
        .fixed      (fixed)
    );

    always @(posedge clock) begin
        if (weighs_largest) begin
            largest <= weight;
        end
    end

    sptfra_regions #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .CONTACTS         (CONTACTS),
        .STEP_X           (STEP_X),
        .STEP_Y           (STEP_Y),
        .STEP_DIAGONAL    (STEP_DIAGONAL),
        .WEIGHT_LATENCY   (4),
        .EXPECTED_COUNTED (EXPECTED_COUNTED),
        .EXPECTED_PARTED  (EXPECTED_PARTED)
    ) regions (
        .clock          (clock),
        .reset          (reset),
        .start          (start),
        .largest        (largest),
        .weight_address (normal_address),
        .weight         (weight),
        .counted        (counted),
        .bodies         (bodies),
        .kept           (kept),
        .taxels         (taxels),
        .parted         (parted),
        .region_address (region_address),
        .region         (region),
        .list_address   (list_address),
        .list_taxel     (list_taxel),
        .sizes          (sizes)
    );

    // Of the largest of the frame's forces a step has 22 bits: none is clipped
    wire _unused = &{1'b0, fixed, clipped};

endmodule

`default_nettype wire
