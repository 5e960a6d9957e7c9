// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The quad on the other side of the diagonal, on a square grid of SIDE by SIDE quads: combinational.

`default_nettype none

module sptfra_diagonal_mirror #(
    // Quads along a side
    parameter SIDE = 5,
    // Bits of a quad's number
    parameter ROW_WIDTH = 5
) (
    input  wire [ROW_WIDTH-1:0] quad,
    output wire [ROW_WIDTH-1:0] image
);

    localparam QUADS = SIDE * SIDE;
    localparam HALF = (SIDE > 1) ? $clog2(SIDE) : 1;

    function [QUADS*ROW_WIDTH-1:0] images(input integer side);
        integer index;
        integer place;
        reg [31:0] other;
        begin
            images = {(QUADS*ROW_WIDTH){1'b0}};
            for (index = 0; index < side * side; index = index + 1) begin
                other = (index % side) * side + index / side;
                for (place = 0; place < ROW_WIDTH; place = place + 1) begin
                    images[ROW_WIDTH*index + place] = other[place];
                end
            end
        end
    endfunction

    generate
        if ((SIDE > 1) && (SIDE == (1 << HALF)) && (ROW_WIDTH == 2 * HALF)) begin : gen_exchange
            // Row and column change places
            assign image = {quad[HALF-1:0], quad[2*HALF-1:HALF]};
        end else begin : gen_table
            localparam [QUADS*ROW_WIDTH-1:0] IMAGES = images(SIDE);

            assign image = IMAGES[ROW_WIDTH*quad +: ROW_WIDTH];
        end
    endgenerate

endmodule

`default_nettype wire
