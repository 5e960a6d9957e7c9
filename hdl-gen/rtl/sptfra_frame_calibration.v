// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What a frame keeps of the bank that acted at its first beat: the threshold that says whether there is contact, the
// bank's generation, which goes out in bits 15:8 of the frame's word 13, and how many taxels it replaces: bits 23:16 of
// that word, and bit 8 of the status, of frames that are answered.
//
// Flags and words pass in the same cycle. Sixteen frames may be inside; they leave in their order.

`default_nettype none

module sptfra_frame_calibration #(
    // 32-bit words of a beat out: 1, 2 or 4
    parameter WORDS = 1
) (
    input  wire clock,
    input  wire reset,
    // A frame begins, and what acts then
    input  wire begins,
    input  wire [31:0] contact, // least sum |b|, in steps of the stress
    input  wire [7:0] generation,
    input  wire [3:0] replaced, // taxels
    // CeAn's result, in the frames' order
    input  wire direction_take,
    input  wire [39:0] stress_sum,
    input  wire [5:0] flags_in,
    output wire [5:0] flags, // no contact by the frame's own threshold
    // Answers
    input  wire word_taken,
    input  wire word_last,
    input  wire [32*WORDS-1:0] words_in,
    output wire [32*WORDS-1:0] words
);

    localparam CENSUS = 13; // the word with the generation
    localparam CENSUS_BEAT = CENSUS / WORDS;
    localparam CENSUS_PLACE = CENSUS % WORDS;
    localparam [3:0] HERE = CENSUS_BEAT;

    reg [31:0] contacts [0:15];
    reg [7:0] generations [0:15];
    reg [3:0] replaces [0:15];
    reg [3:0] newest;
    reg [3:0] next_contact;
    reg [3:0] oldest;
    reg [3:0] beat; // of the answer going out, stops behind the one with the generation
    wire leaves = word_taken && word_last;
    wire [7:0] oldest_generation = generations[oldest];
    wire [3:0] oldest_replaces = replaces[oldest];
    // Of the first beat: no contact, NaN or infinity, bad length
    wire blank = words_in[0] || words_in[4] || words_in[5];
    reg blank_held;
    wire [3:0] counted = blank_held ? 4'd0 : oldest_replaces;
    wire [32*WORDS-1:0] census = {{(32*WORDS-12){1'b0}}, counted, oldest_generation};
    wire [32*WORDS-1:0] status = {{(32*WORDS-9){1'b0}}, !blank && (oldest_replaces != 4'd0), 8'd0};
    wire [32*WORDS-1:0] more = (beat == HERE) ? census << (32 * CENSUS_PLACE + 8)
        : (beat == 4'd0) ? status : {32*WORDS{1'b0}};

    assign flags = {flags_in[5:4], stress_sum < {8'd0, contacts[next_contact]}, flags_in[2:0]};
    assign words = words_in | more;

    always @(posedge clock) begin
        if (begins) begin
            contacts[newest] <= contact;
            generations[newest] <= generation;
            replaces[newest] <= replaced;
            newest <= newest + 4'd1;
        end
        if (direction_take) begin
            next_contact <= next_contact + 4'd1;
        end
        if (word_taken) begin
            beat <= word_last ? 4'd0 : (beat != 4'd15) ? beat + 4'd1 : beat;
            blank_held <= (beat == 4'd0) ? blank : blank_held;
        end
        if (leaves) begin
            oldest <= oldest + 4'd1;
        end
        if (reset) begin
            newest <= 4'd0;
            next_contact <= 4'd0;
            oldest <= 4'd0;
            beat <= 4'd0;
        end
    end

`ifdef SIMULATION
    // A frame leaves after it has come, and no more are inside than there is room for
    reg [4:0] held;

    always @(posedge clock) begin
        held <= held + {4'd0, begins} - {4'd0, leaves};
        if (reset) begin
            held <= 5'd0;
        end else if ((leaves && (held == 5'd0)) || (begins && (held == 5'd16))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $finish;
        end
    end
`endif

    wire _unused = &{1'b0, flags_in[3]};

endmodule

`default_nettype wire
