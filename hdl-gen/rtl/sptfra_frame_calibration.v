// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What a frame keeps of the bank that acted at its first beat: the threshold that says whether there is contact, the
// noise floor that says whether a taxel presses or pulls, the bank's generation, which goes out in bits 15:8 of the
// frame's word 13, and how many taxels it replaces: bits 23:16 of that word, and bit 8 of the status, of frames that
// are answered.
//
// CeAn's stresses are looked at as they pass; what they say is kept until CeAn's result is taken, which follows the
// last one by four cycles at least. Flags and words pass in the same cycle. Sixteen frames may be inside; they leave in
// their order.

`default_nettype none

module sptfra_frame_calibration #(
    // 32-bit words of a beat out: 1, 2 or 4
    parameter WORDS = 1,
    // 1: the sensor reads what pulls, so that a frame in which nothing does is to be told
    parameter TENSION_READ = 1
) (
    input  wire clock,
    input  wire reset,
    // A frame begins, and what acts then
    input  wire begins,
    input  wire [31:0] contact, // least sum |b|, in steps of the stress
    input  wire [26:0] noise, // steps of the stress of a taxel that are noise
    input  wire [7:0] generation,
    input  wire [3:0] replaced, // taxels
    // CeAn's stresses, frame by frame
    input  wire stress_valid,
    input  wire signed [26:0] stress,
    input  wire frame_done, // with the last one or after it
    // CeAn's result, in the frames' order
    input  wire direction_take,
    input  wire [39:0] stress_sum,
    input  wire [5:0] flags_in,
    output wire [5:0] flags, // no tension and no contact by the frame's own thresholds
    output wire no_direction, // nothing pushes, or nothing pulls
    // Answers
    input  wire word_taken,
    input  wire word_last,
    input  wire [32*WORDS-1:0] words_in,
    output wire [32*WORDS-1:0] words
);

    localparam COUNTERS = 13; // the word with the generation
    localparam COUNTERS_BEAT = COUNTERS / WORDS;
    localparam COUNTERS_PLACE = COUNTERS % WORDS;
    localparam [3:0] HERE = COUNTERS_BEAT;

    reg [31:0] contacts [0:15];
    reg [26:0] noises [0:15];
    reg [1:0] seen [0:15]; // above the noise: presses, pulls
    reg [7:0] generations [0:15];
    reg [3:0] replaces [0:15];
    reg [3:0] newest;
    reg [3:0] next_noise;
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
    wire [32*WORDS-1:0] counters = {{(32*WORDS-12){1'b0}}, counted, oldest_generation};
    wire [32*WORDS-1:0] status = {{(32*WORDS-9){1'b0}}, !blank && (oldest_replaces != 4'd0), 8'd0};
    wire [32*WORDS-1:0] more = (beat == HERE) ? counters << (32 * COUNTERS_PLACE + 8)
        : (beat == 4'd0) ? status : {32*WORDS{1'b0}};

    wire [1:0] of_frame = seen[next_contact];

    assign flags = {
        (TENSION_READ != 0) && !of_frame[0],
        flags_in[4],
        stress_sum < {8'd0, contacts[next_contact]},
        flags_in[2:0]
    };
    assign no_direction = (of_frame != 2'b11);
    assign words = words_in | more;

    // ---- The stresses of a frame against its noise floor: compared, then gathered
    reg signed [26:0] floor;
    reg [1:0] above; // a stress: presses, pulls
    reg [1:0] gathered;
    reg done;

    always @(posedge clock) begin
        floor <= noises[next_noise];
        above <= {stress < -floor, stress > floor} & {2{stress_valid}};
        gathered <= done ? 2'b00 : gathered | above;
        done <= frame_done;
        if (done) begin
            seen[next_noise] <= gathered | above;
            next_noise <= next_noise + 4'd1;
        end
        if (reset) begin
            above <= 2'b00;
            gathered <= 2'b00;
            done <= 1'b0;
            next_noise <= 4'd0;
        end
    end

    always @(posedge clock) begin
        if (begins) begin
            contacts[newest] <= contact;
            noises[newest] <= noise;
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
        end else if ((leaves && (held == 5'd0)) || (begins && (held == 5'd16))
            || (frame_done && (newest == next_noise))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $finish;
        end
    end
`endif

    wire _unused = &{1'b0, flags_in[5], flags_in[3]};

endmodule

`default_nettype wire
