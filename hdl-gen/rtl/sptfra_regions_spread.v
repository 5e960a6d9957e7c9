// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Gives each taxel to the nearest body, by steps from neighbour to neighbour, eight of them: one sweep in raster order,
// where each taxel looks at the four neighbours before it, and one back. Two cycles a taxel; of equal distances the
// lower number goes first.
//
// The taxels stand in a memory outside, each a word {none, distance, body}, in the first sweep the number of its body
// in the lowest bits. A slot of the walk reads there its own taxel, then the one that follows above it in the walk; the
// two before that one have been read in the slots before.
//
// From a slot to its taxel's word: 6 cycles; words come two cycles behind their addresses.

`default_nettype none

module sptfra_regions_spread #(
    parameter CONTACTS = 4,
    parameter TAXELS = 100,
    // Distances of neighbours
    parameter STEP_X = 2000,
    parameter STEP_Y = 2000,
    parameter STEP_DIAGONAL = 2828,
    // Bits of a distance, with room for a step
    parameter DISTANCE_BITS = 16,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire [CONTACTS*4-1:0] all_bodies, // numbers of those with a region
    // A sweep begins; which one it is, from the cycle after it on
    input  wire start,
    input  wire back, // at start
    input  wire numbers, // the first sweep
    // Slots of sptfra_regions_walk
    input  wire walks,
    input  wire second,
    input  wire border,
    input  wire first_row,
    input  wire last_row,
    input  wire before_border,
    input  wire ends_row,
    // Which taxel to read in the second cycle of a slot
    output reg  [TAXEL_WIDTH-1:0] ahead,
    input  wire [DISTANCE_BITS+3:0] word,
    // Taxels in the order of the walk
    output reg  there,
    output reg  [DISTANCE_BITS+3:0] nearest
);

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8)) begin : gen_check_contacts
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
        if ((STEP_DIAGONAL < STEP_X) || (STEP_DIAGONAL < STEP_Y)) begin : gen_check_steps
            sptfra_error_a_diagonal_is_the_longest_step invalid ();
        end
    endgenerate

    localparam WORD_BITS = DISTANCE_BITS + 4;
    localparam [WORD_BITS-1:0] NONE = {1'b1, {(WORD_BITS-1){1'b0}}};
    localparam [31:0] X = STEP_X;
    localparam [31:0] Y = STEP_Y;
    localparam [31:0] DIAGONAL = STEP_DIAGONAL;
    localparam [31:0] LAST_TAXEL = TAXELS - 1;

    function [WORD_BITS-1:0] nearer(input [WORD_BITS-1:0] first, input [WORD_BITS-1:0] other);
        nearer = (other < first) ? other : first;
    endfunction

    // ---- The taxel ahead: that of the next slot, a row above; behind a row the first one of it
    wire is_ahead = ends_row ? !last_row : (!border && !before_border && !first_row);
    reg backwards;

    always @(posedge clock) begin
        if (walks && second && is_ahead) begin
            ahead <= backwards ? ahead - 1'b1 : ahead + 1'b1;
        end
        if (start) begin
            ahead <= back ? LAST_TAXEL[TAXEL_WIDTH-1:0] : {TAXEL_WIDTH{1'b0}};
            backwards <= back;
        end
    end

    // ---- What the slots were, cycle by cycle
    reg [5:1] slots;
    reg [5:1] borders;
    reg [3:1] aheads;

    always @(posedge clock) begin
        slots <= {slots[4:1], walks && !second};
        borders <= {borders[4:1], border};
        aheads <= {aheads[2:1], is_ahead};
        if (reset) begin
            slots <= 5'd0;
        end
    end

    // ---- Cycle 2: its own word, in the first sweep that of its body
    wire [CONTACTS-1:0] is_body;
    wire [2:0] place;
    genvar index;

    generate
        for (index = 0; index < CONTACTS; index = index + 1) begin : gen_bodies
            assign is_body[index] = (word[3:0] == all_bodies[4*index +: 4]) && (word[3:0] != 4'd15);
        end
        if (CONTACTS == 8) begin : gen_eight
            assign place = {|is_body[7:4], |is_body[7:6] || |is_body[3:2],
                is_body[7] || is_body[5] || is_body[3] || is_body[1]};
        end else begin : gen_fewer
            wire [7:0] each = {{(8-CONTACTS){1'b0}}, is_body};

            assign place = {|each[7:4], |each[7:6] || |each[3:2], each[7] || each[5] || each[3] || each[1]};

            wire _unused_first = &{1'b0, each[0]};
        end
    endgenerate

    // ---- Cycle 2: of the neighbours above the nearer one of the two that are there. 3: the taxel's own, and the word
    // ahead. 4: that one. 5: the neighbour beside it. 6: the nearest
    reg [WORD_BITS-1:0] own_3;
    reg [WORD_BITS-1:0] above_3;
    reg [WORD_BITS-1:0] own_4;
    reg [WORD_BITS-1:0] own_5;
    reg [WORD_BITS-1:0] beside_5;
    reg [WORD_BITS-1:0] diagonal_next; // with the step from there: ahead,
    reg [WORD_BITS-1:0] straight; // in the slot before,
    reg [WORD_BITS-1:0] diagonal; // above,
    wire [WORD_BITS-1:0] word_ahead = aheads[3] ? word : NONE;
    wire [DISTANCE_BITS-1:0] distance_ahead = word_ahead[3 +: DISTANCE_BITS];
    wire [DISTANCE_BITS-1:0] distance = nearest[3 +: DISTANCE_BITS];
    wire [WORD_BITS-1:0] nearest_5 = nearer(own_5, beside_5);
    wire is_none = nearest_5[WORD_BITS-1] || borders[5];

    always @(posedge clock) begin
        above_3 <= nearer(diagonal, straight);
        own_3 <= !numbers ? word : ((is_body == {CONTACTS{1'b0}}) ? NONE : {{(WORD_BITS-3){1'b0}}, place});
        own_4 <= nearer(above_3, own_3);
        own_5 <= nearer(own_4, diagonal_next);
        beside_5 <= {nearest[WORD_BITS-1], distance + X[DISTANCE_BITS-1:0], nearest[2:0]};
        if (slots[3]) begin
            diagonal_next <= {word_ahead[WORD_BITS-1], distance_ahead + DIAGONAL[DISTANCE_BITS-1:0], word_ahead[2:0]};
            straight <= {word_ahead[WORD_BITS-1], distance_ahead + Y[DISTANCE_BITS-1:0], word_ahead[2:0]};
            diagonal <= diagonal_next;
        end
        if (slots[5]) begin
            nearest <= is_none ? NONE : nearest_5;
        end
        there <= slots[5] && !borders[5];
        if (start) begin
            diagonal_next <= NONE;
            straight <= NONE;
            diagonal <= NONE;
            nearest <= NONE;
        end
        if (reset) begin
            there <= 1'b0;
        end
    end

endmodule

`default_nettype wire
