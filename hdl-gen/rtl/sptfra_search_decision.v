// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts, in the search by eighths, how many points of a round come before the place that it closes in on.
//
// The sums of a pass, four points, are there CYCLES after its last taxel's address, and so is what is said of them. A
// point comes before the minimum if the slope of B falls there; before the left end of the level set if it is outside
// and before the lowest one; before the right end if it is inside, or not behind the lowest one.

`default_nettype none

module sptfra_search_decision #(
    // From the last taxel's address of a pass to its sums, three or more
    parameter integer CYCLES = 11,
    // Number of the round that cuts its interval into four parts only
    parameter [2:0] LAST_ROUND = 3'd5
) (
    input  wire clock,
    input  wire reset,
    // A pass, while its last taxels are read
    input  wire pass_ends,
    input  wire second, // of its round: points 5 to 8
    input  wire right_end, // of the level set, rather than the left one, or the minimum
    // While its sums are there
    input  wire slope, // of B, rather than B
    input  wire [2:0] left_round,
    input  wire [2:0] right_round,
    input  wire [2:0] left_room, // points up to the lowest one
    input  wire [2:0] right_room,
    input  wire [3:0] falls,
    input  wire [3:0] fits_level,
    output reg  over, // one cycle
    output reg  over_second,
    output reg  over_right,
    output wire over_last, // it is one of the last round
    output wire [3:0] count // of both passes, with the second one
);

    reg [CYCLES-1:1] ends; // index k: k cycles after the last taxel's address
    reg [CYCLES-1:1] seconds;
    reg [CYCLES-1:1] right_ends;
    reg [2:0] first_count;

    // Of the last round's points three are between its ends, and of any other's seven
    wire [3:0] between = over_second ? (over_last ? 4'b0000 : 4'b0111) : (over_last ? 4'b0111 : 4'b1111);
    wire [2:0] room = over_right ? right_room : left_room;
    wire [6:0] near = ~(7'b1111111 << room);
    wire [3:0] near_pass = over_second ? {1'b0, near[6:4]} : near[3:0];
    wire [3:0] before_end = over_right ? (fits_level | near_pass) : (~fits_level & near_pass);
    wire [3:0] passed = between & (slope ? falls : before_end);
    wire [2:0] pass_count = {2'd0, passed[0]} + {2'd0, passed[1]} + {2'd0, passed[2]} + {2'd0, passed[3]};

    assign over_last = ((over_right ? right_round : left_round) == LAST_ROUND);
    assign count = {1'b0, first_count} + {1'b0, pass_count};

    always @(posedge clock) begin
        ends <= {ends[CYCLES-2:1], pass_ends};
        seconds <= {seconds[CYCLES-2:1], second};
        right_ends <= {right_ends[CYCLES-2:1], right_end};
        over <= ends[CYCLES-1];
        over_second <= seconds[CYCLES-1];
        over_right <= right_ends[CYCLES-1];
        if (over && !over_second) begin
            first_count <= pass_count;
        end
        if (reset) begin
            ends <= {(CYCLES - 1){1'b0}};
            over <= 1'b0;
        end
    end

endmodule

`default_nettype wire
