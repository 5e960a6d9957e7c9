// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What becomes of a frame's own range (sptfra_range) behind the lanes: sum and largest of its stresses are scaled for
// the estimator, as those in the lanes are; forces, torques and the standard error are scaled back as they leave, by
// their exponents, those below the smallest normal number becoming zeros. CeAn and its thresholds see stresses as they
// were.
//
// Everything passes in the same cycle. Sixteen frames may be inside; they leave in their order.

`default_nettype none

module sptfra_range_frames #(
    // 32-bit words of a beat out: 1, 2 or 4
    parameter WORDS = 1
) (
    input  wire clock,
    input  wire reset,
    // A frame's power of two, before CeAn's result of it is taken
    input  wire scaled,
    input  wire [4:0] exponent,
    // CeAn's result, in the frames' order
    input  wire direction_take,
    input  wire [39:0] stress_sum_in,
    input  wire [26:0] largest_in,
    output wire [39:0] stress_sum,
    output wire [26:0] largest,
    // Answers
    input  wire word_taken,
    input  wire word_last,
    input  wire [32*WORDS-1:0] words_in,
    output wire [32*WORDS-1:0] words
);

    localparam [4:0] SUMMARY_BEATS = 16 / WORDS;
    localparam WORD_WIDTH = $clog2(WORDS);
    // Words of the summary that are in newtons or newton metres: forces, torques, standard error
    localparam [15:0] FORCES = 16'b0001_0000_1111_1100;

    reg [4:0] exponents [0:15];
    reg [3:0] newest;
    reg [3:0] next_direction;
    reg [3:0] oldest;
    reg [4:0] beat; // of the answer going out, stops behind the summary
    wire leaves = word_taken && word_last;
    wire in_summary = (beat < SUMMARY_BEATS);
    wire [4:0] of_direction = exponents[next_direction];
    wire [4:0] of_words = exponents[oldest];

    assign stress_sum = stress_sum_in << of_direction;
    assign largest = largest_in << of_direction;

    always @(posedge clock) begin
        if (scaled) begin
            exponents[newest] <= exponent;
            newest <= newest + 4'd1;
        end
        if (direction_take) begin
            next_direction <= next_direction + 4'd1;
        end
        if (word_taken) begin
            beat <= word_last ? 5'd0 : in_summary ? beat + 5'd1 : beat;
        end
        if (leaves) begin
            oldest <= oldest + 4'd1;
        end
        if (reset) begin
            newest <= 4'd0;
            next_direction <= 4'd0;
            oldest <= 4'd0;
            beat <= 5'd0;
        end
    end

    genvar place;

    generate
        for (place = 0; place < WORDS; place = place + 1) begin : gen_words
            localparam [31:0] PLACE = place;
            wire [31:0] number = ({27'd0, beat} << WORD_WIDTH) | PLACE; // of the word, in the summary
            wire is_force = !in_summary || FORCES[number[3:0]];
            wire [31:0] word = words_in[32*place +: 32];
            wire [7:0] power = word[30:23];
            wire [7:0] lower = power - {3'd0, of_words};
            wire vanishes = (power <= {3'd0, of_words});

            assign words[32*place +: 32] = !is_force ? word : {word[31], vanishes ? 31'd0 : {lower, word[22:0]}};

            wire _unused_number = &{1'b0, number};
        end
    endgenerate

`ifdef SIMULATION
    // A frame leaves after it has come, and no more are inside than there is room for
    reg [4:0] held;

    always @(posedge clock) begin
        held <= held + {4'd0, scaled} - {4'd0, leaves};
        if (reset) begin
            held <= 5'd0;
        end else if ((leaves && (held == 5'd0)) || (scaled && (held == 5'd16))
            || (direction_take && (newest == next_direction))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $finish;
        end
    end
`endif

endmodule

`default_nettype wire
