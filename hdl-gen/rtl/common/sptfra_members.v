// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Mask of the members of a quad that are taxels of their own. On a centre line of the grid members coincide, and only
// the first counts. Combinational.
//
// Member 1 is member 0 mirrored in x, member 2 in y, member 3 in both.

`default_nettype none

module sptfra_members #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of a quad's number
    parameter integer ROW_WIDTH = 5
) (
    input  wire [ROW_WIDTH-1:0] quad,
    output wire [3:0] counts
);

    localparam integer QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam integer QUAD_ROWS = (ROWS + 1) / 2;
    localparam integer LAST_ROW = QUAD_COLUMNS * (QUAD_ROWS - 1);

    wire [31:0] number = { {(32 - ROW_WIDTH){1'b0}}, quad};
    wire [QUAD_ROWS-1:0] ends; // the quad is the last one of this row
    wire on_centre_x = (COLUMNS % 2 == 1) && (ends != {QUAD_ROWS{1'b0}});
    wire on_centre_y = (ROWS % 2 == 1) && (number >= LAST_ROW);

    genvar index;
    generate
        for (index = 0; index < QUAD_ROWS; index = index + 1) begin : gen_rows
            assign ends[index] = (number == QUAD_COLUMNS * (index + 1) - 1);
        end
    endgenerate

    assign counts = {!on_centre_x && !on_centre_y, !on_centre_y, !on_centre_x, 1'b1};

endmodule

`default_nettype wire
