// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Exponential moving average of each taxel over frames, with the weight 2^-rate; a large step of any taxel restarts it.
//
// Latency: 4 cycles from a beat to its stresses and their new averages. `decided` rises one cycle after `out_ends`,
// later by the logarithm of the samples. From then on `averaged` says whether the frame is averaged, or restarts the
// average. Averages are double-buffered: a frame writes the spare bank, and a good frame swaps the banks.
//
// Two cycles later comes the variance of the noise left: v is 1 at first, then (1 - w)^2 v + w^2 with the weight w.

`default_nettype none

module sptfra_smoothing #(
    // Taxels of a frame, and of a beat: 1, 2, 4 or 8. What fills the last one is zero
    parameter TAXELS = 100,
    parameter SAMPLES = 1,
    // A step beyond FACTOR / 2^FRACTION of the frame's largest stress restarts the average
    parameter FRACTION = 21,
    parameter [16:0] FACTOR = 17'd62915,
    // Of this stress in place of the frame's largest, unless it is 0
    parameter [26:0] LARGEST = 27'd0,
    // Derived
    parameter FLAGS = 2 * SAMPLES + 1
) (
    input  wire clock,
    input  wire reset,
    input  wire opens, // a frame begins to come in
    input  wire [3:0] rate, // of frames that begin from now on, 8 at most
    // Beats of stresses
    input  wire in_takes, // it is of the frame
    input  wire in_ends, // the frame ends, with its last beat or behind it
    input  wire in_bad_length,
    input  wire [27*SAMPLES-1:0] in_stresses,
    input  wire [FLAGS-1:0] in_flags, // samples that are clipped, that are no numbers; in a dead taxel's place
    output reg  busy, // from the last beat in to the last one out
    // The same, each with its averages
    output wire out_takes,
    output wire out_ends,
    output reg  out_bad_length,
    output wire [27*SAMPLES-1:0] out_stresses,
    output wire [27*SAMPLES-1:0] out_averages,
    output wire [FLAGS-1:0] out_flags,
    // Which of them the frame is made of
    output reg  decided, // until over
    output reg  averaged,
    input  wire over, // all is made of the frame
    // For each frame, one cycle
    output wire known,
    output reg  [24:0] variance // of the noise left, over that of a frame, 24 fraction bits
);

    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam PLACE_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    localparam LEVELS = $clog2(SAMPLES); // of the trees that find the largest stress and step
    localparam SETTLES = 4 + LEVELS;

    // ---- Of the frame
    reg [3:0] rate_held;
    reg [PLACE_WIDTH-1:0] place; // of the beat that comes
    reg bank; // of the current average
    reg holds; // a first frame has been averaged
    reg bank_averaged; // the bank's frame was made of averages
    reg is_bad; // so far
    reg [SETTLES:1] takes;
    reg [SETTLES:1] ends;
    reg [4*FLAGS-1:0] flags; // of stages 1 to 4
    reg [4*PLACE_WIDTH-1:0] places;
    wire [63*SAMPLES-1:0] kept_1; // stress and average
    wire [63*SAMPLES-1:0] kept_4;

    assign out_takes = takes[4];
    assign out_ends = ends[4];
    assign out_flags = flags[4*FLAGS-1 -: FLAGS];

    sptfra_ram #(
        .WIDTH         (63 * SAMPLES),
        .DEPTH         (2 << PLACE_WIDTH),
        .ADDRESS_WIDTH (PLACE_WIDTH + 1)
    ) averages (
        .clock         (clock),
        .write_enable  (takes[4]),
        .write_address ({!bank, places[4*PLACE_WIDTH-1 -: PLACE_WIDTH]}),
        .write_data    (kept_4),
        .read_enable   (1'b1),
        .read_address  ({bank, place}),
        .read_data     (kept_1)
    );

    // ---- Samples
    wire [27*SAMPLES-1:0] magnitudes_1;
    wire [27*SAMPLES-1:0] steps_3;
    genvar sample;

    for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_samples
        // Stage 1: what the average was, with nine bits more and half a step of the stress: cut, it is rounded
        wire [62:0] word_1 = kept_1[63*sample +: 63];
        reg [26:0] stress_1;
        wire signed [36:0] old_1 = bank_averaged ? $signed({word_1[35], word_1[35:0]})
            : $signed({word_1[62], word_1[62:36], 9'h100});
        // Stages 2 to 4: what it becomes
        reg [26:0] stress_2;
        reg [26:0] stress_3;
        reg [26:0] stress_4;
        reg signed [36:0] old_2;
        reg signed [36:0] old_3;
        reg signed [36:0] step_2;
        reg [26:0] whole_3;
        reg signed [37:0] twice_3;
        reg signed [35:0] average_4;
        wire signed [37:0] rounded_3 = twice_3 + 38'sd1;
        wire signed [36:0] sum_3 = old_3 + rounded_3[37:1];

        assign magnitudes_1[27*sample +: 27] = stress_1[26] ? -stress_1 : stress_1;
        assign steps_3[27*sample +: 27] = whole_3;
        assign kept_4[63*sample +: 63] = {stress_4, average_4};
        assign out_stresses[27*sample +: 27] = stress_4;
        assign out_averages[27*sample +: 27] = average_4[35:9];

        always @(posedge clock) begin
            stress_1 <= in_stresses[27*sample +: 27];
            stress_2 <= stress_1;
            old_2 <= old_1;
            step_2 <= $signed({stress_1[26], stress_1, 9'h100}) - old_1;
            stress_3 <= stress_2;
            old_3 <= old_2;
            twice_3 <= $signed({step_2, 1'b0}) >>> rate_held;
            // A dead taxel's own noise is that of a sum
            whole_3 <= (!takes[2] || flags[FLAGS]) ? 27'd0 : step_2[36] ? ~step_2[35:9] : step_2[35:9];
            stress_4 <= stress_3;
            average_4 <= sum_3[35:0];
        end

        wire _unused_bits = &{1'b0, rounded_3[0], sum_3[36], step_2[8:0]};
    end

    // ---- Largest stress and step, and the limit
    wire [26:0] magnitude, step;
    wire [2*27-1:0] magnitude_halves, step_halves; // not needed
    reg [26:0] most;
    reg [26:0] most_step;
    wire signed [44:0] product;
    reg [44:0] limit;
    wire restarts = !holds || ({18'd0, most_step} > limit);

    sptfra_tree #(
        .COUNT   (SAMPLES),
        .WIDTH   (27),
        .LARGEST (1)
    ) largest_magnitude (
        .clock   (clock),
        .numbers (magnitudes_1),
        .halves  (magnitude_halves),
        .result  (magnitude)
    );

    sptfra_tree #(
        .COUNT   (SAMPLES),
        .WIDTH   (27),
        .LARGEST (1)
    ) largest_step (
        .clock   (clock),
        .numbers (steps_3),
        .halves  (step_halves),
        .result  (step)
    );

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({1'b0, FACTOR}),
        .data        ((LARGEST != 27'd0) ? LARGEST : most),
        .product     (product)
    );

    // ---- Variance of the noise left: twice it loses a share
    localparam [24:0] ONE = 25'd16777216;
    reg [2:0] settles;
    reg is_good; // the frame is of the average
    reg [3:0] taken_rate; // 0: it restarts it
    reg [24:0] lessened;

    assign known = settles[2];

    always @(posedge clock) begin
        settles <= {settles[1:0], ends[SETTLES]};
        if (ends[SETTLES]) begin
            is_good <= !is_bad && !out_bad_length;
            taken_rate <= restarts ? 4'd0 : rate_held;
        end
        lessened <= variance - (variance >> taken_rate);
        if (settles[1] && is_good) begin
            variance <= lessened - (lessened >> taken_rate) + (ONE >> {taken_rate, 1'b0});
        end
        if (reset) begin
            settles <= 3'd0;
            variance <= ONE;
        end
    end

    always @(posedge clock) begin
        if (opens) begin
            rate_held <= rate;
        end
        takes <= {takes[SETTLES-1:1], in_takes};
        ends <= {ends[SETTLES-1:1], in_ends};
        places <= {places[3*PLACE_WIDTH-1:0], place};
        flags <= {flags[3*FLAGS-1:0], in_flags};
        if (in_takes) begin
            place <= place + 1'b1;
        end
        if (in_takes && (in_flags[SAMPLES:1] != {SAMPLES{1'b0}})) begin
            is_bad <= 1'b1;
        end
        if (in_ends) begin
            busy <= 1'b1;
            out_bad_length <= in_bad_length;
        end
        if (reset || in_ends) begin
            place <= {PLACE_WIDTH{1'b0}};
        end

        if (takes[1+LEVELS] && (magnitude > most)) begin
            most <= magnitude;
        end
        if (step > most_step) begin
            most_step <= step;
        end
        limit <= $unsigned(product) >> FRACTION;

        if (ends[4]) begin
            busy <= 1'b0;
        end
        if (ends[SETTLES]) begin
            decided <= 1'b1;
            averaged <= !restarts;
            if (!is_bad && !out_bad_length) begin
                bank <= !bank;
                bank_averaged <= !restarts;
                holds <= 1'b1;
            end
        end
        if (reset || ends[SETTLES]) begin
            most <= 27'd0;
            most_step <= 27'd0;
            is_bad <= 1'b0;
        end
        if (reset || over) begin
            decided <= 1'b0;
        end
        if (reset) begin
            takes <= {SETTLES{1'b0}};
            ends <= {SETTLES{1'b0}};
            busy <= 1'b0;
            bank <= 1'b0;
            bank_averaged <= 1'b0;
            holds <= 1'b0;
            averaged <= 1'b0;
        end
    end

    wire _unused = &{1'b0, takes, magnitude_halves, step_halves};

endmodule

`default_nettype wire
