// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The first quad of each row of taxels, as the rows of a frame follow each other: up to the middle and back; where the
// rows are even in number, the middle one comes twice.

`default_nettype none

module sptfra_quad_rows #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Derived
    parameter QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3,
    parameter Y_WIDTH = $clog2(ROWS)
) (
    input  wire clock,
    input  wire restart, // with row 0
    input  wire next_row, // two cycles after the one before, or later
    input  wire [Y_WIDTH-1:0] row, // of taxels, the one that row_base is of
    output reg  [ROW_WIDTH-1:0] row_base
);

    localparam [31:0] QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam [31:0] MIDDLE_WIDE = (ROWS + 1) / 2 - 1;
    localparam [Y_WIDTH-1:0] MIDDLE = MIDDLE_WIDE[Y_WIDTH-1:0]; // the last of the quads' rows

    reg [ROW_WIDTH-1:0] next_base; // there a cycle after row and row_base

    always @(posedge clock) begin
        next_base <= row_base;
        if ((row > MIDDLE) || ((ROWS % 2 == 1) && (row == MIDDLE))) begin
            next_base <= row_base - QUAD_COLUMNS[ROW_WIDTH-1:0];
        end else if (row != MIDDLE) begin
            next_base <= row_base + QUAD_COLUMNS[ROW_WIDTH-1:0];
        end
        if (next_row) begin
            row_base <= next_base;
        end
        if (restart) begin
            row_base <= {ROW_WIDTH{1'b0}};
        end
    end

endmodule

`default_nettype wire
