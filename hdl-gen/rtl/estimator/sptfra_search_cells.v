// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The cells of the search side by side, as many for each channel, and the tree that adds their sums.
//
// Every taxel's u_q goes to its own cell. Last taxel's address to totals: 5 cycles, with three points 6, and one for
// each level of the tree.

`default_nettype none

module sptfra_search_cells #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Taxels that arrive at a time: 4, the images of an orbit, or 1
    parameter integer CHANNELS = 4,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of an orbit or taxel
    parameter integer ROW_WIDTH = 5,
    // Cells, as many for each channel
    parameter integer CELLS = 16,
    // Taxels of a cell, a power of two
    parameter integer CELL_ELEMENTS = 8,
    // Bits of a taxel's place in its cell
    parameter integer ELEMENT_WIDTH = 3,
    // Points at a time, 1 or 3, a tree each
    parameter integer POINTS = 1
) (
    input  wire clock,
    input  wire reset,
    // Fill: u_q, channel 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_row,
    input  wire [CHANNELS*DATA_BITS-1:0] u_values,
    input  wire fill_bank,
    // Read, of all cells the same place
    input  wire read,
    input  wire bank,
    input  wire [ELEMENT_WIDTH-1:0] element,
    input  wire alpha_pass,
    input  wire beta_pass,
    input  wire x_is_free,
    input  wire want_slope,
    input  wire signed [17:0] factor,
    input  wire [2:0] round, // with three points: see sptfra_search_cell
    // Results
    input  wire signed [47:0] level,
    output wire [48*POINTS-1:0] totals, // of all taxels
    output wire [POINTS-1:0] fits_level, // total <= level
    output wire saturated // an alpha or beta in the cycle before
);

    // Rows: orbits, or taxels
    localparam integer ELEMENTS = (CHANNELS == 4) ? ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2) : COLUMNS * ROWS;
    localparam integer GROUPS = CELLS / CHANNELS;
    localparam integer LAST_COUNT = ELEMENTS - (GROUPS - 1) * CELL_ELEMENTS;

    if ((CELLS % CHANNELS != 0) || (LAST_COUNT < 1) || (LAST_COUNT > CELL_ELEMENTS)) begin : gen_check_cells
        sptfra_error_cells_do_not_hold_the_taxels invalid ();
    end

    // ---- Where u_q goes
    wire [31:0] group = { {(32 - ROW_WIDTH){1'b0}}, u_row} / CELL_ELEMENTS;
    wire [ELEMENT_WIDTH-1:0] fill_element = (CELL_ELEMENTS == 1) ? {ELEMENT_WIDTH{1'b0}} : u_row[ELEMENT_WIDTH-1:0];
    wire [3:0] counts;

    sptfra_orbit_images #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .ROW_WIDTH (ROW_WIDTH)
    ) images (
        .orbit  (u_row),
        .counts (counts)
    );

    // ---- Cells
    wire [48*POINTS*CELLS-1:0] sums;
    wire [CELLS-1:0] cell_saturated;

    genvar index;
    for (index = 0; index < CELLS; index = index + 1) begin : gen_cells
        wire signed [DATA_BITS-1:0] u_image = u_values[DATA_BITS*(index % CHANNELS) +: DATA_BITS];
        wire signed [26:0] u_wide = { {(28 - DATA_BITS){u_image[DATA_BITS-1]}}, u_image[DATA_BITS-2:0]};
        wire signed [26:0] u_value = ((CHANNELS == 1) || counts[index % CHANNELS]) ? u_wide : 27'sd0;

        sptfra_search_cell #(
            .CELL_ELEMENTS (CELL_ELEMENTS),
            .ELEMENT_WIDTH (ELEMENT_WIDTH),
            .COUNT         ((index / CHANNELS == GROUPS - 1) ? LAST_COUNT : CELL_ELEMENTS),
            .POINTS        (POINTS)
        ) rectifiers (
            .clock        (clock),
            .reset        (reset),
            .fill         (u_valid & {3{group == index / CHANNELS}}),
            .fill_bank    (fill_bank),
            .fill_element (fill_element),
            .fill_value   (u_value),
            .read         (read),
            .first        (element == {ELEMENT_WIDTH{1'b0}}),
            .bank         (bank),
            .element      (element),
            .alpha_pass   (alpha_pass),
            .beta_pass    (beta_pass),
            .x_is_free    (x_is_free),
            .want_slope   (want_slope),
            .factor       (factor),
            .round        (round),
            .sums         (sums[48*POINTS*index +: 48*POINTS]),
            .saturated    (cell_saturated[index])
        );
    end

    assign saturated = (cell_saturated != {CELLS{1'b0}});

    // ---- Sums, and whether they are within the level
    genvar point;
    for (point = 0; point < POINTS; point = point + 1) begin : gen_trees
        wire [48*CELLS-1:0] terms;
        wire signed [47:0] total;
        wire signed [47:0] total_left;
        wire signed [47:0] total_right;

        for (index = 0; index < CELLS; index = index + 1) begin : gen_terms
            assign terms[48*index +: 48] = sums[48*(POINTS*index + point) +: 48];
        end

        sptfra_tree #(
            .COUNT (CELLS),
            .WIDTH (48)
        ) tree (
            .clock   (clock),
            .numbers (terms),
            .halves  ({total_right, total_left}),
            .result  (total)
        );

        assign totals[48*point +: 48] = total;

        if (CELLS == 1) begin : gen_compare
            assign fits_level[point] = (total <= level);

            wire _unused = &{1'b0, total_left, total_right};
        end else begin : gen_compare_beside
            // Beside the root of the tree, rather than behind it
            wire signed [49:0] room = { {2{level[47]}}, level} - { {2{total_left[47]}}, total_left}
                - { {2{total_right[47]}}, total_right};
            reg fits;

            always @(posedge clock) begin
                fits <= !room[49];
            end

            assign fits_level[point] = fits;

            wire _unused = &{1'b0, room[48:0]};
        end
    end

    wire _unused = &{1'b0, counts};

endmodule

`default_nettype wire
