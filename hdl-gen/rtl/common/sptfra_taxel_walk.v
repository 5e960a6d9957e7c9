// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Raster counter over the taxels of a grid, up to two a step. It gives each taxel's orbit and image.
//
// Latency from step to orbit and image: 1 cycle. Interval: 1 cycle.

`default_nettype none

module sptfra_taxel_walk #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Taxel to begin with: 0 or 1
    parameter FIRST = 0,
    // Derived
    parameter ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ORBITS > 8) ? $clog2(ORBITS) : 3
) (
    input  wire clock,
    input  wire rewind,
    input  wire step,
    input  wire [1:0] taxels, // 0, 1 or 2 of them
    output wire [ROW_WIDTH-1:0] orbit,
    output wire [1:0] image // bit 0: mirrored in x, bit 1: in y
);

    localparam X_WIDTH = $clog2(COLUMNS) + 1; // room for two more than the last
    localparam Y_WIDTH = $clog2(ROWS) + 1; // and for what lies behind the last row
    localparam [31:0] SIDE_X = COLUMNS;
    localparam [31:0] LAST_X = COLUMNS - 1;
    localparam [31:0] LEFT_X = (COLUMNS + 1) / 2 - 1;
    localparam [31:0] UPPER_Y = (ROWS + 1) / 2 - 1;
    localparam [31:0] ORBIT_COLUMNS = (COLUMNS + 1) / 2;
    localparam [31:0] FIRST_X = FIRST;

    reg [X_WIDTH-1:0] column;
    reg [Y_WIDTH-1:0] row;
    reg [ROW_WIDTH-1:0] row_base; // first orbit of the row
    wire [X_WIDTH-1:0] reached = column + {{(X_WIDTH-2){1'b0}}, taxels};
    wire row_ends = (reached > LAST_X[X_WIDTH-1:0]);
    wire [Y_WIDTH:0] behind_middle = {1'b0, row} - {1'b0, UPPER_Y[Y_WIDTH-1:0]}; // the last of the orbits' rows
    wire upper_row = behind_middle[Y_WIDTH];
    wire middle_row = (behind_middle == {(Y_WIDTH+1){1'b0}});
    wire mirrored_x = (column > LEFT_X[X_WIDTH-1:0]);
    wire mirrored_y = !upper_row && !middle_row;
    wire [X_WIDTH-1:0] orbit_x = mirrored_x ? LAST_X[X_WIDTH-1:0] - column : column;
    wire [31:0] orbit_x_wide = {{(32-X_WIDTH){1'b0}}, orbit_x};

    assign orbit = row_base + orbit_x_wide[ROW_WIDTH-1:0];
    assign image = {mirrored_y, mirrored_x};

    always @(posedge clock) begin
        if (step) begin
            column <= row_ends ? reached - SIDE_X[X_WIDTH-1:0] : reached;
            if (row_ends) begin
                row <= row + 1'b1;
                if (upper_row) begin
                    row_base <= row_base + ORBIT_COLUMNS[ROW_WIDTH-1:0];
                end else if (!middle_row || (ROWS % 2 == 1)) begin
                    row_base <= row_base - ORBIT_COLUMNS[ROW_WIDTH-1:0];
                end
            end
        end
        if (rewind) begin
            column <= FIRST_X[X_WIDTH-1:0];
            row <= {Y_WIDTH{1'b0}};
            row_base <= {ROW_WIDTH{1'b0}};
        end
    end

    wire _unused = &{1'b0, orbit_x_wide};

endmodule

`default_nettype wire
