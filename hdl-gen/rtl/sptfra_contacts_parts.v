// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// From forces to the frames of the bodies that have them: the forces as whole numbers, what those of each region
// cause, and that in float32. The bank of the forces that a field goes to is not read meanwhile.

`default_nettype none

module sptfra_contacts_parts #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bodies that have a region
    parameter CONTACTS = 4,
    // Power of two of a step of the coefficients in Pa/N
    parameter signed [9:0] COEFFICIENT_UNIT = 10'sd0,
    // 1: the sensor reads no tension
    parameter CLIPPED = 0,
    // Coefficients by distance
    parameter ROM_DIR = "",
    parameter FILE = "",
    // Derived
    parameter TAXEL_WIDTH = (COLUMNS * ROWS > 8) ? $clog2(COLUMNS * ROWS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire signed [9:0] unit, // power of two of a step of the forces; held
    input  wire begins, // a frame of several bodies
    output reg  saturated, // a number of that frame did not fit
    // A field: see sptfra_forces
    input  wire field_begins,
    input  wire field_valid,
    input  wire [31:0] field_word,
    input  wire adds,
    input  wire bank,
    output wire settled,
    // The forces in bank 0 of a taxel, for the output: 1 cycle
    input  wire output_reads,
    input  wire output_advance,
    input  wire [TAXEL_WIDTH-1:0] output_taxel,
    output wire [80:0] forces,
    // What the forces of a bank cause, by body: see sptfra_parting
    input  wire part_start,
    input  wire part_bank,
    output wire part_done,
    input  wire [3:0] kept,
    input  wire [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes,
    output wire [TAXEL_WIDTH-1:0] list_address,
    input  wire [TAXEL_WIDTH-1:0] list_taxel,
    // The frame of a body: see sptfra_parted_frames
    input  wire send_start,
    input  wire [3:0] body,
    output wire advance,
    output wire [TAXEL_WIDTH-1:0] taxel,
    input  wire [2:0] region,
    input  wire [31:0] stress,
    output wire [31:0] word,
    output wire word_last,
    output wire word_valid,
    input  wire word_ready
);

    localparam TAXELS = COLUMNS * ROWS;
    localparam BODY_WIDTH = (CONTACTS > 4) ? 3 : (CONTACTS > 2) ? 2 : 1;

    wire [TAXEL_WIDTH-1:0] force_taxel;
    wire [BODY_WIDTH+TAXEL_WIDTH-1:0] part_address;
    wire signed [47:0] part;
    wire force_clips, stress_clips;

    always @(posedge clock) begin
        saturated <= !begins && (saturated || force_clips || stress_clips);
        if (reset) begin
            saturated <= 1'b0;
        end
    end

    sptfra_forces #(
        .TAXELS (TAXELS)
    ) force_memory (
        .clock        (clock),
        .reset        (reset),
        .begins       (field_begins),
        .word_valid   (field_valid),
        .word         (field_word),
        .unit         (unit),
        .adds         (adds),
        .bank         (bank),
        .settled      (settled),
        .clips        (force_clips),
        .read_enable  (output_reads ? output_advance : 1'b1),
        .read_address (output_reads ? {1'b0, output_taxel} : {part_bank, force_taxel}),
        .forces       (forces)
    );

    sptfra_parting #(
        .COLUMNS    (COLUMNS),
        .ROWS       (ROWS),
        .CONTACTS   (CONTACTS),
        .BODY_WIDTH (BODY_WIDTH),
        .ROM_DIR    (ROM_DIR),
        .FILE       (FILE)
    ) parting (
        .clock        (clock),
        .reset        (reset),
        .start        (part_start),
        .kept         (kept),
        .done         (part_done),
        .sizes        (sizes),
        .list_address (list_address),
        .list_taxel   (list_taxel),
        .force_taxel  (force_taxel),
        .forces       (forces),
        .part_enable  (advance),
        .part_address (part_address),
        .part         (part)
    );

    sptfra_parted_frames #(
        .TAXELS     (TAXELS),
        .BODY_WIDTH (BODY_WIDTH),
        .UNIT       (COEFFICIENT_UNIT),
        .CLIPPED    (CLIPPED)
    ) frames (
        .clock        (clock),
        .reset        (reset),
        .start        (send_start),
        .kept         (kept),
        .body         (body),
        .unit         (unit),
        .advance      (advance),
        .taxel        (taxel),
        .part_address (part_address),
        .region       (region),
        .stress       (stress),
        .part         (part),
        .clips        (stress_clips),
        .word         (word),
        .word_last    (word_last),
        .word_valid   (word_valid),
        .word_ready   (word_ready)
    );

endmodule

`default_nettype wire
