// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Mask of the images of an orbit that are taxels of their own. On a centre line of the grid images coincide, and only
// the first counts. Combinational.
//
// Image 1 is image 0 mirrored in x, image 2 in y, image 3 in both.

`default_nettype none

module sptfra_orbit_images #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of an orbit's number
    parameter integer ROW_WIDTH = 5
) (
    input  wire [ROW_WIDTH-1:0] orbit,
    output wire [3:0] counts
);

    localparam integer ORBIT_COLUMNS = (COLUMNS + 1) / 2;
    localparam integer ORBIT_ROWS = (ROWS + 1) / 2;
    localparam integer LAST_ROW = ORBIT_COLUMNS * (ORBIT_ROWS - 1);

    wire [31:0] number = { {(32 - ROW_WIDTH){1'b0}}, orbit};
    wire [ORBIT_ROWS-1:0] ends; // the orbit is the last one of this row
    wire on_centre_x = (COLUMNS % 2 == 1) && (ends != {ORBIT_ROWS{1'b0}});
    wire on_centre_y = (ROWS % 2 == 1) && (number >= LAST_ROW);

    genvar index;
    for (index = 0; index < ORBIT_ROWS; index = index + 1) begin : gen_rows
        assign ends[index] = (number == ORBIT_COLUMNS * (index + 1) - 1);
    end

    assign counts = {!on_centre_x && !on_centre_y, !on_centre_y, !on_centre_x, 1'b1};

endmodule

`default_nettype wire
