// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Piecewise-linear curve: finds the segment of a number, comparison by comparison, and interpolates on its line.
//
// Number to value: LEVELS + 7 cycles, one a cycle. A number beyond the ends of the curve has the value of the end. The
// curve holds while numbers are under way.

`default_nettype none

module sptfra_curve #(
    // Comparisons: the curve has up to 2^LEVELS segments
    parameter LEVELS = 4
) (
    input  wire clock,
    // Counts
    input  wire signed [26:0] number,
    input  wire number_saturated,
    input  wire number_not_finite,
    // What they are worth
    output reg  signed [26:0] value,
    output wire saturated,
    output wire not_finite,
    // Curve: first number of each segment, 27 bits each, the count of segments, the end of the last one
    input  wire [27*(1<<LEVELS)-1:0] knots,
    input  wire [6:0] count,
    input  wire signed [26:0] last,
    // Memory of lines: first number, value there, slope, bits dropped less one, an enabled cycle after the segment
    output wire [LEVELS-1:0] segment,
    input  wire [77:0] line_1
);

    localparam STAGES = LEVELS + 7;

    // ---- The segment: bit by bit of its number, the highest first
    wire [27*(LEVELS+1)-1:0] numbers;
    wire [LEVELS*(LEVELS+1)-1:0] segments;
    wire signed [26:0] first = $signed(knots[26:0]);
    reg signed [26:0] number_in;
    genvar level;

    assign numbers[26:0] = number_in;
    assign segments[LEVELS-1:0] = {LEVELS{1'b0}};

    always @(posedge clock) begin
        number_in <= (number < first) ? first : (number > last) ? last : number;
    end

    for (level = 0; level < LEVELS; level = level + 1) begin : gen_levels
        localparam [LEVELS-1:0] BIT = 1 << (LEVELS - 1 - level);
        reg signed [26:0] held_number;
        reg [LEVELS-1:0] held_segment;
        wire signed [26:0] here = $signed(numbers[27*level +: 27]);
        wire [LEVELS-1:0] lower = segments[LEVELS*level +: LEVELS];
        wire [LEVELS-1:0] upper = lower | BIT;
        wire signed [26:0] knot = $signed(knots[27*upper +: 27]);

        assign numbers[27*(level+1) +: 27] = held_number;
        assign segments[LEVELS*(level+1) +: LEVELS] = held_segment;

        always @(posedge clock) begin
            held_number <= here;
            held_segment <= (({{(7-LEVELS){1'b0}}, upper} < count) && (here >= knot)) ? upper : lower;
        end
    end

    // ---- Its line: names end in the cycles since the segment is known
    wire signed [26:0] from_1;
    wire signed [26:0] value_1;
    wire signed [17:0] slope_1;
    wire [5:0] shift_1;

    assign segment = segments[LEVELS*LEVELS +: LEVELS];
    assign {from_1, value_1, slope_1, shift_1} = line_1;

    reg signed [26:0] number_1;
    reg signed [26:0] along_2;
    reg signed [17:0] slope_2;
    reg signed [26:0] value_2;
    reg signed [26:0] value_3;
    reg signed [26:0] value_4;
    reg signed [26:0] value_5;
    reg [5:0] shift_2;
    reg [5:0] shift_3;
    reg [5:0] shift_4;
    wire signed [44:0] product_3;
    reg signed [44:0] product_4;
    reg signed [44:0] rise_5; // twice what it is, to be rounded
    wire signed [44:0] rise_half = rise_5 + 45'sd1;

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient (slope_2),
        .data        (along_2),
        .product     (product_3)
    );

    always @(posedge clock) begin
        number_1 <= $signed(numbers[27*LEVELS +: 27]);
        along_2 <= number_1 - from_1;
        slope_2 <= slope_1;
        shift_2 <= shift_1;
        value_2 <= value_1;
        shift_3 <= shift_2;
        value_3 <= value_2;
        product_4 <= product_3;
        shift_4 <= shift_3;
        value_4 <= value_3;
        rise_5 <= product_4 >>> shift_4;
        value_5 <= value_4;
        value <= value_5 + rise_half[27:1];
    end

    // ---- Beside it
    reg [STAGES:1] saturated_to;
    reg [STAGES:1] not_finite_to;

    assign saturated = saturated_to[STAGES];
    assign not_finite = not_finite_to[STAGES];

    always @(posedge clock) begin
        saturated_to <= {saturated_to[STAGES-1:1], number_saturated};
        not_finite_to <= {not_finite_to[STAGES-1:1], number_not_finite};
    end

    wire _unused = &{1'b0, rise_half[44:28], rise_half[0]};

endmodule

`default_nettype wire
