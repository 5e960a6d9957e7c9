// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One cell of the walk over the grid of (mu_x, mu_y): up to CELL_ELEMENTS taxels, adders only.
//
// Fill: u0, u1, u2 of its taxels, also of the next frame while this one is walked. Walk: every taxel's stress at a
// point, 8 (u0 - dead zone + mu_x u1 + mu_y u2), of which the tension is summed, goes on to the next by one addition.
// Address to sum: 3 cycles, with u in block memories 4; one taxel a cycle, the same one again after 4 cycles at the
// earliest.

`default_nettype none

module sptfra_plane_cell #(
    // Places for taxels, a power of two
    parameter integer CELL_ELEMENTS = 4,
    // Bits of a taxel's place
    parameter integer ELEMENT_WIDTH = 2,
    // Taxels of this cell
    parameter integer COUNT = 4,
    // 1: u0, u1, u2 in block memories, which answer in the next cycle; 0: in LUTs
    parameter integer BLOCK = 0,
    // Bits of a sum
    parameter integer VALUE_BITS = 38
) (
    input  wire clock,
    input  wire reset,
    // Fill
    input  wire [2:0] fill, // one bit for each of u0, u1, u2
    input  wire fill_bank,
    input  wire [ELEMENT_WIDTH-1:0] fill_element,
    input  wire signed [26:0] fill_value,
    // Walk
    input  wire read,
    input  wire first, // of a sum
    input  wire bank,
    input  wire [ELEMENT_WIDTH-1:0] element,
    input  wire [2:0] step, // as in sptfra_plane
    input  wire [26:0] dead_zone, // 8 times
    output reg  [VALUE_BITS-1:0] sum
);

    // Width of a stress: 8 u0, and u1 and u2 up to 10 times
    localparam integer POINT_BITS = 32;
    localparam integer DEPTH = 2 << ELEMENT_WIDTH; // two frames
    localparam [2:0] START_X = 3'd0, START_Y = 3'd1, LEFT = 3'd3, UP = 3'd4;

    (* ram_style = "distributed" *) reg signed [POINT_BITS-1:0] points [0:CELL_ELEMENTS-1];

    // ---- u0, u1, u2 of a taxel, and what is asked of it with them
    wire [ELEMENT_WIDTH:0] address = {bank, element};
    wire [ELEMENT_WIDTH:0] fill_address = {fill_bank, fill_element};
    wire in_cell = ({1'b0, element} < COUNT[ELEMENT_WIDTH:0]);
    wire valid_0;
    wire first_0;
    wire [2:0] step_0;
    wire [ELEMENT_WIDTH-1:0] element_0;
    wire signed [26:0] u0_0;
    wire signed [26:0] u1_0;
    wire signed [26:0] u2_0;

    generate
        if (BLOCK != 0) begin : gen_block
            (* ram_style = "block" *) reg signed [26:0] memory_0 [0:DEPTH-1];
            (* ram_style = "block" *) reg signed [26:0] memory_1 [0:DEPTH-1];
            (* ram_style = "block" *) reg signed [26:0] memory_2 [0:DEPTH-1];
            (* keep = "true" *) reg valid;
            (* keep = "true" *) reg first_late;
            (* keep = "true" *) reg [2:0] step_late;
            (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_late;
            reg signed [26:0] u0;
            reg signed [26:0] u1;
            reg signed [26:0] u2;

            always @(posedge clock) begin
                valid <= read && in_cell && !reset;
                first_late <= first;
                step_late <= step;
                element_late <= element;
                u0 <= memory_0[address];
                u1 <= memory_1[address];
                u2 <= memory_2[address];
                if (fill[0]) begin
                    memory_0[fill_address] <= fill_value;
                end
                if (fill[1]) begin
                    memory_1[fill_address] <= fill_value;
                end
                if (fill[2]) begin
                    memory_2[fill_address] <= fill_value;
                end
            end

            assign {valid_0, first_0, step_0, element_0} = {valid, first_late, step_late, element_late};
            assign {u0_0, u1_0, u2_0} = {u0, u1, u2};
        end else begin : gen_luts
            (* ram_style = "distributed" *) reg signed [26:0] memory_0 [0:DEPTH-1];
            (* ram_style = "distributed" *) reg signed [26:0] memory_1 [0:DEPTH-1];
            (* ram_style = "distributed" *) reg signed [26:0] memory_2 [0:DEPTH-1];

            always @(posedge clock) begin
                if (fill[0]) begin
                    memory_0[fill_address] <= fill_value;
                end
                if (fill[1]) begin
                    memory_1[fill_address] <= fill_value;
                end
                if (fill[2]) begin
                    memory_2[fill_address] <= fill_value;
                end
            end

            assign {valid_0, first_0, step_0, element_0} = {read && in_cell, first, step, element};
            assign {u0_0, u1_0, u2_0} = {memory_0[address], memory_1[address], memory_2[address]};
        end
    endgenerate

    // ---- Stage 1: where the taxel stands, and what it goes on by. What is equal in all cells is kept, for each to
    // have its own at hand
    (* keep = "true" *) reg [3:1] valid;
    (* keep = "true" *) reg [2:1] firsts;
    (* keep = "true" *) reg [2:0] step_1;
    (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_1;
    (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_2;
    (* keep = "true" *) reg [ELEMENT_WIDTH-1:0] element_3;
    reg signed [POINT_BITS-1:0] stress_1;
    reg signed [26:0] u_1;

    always @(posedge clock) begin
        valid <= {valid[2:1], valid_0};
        firsts <= {firsts[1], first_0};
        step_1 <= step_0;
        element_1 <= element_0;
        element_2 <= element_1;
        element_3 <= element_2;
        stress_1 <= (step_0 == START_X) ? { {(POINT_BITS - 30){u0_0[26]}}, u0_0, 3'd0} : points[element_0];
        u_1 <= ((step_0 == START_Y) || (step_0 == UP)) ? u2_0 : u1_0;
        if (reset) begin
            valid <= 3'd0;
        end
    end

    // ---- Stage 2: a start is 10 steps back from the middle; the tension
    wire signed [POINT_BITS-1:0] u_wide = { {(POINT_BITS - 27){u_1[26]}}, u_1};
    wire signed [POINT_BITS-1:0] u_times_10 = (u_wide <<< 3) + (u_wide <<< 1);
    wire starting = (step_1 == START_X) || (step_1 == START_Y);
    wire [26:0] dead_zone_1 = (step_1 == START_X) ? dead_zone : 27'd0;
    reg signed [POINT_BITS-1:0] stress_2;
    reg signed [POINT_BITS-1:0] change_2;
    reg [POINT_BITS-2:0] tension_2;

    always @(posedge clock) begin
        stress_2 <= stress_1 - { {(POINT_BITS - 27){1'b0}}, dead_zone_1};
        change_2 <= starting ? -u_times_10 : (step_1 == LEFT) ? -u_wide : u_wide;
        tension_2 <= (valid[1] && !starting && !stress_1[POINT_BITS-1]) ? stress_1[POINT_BITS-2:0]
            : {(POINT_BITS - 1){1'b0}};
    end

    // ---- Stage 3: the next point; the sum
    reg signed [POINT_BITS-1:0] stress_3;

    always @(posedge clock) begin
        stress_3 <= stress_2 + change_2;
        sum <= (firsts[2] ? {VALUE_BITS{1'b0}} : sum) + { {(VALUE_BITS - POINT_BITS + 1){1'b0}}, tension_2};
        if (valid[3]) begin
            points[element_3] <= stress_3;
        end
    end

endmodule

`default_nettype wire
