// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Blobs of a grid's taxels in raster order, one taxel a cycle: neighbours along x or y that both touch are of one blob.
//
// The labels of the last row's taxels stand in a shift register, one step of it longer than a row: each row ends with a
// step where nothing touches. A taxel whose neighbours have two labels makes one of them in the same cycle, wherever it
// stands. A blob that begins is named after its row, odd or even, and half its column; so each run of taxels has a name
// of its own in its row, gives it to what it touches above, and the names of a row are free again two rows later: for
// any grid there are no more than COLUMNS + 1 of them.
//
// From a taxel to what it does: 1 cycle.

`default_nettype none

module sptfra_blob_labels #(
    // Taxels along x
    parameter COLUMNS = 10,
    // Derived
    parameter LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2
) (
    input  wire clock,
    input  wire clear, // a frame begins: nothing touches above it
    // Taxels, and a step that touches nothing at the end of each row
    input  wire step,
    input  wire touches,
    input  wire [LABEL_WIDTH-1:0] fresh, // of a blob that would begin here
    // What the taxel is
    output reg  counts, // it is of a blob,
    output reg  begins, // the first of a run,
    output reg  [LABEL_WIDTH-1:0] label,
    output reg  joins, // and one with another blob above it,
    output reg  [LABEL_WIDTH-1:0] joined // which had this label until now
);

    generate
        if ((COLUMNS < 2) || (COLUMNS > 64)) begin : gen_check_columns
            sptfra_error_columns_must_be_2_to_64 invalid ();
        end
    endgenerate

    // ---- What touched in the last row's steps, the newest in the lowest bits
    reg [COLUMNS:0] there;
    reg [LABEL_WIDTH*(COLUMNS+1)-1:0] labels;
    wire [LABEL_WIDTH-1:0] above = labels[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH];
    wire [LABEL_WIDTH-1:0] own = there[0] ? labels[LABEL_WIDTH-1:0] : fresh;
    wire meets = touches && there[COLUMNS] && (above != own);
    wire [LABEL_WIDTH*(COLUMNS+1)-1:0] renamed;
    genvar index;

    generate
        for (index = 0; index <= COLUMNS; index = index + 1) begin : gen_labels
            wire [LABEL_WIDTH-1:0] old = labels[LABEL_WIDTH*index +: LABEL_WIDTH];

            assign renamed[LABEL_WIDTH*index +: LABEL_WIDTH] = (meets && (old == above)) ? own : old;
        end
    endgenerate

    always @(posedge clock) begin
        if (step) begin
            there <= {there[COLUMNS-1:0], touches};
            labels <= {renamed[LABEL_WIDTH*COLUMNS-1:0], own};
        end
        if (clear) begin
            there <= {(COLUMNS+1){1'b0}};
        end
        counts <= step && touches;
        begins <= !there[0];
        label <= own;
        joins <= meets;
        joined <= above;
    end

    wire _unused = &{1'b0, renamed[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH]};

endmodule

`default_nettype wire
