// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A place on the line that the search by eighths closes in on: the minimum, or an end of the level set.
//
// Places are counted from -1 in steps of 2^-16. The wanted one is less than an interval further; each round cuts it
// into eight parts, the last one into four, and is told how many of the points between come before the wanted place.
// What a round's passes and decisions need of it is there two cycles after the round before.

`default_nettype none

module sptfra_search_place #(
    // 1: of the points between, room is for those before the lowest one, 0: for the lowest one, too
    parameter integer BEFORE = 1
) (
    input  wire clock,
    input  wire restart, // from -1
    input  wire advance, // a round is over
    input  wire [3:0] count, // of its points that come before
    input  wire [17:0] lowest, // the place of the least B
    output reg  [16:0] place,
    output reg  [2:0] round,
    output reg  signed [17:0] first, // t of the last point of a round's first pass, the fourth
    output reg  signed [17:0] second, // and of its second pass, the eighth
    output reg  [2:0] room // points of the round up to the lowest one
);

    localparam [17:0] ONE = 18'd65536;
    localparam [0:0] LESS = (BEFORE != 0);

    // So many parts of a round
    function [17:0] parts(input [2:0] of, input [3:0] number);
        case (of)
            3'd0: parts = {number, 14'd0};
            3'd1: parts = {3'd0, number, 11'd0};
            3'd2: parts = {6'd0, number, 8'd0};
            3'd3: parts = {9'd0, number, 5'd0};
            3'd4: parts = {12'd0, number, 2'd0};
            default: parts = {14'd0, number};
        endcase
    endfunction

    wire [17:0] passed = parts(round, count);
    reg [18:0] gap; // to the lowest one
    reg [17:0] gap_parts;

    always @(*) begin
        case (round)
            3'd0: gap_parts = {14'd0, gap[17:14]};
            3'd1: gap_parts = {11'd0, gap[17:11]};
            3'd2: gap_parts = {8'd0, gap[17:8]};
            3'd3: gap_parts = {5'd0, gap[17:5]};
            3'd4: gap_parts = {2'd0, gap[17:2]};
            default: gap_parts = gap[17:0];
        endcase
    end

    always @(posedge clock) begin
        first <= {1'b0, place} + parts(round, 4'd4) - ONE;
        second <= {1'b0, place} + parts(round, 4'd8) - ONE;
        gap <= {1'b0, lowest} - {2'd0, place} - {18'd0, LESS};
        room <= gap[18] ? 3'd0 : (gap_parts > 18'd7) ? 3'd7 : gap_parts[2:0];
        if (advance) begin
            place <= place + passed[16:0];
            round <= round + 3'd1;
        end
        if (restart) begin
            place <= 17'd0;
            round <= 3'd0;
        end
    end

    wire _unused = &{1'b0, passed[17]};

endmodule

`default_nettype wire
