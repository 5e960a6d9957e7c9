// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Distance that a bisection finds, highest bit first, one bit a round, or two with three points.
//
// A bit is kept where `keep` is high and the distance with it is less than `room`. A round has up to three points:
// with its bit (middle), with the next bit too (above), with the next bit alone (below).
//
// Latency from over to distance: 1 cycle. Interval: a round, of two cycles or more.

`default_nettype none

module sptfra_search_distance #(
    // Bits of a distance
    parameter integer BITS = 17,
    // Points of a round: 1, or 3
    parameter integer POINTS = 1
) (
    input  wire clock,
    input  wire restart, // from 0, with the highest bit
    input  wire over, // a round's answers are there
    input  wire [2:0] keep, // above, middle, below
    input  wire unbounded, // whatever the room
    input  wire [BITS:0] room,
    output reg  [BITS-1:0] distance, // 0 below the bits that are found
    output wire last, // the round finds the lowest bit
    output wire [BITS-1:0] half, // weight of the second bit of a round, 0 without
    output wire [BITS-1:0] below,
    output wire [BITS-1:0] above
);

    localparam [BITS-1:0] NONE = 0;
    localparam integer ROUND_BITS = (POINTS == 3) ? 2 : 1;

    reg [BITS-1:0] unit; // weight of the bit that is bisected
    wire [BITS-1:0] middle = distance | unit;
    assign last = unit[0];
    assign half = (POINTS == 3) ? unit >> 1 : NONE;
    assign below = distance | ((half == NONE) ? unit : half);
    assign above = middle | half;

    reg [2:0] fits; // above, middle, below
    wire [2:0] kept = keep & (fits | {3{unbounded}});

    always @(posedge clock) begin
        fits <= { {1'b0, above} < room, {1'b0, middle} < room, {1'b0, below} < room};
        if (restart) begin
            distance <= NONE;
            unit <= {1'b1, NONE[BITS-2:0]};
        end else if (over) begin
            distance <= distance | (kept[1] ? unit : NONE) | ((kept[1] ? kept[2] : kept[0]) ? half : NONE);
            unit <= unit >> ROUND_BITS;
        end
    end

endmodule

`default_nettype wire
