// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Walks over a grid's taxels in raster order, there or back: a taxel a cycle and a step between rows, or two cycles a
// taxel, with rows of at least four steps.
//
// From start to the first step: 1 cycle.

`default_nettype none

module sptfra_regions_walk #(
    // Taxels along x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Derived
    parameter TAXEL_WIDTH = (COLUMNS * ROWS > 8) ? $clog2(COLUMNS * ROWS) : 3,
    parameter LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire back, // at start: from the last taxel to the first
    input  wire slow, // from the cycle after start: two cycles a step
    // The step
    output reg  walks,
    output reg  second, // cycle of a slow one
    output reg  [TAXEL_WIDTH-1:0] taxel, // the next one, at a border
    output wire border,
    output wire first_row,
    output wire last_row,
    output wire before_border, // the last taxel of a row
    output wire ends_row, // the last step of it
    output wire [LABEL_WIDTH-1:0] fresh, // name of a run that begins: the row, odd or even, and half the column
    output wire last
);

    generate
        if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
            sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
        end
    endgenerate

    localparam SLOW_BORDER = (COLUMNS > 3) ? COLUMNS : 3;
    localparam COLUMN_WIDTH = $clog2(SLOW_BORDER + 1);
    localparam ROW_WIDTH = $clog2(ROWS);
    localparam [31:0] BORDER = COLUMNS;
    localparam [31:0] LAST_COLUMN = COLUMNS - 1;
    localparam [31:0] LAST_SLOW = SLOW_BORDER;
    localparam [31:0] LAST_ROW = ROWS - 1;
    localparam [31:0] LAST_TAXEL = COLUMNS * ROWS - 1;

    reg backwards;
    reg [COLUMN_WIDTH-1:0] column; // of the walk: backwards from the last one
    reg [ROW_WIDTH-1:0] row;
    wire goes_on = walks && (!slow || second);
    wire [31:0] column_wide = {{(32-COLUMN_WIDTH){1'b0}}, column};

    assign border = (column >= BORDER[COLUMN_WIDTH-1:0]);
    assign before_border = (column == LAST_COLUMN[COLUMN_WIDTH-1:0]);
    assign ends_row = (column == (slow ? LAST_SLOW[COLUMN_WIDTH-1:0] : BORDER[COLUMN_WIDTH-1:0]));
    assign first_row = (row == {ROW_WIDTH{1'b0}});
    assign last_row = (row == LAST_ROW[ROW_WIDTH-1:0]);
    assign fresh = {row[0], column_wide[LABEL_WIDTH-1:1]};
    assign last = goes_on && ends_row && last_row;

    always @(posedge clock) begin
        second <= walks && !second;
        if (goes_on) begin
            column <= ends_row ? {COLUMN_WIDTH{1'b0}} : column + 1'b1;
            if (ends_row) begin
                row <= row + 1'b1;
            end
            if (!border) begin
                taxel <= backwards ? taxel - 1'b1 : taxel + 1'b1;
            end
        end
        if (last) begin
            walks <= 1'b0;
        end
        if (start) begin
            walks <= 1'b1;
            second <= 1'b0;
            backwards <= back;
            column <= {COLUMN_WIDTH{1'b0}};
            row <= {ROW_WIDTH{1'b0}};
            taxel <= back ? LAST_TAXEL[TAXEL_WIDTH-1:0] : {TAXEL_WIDTH{1'b0}};
        end
        if (reset) begin
            walks <= 1'b0;
        end
    end

    wire _unused = &{1'b0, column_wide};

endmodule

`default_nettype wire
