// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The cells of the search along the line side by side, as many for each channel, and the tree that adds their sums.
//
// A cell has up to CELL_ELEMENTS taxels and one multiplier; every taxel's u_q goes to its own cell.
// Fill: u0, u1, u2 of its taxels arrive, also of the next frame while this one is searched. Passes: alpha = u0 + c0
// u_dependent, then beta = u_free + c1 u_dependent. Search: sums over the taxels with alpha + t beta > 0. The summand
// is beta (slope of B), or alpha + t beta without its last 8 bits (B). One taxel a cycle in each cell.
// With three points also those at t - h and t - 2 h, h = 2^(15 - 2 round).
// Last taxel's address to totals: 5 cycles, with three points 6, and one for each level of the tree.

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
    input  wire want_slope, // rather than B
    input  wire signed [17:0] factor, // t, c0 or c1
    input  wire [2:0] round,
    // Results
    input  wire signed [47:0] level,
    output wire [48*POINTS-1:0] totals, // of all taxels, at t, t - h, t - 2 h
    output wire [POINTS-1:0] fits_level, // total <= level
    output wire saturated // an alpha or beta in the cycle before
);

    localparam integer FRICTION_FRACTION = 16; // of t
    localparam integer LINE_FRACTION = 15; // of c0 and c1
    localparam integer RECTIFIER_DROP = 8;
    localparam integer DEPTH = 2 << ELEMENT_WIDTH; // two frames
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
    wire [ELEMENT_WIDTH:0] address = {bank, element};
    wire [ELEMENT_WIDTH:0] fill_address = {fill_bank, fill_element};
    wire first = (element == {ELEMENT_WIDTH{1'b0}}); // of a sum
    wire passing = alpha_pass || beta_pass;
    wire [48*CELLS*POINTS-1:0] sums; // of each point in all cells, then of the next point
    wire [CELLS-1:0] cell_saturated;

    genvar index;
    genvar point;
    for (index = 0; index < CELLS; index = index + 1) begin : gen_cells
        localparam integer COUNT = (index / CHANNELS == GROUPS - 1) ? LAST_COUNT : CELL_ELEMENTS;

        wire [2:0] fill = u_valid & {3{group == index / CHANNELS}}; // one bit for each of u0, u1, u2
        wire signed [DATA_BITS-1:0] u_image = u_values[DATA_BITS*(index % CHANNELS) +: DATA_BITS];
        wire signed [26:0] u_wide = { {(28 - DATA_BITS){u_image[DATA_BITS-1]}}, u_image[DATA_BITS-2:0]};
        wire signed [26:0] u_value = ((CHANNELS == 1) || counts[index % CHANNELS]) ? u_wide : 27'sd0;
        reg saturated_4;

        (* ram_style = "distributed" *) reg signed [26:0] memory_0 [0:DEPTH-1]; // u0
        (* ram_style = "distributed" *) reg signed [26:0] memory_1 [0:DEPTH-1]; // u1
        (* ram_style = "distributed" *) reg signed [26:0] memory_2 [0:DEPTH-1]; // u2
        (* ram_style = "distributed" *) reg signed [26:0] alphas [0:CELL_ELEMENTS-1];
        (* ram_style = "distributed" *) reg signed [26:0] betas [0:CELL_ELEMENTS-1];

        // ---- Stage 1: operands. What is equal in all cells is kept, for each to have its own at hand; but for the
        // factor, which is the multiplier's own register
        (* keep = "true" *) reg [4:1] valid;
        (* keep = "true" *) reg [5:1] firsts;
        (* keep = "true" *) reg [4:1] slopes;
        (* keep = "true" *) reg [3:1] alpha_passes;
        (* keep = "true" *) reg [3:1] beta_passes;
        (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_1;
        (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_2;
        (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_3;
        reg signed [26:0] addend_1;
        reg signed [26:0] multiplicand_1;
        reg signed [17:0] factor_1;
        wire in_cell = ({1'b0, element} < COUNT[ELEMENT_WIDTH:0]);
        wire signed [26:0] u_free = x_is_free ? memory_1[address] : memory_2[address];
        wire signed [26:0] u_dependent = x_is_free ? memory_2[address] : memory_1[address];

        always @(posedge clock) begin
            valid <= {valid[3:1], read && in_cell};
            firsts <= {firsts[4:1], first};
            slopes <= {slopes[3:1], want_slope};
            alpha_passes <= {alpha_passes[2:1], alpha_pass};
            beta_passes <= {beta_passes[2:1], beta_pass};
            element_1 <= element;
            element_2 <= element_1;
            element_3 <= element_2;
            addend_1 <= !passing ? alphas[element] : !beta_pass ? memory_0[address] : u_free;
            multiplicand_1 <= !passing ? betas[element] : u_dependent;
            factor_1 <= factor;
            if (reset) begin
                valid <= 4'd0;
            end
        end

        // ---- Stages 2 and 3: addend * 2^16 + factor * multiplicand; in the passes 2^15, plus half a step
        wire signed [44:0] product_2;
        reg signed [44:0] addend_2;
        reg signed [44:0] rectifier_3;
        reg signed [26:0] multiplicand_2;
        reg signed [26:0] multiplicand_3;

        // One step less where only the sign counts: positive is what then is not negative
        wire signed [26:0] addend_less = addend_1 - {26'd0, slopes[1]};

        sptfra_multiply multiplier (
            .clock       (clock),
            .enable      (1'b1),
            .coefficient (factor_1),
            .data        (multiplicand_1),
            .product     (product_2)
        );

        always @(posedge clock) begin
            addend_2 <= (alpha_passes[1] || beta_passes[1])
                ? { {(18 - LINE_FRACTION){addend_1[26]}}, addend_1, 1'b1, {(LINE_FRACTION - 1){1'b0}}}
                : { {(18 - FRICTION_FRACTION){addend_less[26]}}, addend_less, {FRICTION_FRACTION{slopes[1]}}};
            multiplicand_2 <= multiplicand_1;
            rectifier_3 <= addend_2 + product_2;
            multiplicand_3 <= multiplicand_2;
        end

        // ---- Alpha and beta, clipped to 27 bits
        wire signed [44-LINE_FRACTION:0] rounded = rectifier_3[44:LINE_FRACTION];
        wire sign = rectifier_3[44];
        wire fits = (rounded[44-LINE_FRACTION:26] == {(19 - LINE_FRACTION){rounded[26]}});
        wire signed [26:0] clipped = fits ? rounded[26:0] : {sign, {26{!sign}}};

        always @(posedge clock) begin
            if (fill[0]) begin
                memory_0[fill_address] <= u_value;
            end
            if (fill[1]) begin
                memory_1[fill_address] <= u_value;
            end
            if (fill[2]) begin
                memory_2[fill_address] <= u_value;
            end
            if (valid[3] && alpha_passes[3]) begin
                alphas[element_3] <= clipped;
            end
            if (valid[3] && beta_passes[3]) begin
                betas[element_3] <= clipped;
            end
            saturated_4 <= valid[3] && (alpha_passes[3] || beta_passes[3]) && !fits;
            if (reset) begin
                saturated_4 <= 1'b0;
            end
        end

        // ---- With three points a stage between: rectifiers at the others
        wire [45*POINTS-1:0] point_rectifiers;
        wire signed [26:0] slope_term;
        wire term_valid;
        wire term_slope;
        wire term_first;

        if (POINTS == 1) begin : gen_point
            assign point_rectifiers = rectifier_3;
            assign slope_term = multiplicand_3;
            assign term_valid = valid[3];
            assign term_slope = slopes[3];
            assign term_first = firsts[4];

            wire _unused = &{1'b0, valid[4], slopes[4], firsts[5], round};
        end else begin : gen_points
            (* keep = "true" *) reg [2:0] round_1;
            reg signed [41:0] part_2; // beta h
            reg signed [41:0] part_3;
            reg signed [44:0] rectifier_4;
            reg signed [44:0] rectifier_less_4;
            reg signed [44:0] rectifier_less_2_4;
            reg signed [26:0] multiplicand_4;

            always @(posedge clock) begin
                round_1 <= round;
                case (round_1)
                    3'd0: part_2 <= {multiplicand_1, 15'd0};
                    3'd1: part_2 <= { {2{multiplicand_1[26]}}, multiplicand_1, 13'd0};
                    3'd2: part_2 <= { {4{multiplicand_1[26]}}, multiplicand_1, 11'd0};
                    3'd3: part_2 <= { {6{multiplicand_1[26]}}, multiplicand_1, 9'd0};
                    3'd4: part_2 <= { {8{multiplicand_1[26]}}, multiplicand_1, 7'd0};
                    3'd5: part_2 <= { {10{multiplicand_1[26]}}, multiplicand_1, 5'd0};
                    3'd6: part_2 <= { {12{multiplicand_1[26]}}, multiplicand_1, 3'd0};
                    default: part_2 <= { {14{multiplicand_1[26]}}, multiplicand_1, 1'd0};
                endcase
                part_3 <= part_2;
                rectifier_4 <= rectifier_3;
                rectifier_less_4 <= rectifier_3 - { {3{part_3[41]}}, part_3};
                rectifier_less_2_4 <= rectifier_3 - { {2{part_3[41]}}, part_3, 1'b0};
                multiplicand_4 <= multiplicand_3;
            end

            assign point_rectifiers = {rectifier_less_2_4, rectifier_less_4, rectifier_4};
            assign slope_term = multiplicand_4;
            assign term_valid = valid[4];
            assign term_slope = slopes[4];
            assign term_first = firsts[5];
        end

        // ---- Last stages: what this taxel adds to a point, and the point's sum
        for (point = 0; point < POINTS; point = point + 1) begin : gen_sums
            wire [44:0] rectifier = point_rectifiers[45*point +: 45];
            reg signed [47:0] term;
            reg signed [47:0] sum;

            always @(posedge clock) begin
                if (!term_valid || rectifier[44]) begin
                    term <= 48'sd0;
                end else if (term_slope) begin
                    term <= { {21{slope_term[26]}}, slope_term};
                end else begin
                    term <= { {(3 + RECTIFIER_DROP){1'b0}}, rectifier[44:RECTIFIER_DROP]};
                end
                sum <= (term_first ? 48'sd0 : sum) + term;
            end

            assign sums[48*(CELLS*point + index) +: 48] = sum;

            wire _unused = &{1'b0, rectifier[RECTIFIER_DROP-1:0]};
        end

        assign cell_saturated[index] = saturated_4;
    end

    assign saturated = (cell_saturated != {CELLS{1'b0}});

    // ---- Sums, and whether they are within the level
    for (point = 0; point < POINTS; point = point + 1) begin : gen_trees
        wire signed [47:0] total;
        wire signed [47:0] total_left;
        wire signed [47:0] total_right;

        sptfra_tree #(
            .COUNT (CELLS),
            .WIDTH (48)
        ) tree (
            .clock   (clock),
            .numbers (sums[48*CELLS*point +: 48*CELLS]),
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
