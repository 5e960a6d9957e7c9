// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Walks the (mu_x, mu_y) plane: B = sum max(0, u0 + mu_x u1 + mu_y u2) at 21 x 21 points, 1/8 apart.
//
// B is Condition 1 (Eq. 20), convex in both components. The walk goes there and back in alternate rows and needs
// additions only. CELLS cells with up to CELL_ELEMENTS taxels each work side by side; a value every CELL_ELEMENTS
// cycles, the first one after three times as many, 3, or 4 where the cells have block memories, and the levels of the
// adder tree.

`default_nettype none

module sptfra_plane #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of a quad
    parameter integer ROW_WIDTH = 5,
    // Cells, as many for each member of a quad
    parameter integer CELLS = 28,
    // Taxels of a cell, a power of two, at least 4
    parameter integer CELL_ELEMENTS = 4,
    // Right shift that turns max |b| into 8 times the dead zone
    parameter integer SHARE_SHIFT = 5,
    // Bits of a value
    parameter integer VALUE_BITS = 38,
    // From start to the first value, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // u_q of a quad's taxels, member 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_quad,
    input  wire [4*DATA_BITS-1:0] u_values,
    input  wire fill_bank, // of the cells' memories
    input  wire search_bank,
    // Start, with this held from the next cycle on
    input  wire start,
    input  wire [26:0] largest, // max |b|
    // B at the points, in the order of the walk, in eighths of the step of u
    output wire value_valid,
    output wire [VALUE_BITS-1:0] value
);

    localparam integer QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2);
    localparam integer GROUPS = CELLS / 4;
    localparam integer LAST_COUNT = QUADS - (GROUPS - 1) * CELL_ELEMENTS;
    localparam integer ELEMENT_WIDTH = $clog2(CELL_ELEMENTS);
    localparam integer LAST_ELEMENT = CELL_ELEMENTS - 1;
    // Cells of so many taxels keep them in block memories
    localparam integer BLOCK_ELEMENTS = 32;
    localparam integer BLOCK = (CELL_ELEMENTS >= BLOCK_ELEMENTS) ? 1 : 0;
    localparam integer TOTAL_DEPTH = 3 + BLOCK + $clog2(CELLS);
    localparam [4:0] LAST = 5'd20; // point of a row, and row

    // What a taxel goes on by: to the start along x and y, to the next point
    localparam [2:0] START_X = 3'd0, START_Y = 3'd1, RIGHT = 3'd2, LEFT = 3'd3, UP = 3'd4;

    generate
        if (CELL_ELEMENTS < 4) begin : gen_check_elements
            sptfra_error_a_taxel_comes_again_after_4_cycles invalid ();
        end
        if ((CELLS % 4 != 0) || (LAST_COUNT < 1) || (LAST_COUNT > CELL_ELEMENTS)) begin : gen_check_cells
            sptfra_error_cells_do_not_hold_the_taxels invalid ();
        end
    endgenerate

    // ---- Walk
    reg reading;
    reg [ELEMENT_WIDTH-1:0] element;
    reg [1:0] starts; // both starts are over: 2
    reg [4:0] along;
    reg [4:0] row;
    wire last_element = (element == LAST_ELEMENT[ELEMENT_WIDTH-1:0]);
    wire walk_end = reading && last_element && (along == LAST) && (row == LAST);
    reg [2:0] walk_step;

    always @(*) begin
        case (starts)
            2'd0: walk_step = START_X;
            2'd1: walk_step = START_Y;
            default: walk_step = (along == LAST) ? UP : row[0] ? LEFT : RIGHT;
        endcase
    end

    always @(posedge clock) begin
        if (reading) begin
            element <= last_element ? {ELEMENT_WIDTH{1'b0}} : element + 1'b1;
            if (last_element && !starts[1]) begin
                starts <= starts + 2'd1;
            end
            if (last_element && starts[1]) begin
                along <= (along == LAST) ? 5'd0 : along + 5'd1;
                row <= (along == LAST) ? row + 5'd1 : row;
            end
        end
        if (walk_end) begin
            reading <= 1'b0;
        end
        if (start) begin
            reading <= 1'b1;
            element <= {ELEMENT_WIDTH{1'b0}};
            starts <= 2'd0;
            along <= 5'd0;
            row <= 5'd0;
        end
        if (reset) begin
            reading <= 1'b0;
        end
    end

    // ---- Cells: four take the members of the same quads
    wire [VALUE_BITS*CELLS-1:0] sums;
    wire [31:0] u_group = { {(32 - ROW_WIDTH){1'b0}}, u_quad} / CELL_ELEMENTS;
    wire [3:0] counts;
    reg [26:0] dead_zone;

    sptfra_members #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .ROW_WIDTH (ROW_WIDTH)
    ) members (
        .quad   (u_quad),
        .counts (counts)
    );

    genvar index;
    generate
        for (index = 0; index < CELLS; index = index + 1) begin : gen_cells
            wire signed [DATA_BITS-1:0] u_member = u_values[DATA_BITS*(index % 4) +: DATA_BITS];
            wire signed [26:0] u_wide = { {(28 - DATA_BITS){u_member[DATA_BITS-1]}}, u_member[DATA_BITS-2:0]};

            sptfra_plane_cell #(
                .CELL_ELEMENTS (CELL_ELEMENTS),
                .ELEMENT_WIDTH (ELEMENT_WIDTH),
                .COUNT         ((index / 4 == GROUPS - 1) ? LAST_COUNT : CELL_ELEMENTS),
                .BLOCK         (BLOCK),
                .VALUE_BITS    (VALUE_BITS)
            ) hinges (
                .clock        (clock),
                .reset        (reset),
                .fill         (u_valid & {3{u_group == index / 4}}),
                .fill_bank    (fill_bank),
                .fill_element (u_quad[ELEMENT_WIDTH-1:0]),
                .fill_value   (counts[index % 4] ? u_wide : 27'sd0),
                .read         (reading),
                .first        (element == {ELEMENT_WIDTH{1'b0}}),
                .bank         (search_bank),
                .element      (element),
                .step         (walk_step),
                .dead_zone    (dead_zone),
                .sum          (sums[VALUE_BITS*index +: VALUE_BITS])
            );
        end
    endgenerate

    // ---- Their sum
    wire [VALUE_BITS-1:0] value_left;
    wire [VALUE_BITS-1:0] value_right;
    reg [TOTAL_DEPTH:1] ends; // of a point; index k: k cycles after its last taxel's address

    sptfra_adder_tree #(
        .COUNT (CELLS),
        .WIDTH (VALUE_BITS)
    ) tree (
        .clock (clock),
        .terms (sums),
        .left  (value_left),
        .right (value_right),
        .sum   (value)
    );

    assign value_valid = ends[TOTAL_DEPTH];

    always @(posedge clock) begin
        dead_zone <= largest >> SHARE_SHIFT;
        ends <= {ends[TOTAL_DEPTH-1:1], reading && last_element && starts[1]};
        if (reset) begin
            ends <= {TOTAL_DEPTH{1'b0}};
        end
    end

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (value_valid)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

    wire _unused = &{1'b0, value_left, value_right};

endmodule

`default_nettype wire
