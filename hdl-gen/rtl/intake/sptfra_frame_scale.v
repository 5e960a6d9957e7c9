// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame scale: the largest power of two, not below one, that keeps a frame's largest stress within the full scale.
//
// `whole` rises 5 cycles after the frame's last beat. The exponent is there two cycles later and held. Both are later
// by the logarithm of the samples of a beat.
//
// All behind the operand memories is homogeneous. So the scaled frame has the same friction, and forces larger by its
// power of two. sptfra_frame_context keeps that for the output.

`default_nettype none

module sptfra_frame_scale #(
    // Samples of a beat, and how many stresses each may come to be: a frame is made of the first or the last of them
    parameter SAMPLES = 1,
    parameter CANDIDATES = 1,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000
) (
    input  wire clock,
    input  wire reset,
    // Beats
    input  wire beat_valid,
    input  wire [27*SAMPLES*CANDIDATES-1:0] stresses, // candidate by candidate, the samples of each side by side
    input  wire ends, // the frame ends, with its last beat or after it
    input  wire bad_length,
    input  wire averaged, // the frame is made of the last candidates: known with whole
    input  wire restart, // nothing of the frame is needed any more
    output reg  whole,
    // The frame's power of two, for one cycle
    output reg  scaled,
    output wire [4:0] exponent
);

    localparam LEVELS = $clog2(SAMPLES);
    localparam SETTLES = 6 + LEVELS;
    localparam [31:0] BOUND_WIDE = {5'd0, STRESS_BOUND};
    localparam [31:0] BOUND_BITS = $clog2(BOUND_WIDE + 1);

    reg [LEVELS:0] valid;
    reg [SETTLES:1] settles; // index k: k cycles after the end
    reg is_bad;
    wire [LEVELS+1:0] valid_next = {valid, beat_valid};
    wire [SETTLES+1:1] settles_next = {settles, ends};

    always @(posedge clock) begin
        valid <= valid_next[LEVELS:0];
        settles <= settles_next[SETTLES:1];
        if (ends) begin
            is_bad <= bad_length;
        end
        if (settles[SETTLES-2]) begin
            whole <= 1'b1;
        end
        scaled <= settles[SETTLES];
        if (reset) begin
            valid <= {(LEVELS+1){1'b0}};
            settles <= {SETTLES{1'b0}};
            scaled <= 1'b0;
        end
        if (reset || restart) begin
            whole <= 1'b0;
        end
    end

    // ---- The largest magnitude of a beat, then of the frame, and the power of two
    wire [5*CANDIDATES-1:0] exponents;
    genvar candidate;
    genvar sample;

    assign exponent = averaged ? exponents[5*(CANDIDATES-1) +: 5] : exponents[4:0];

    for (candidate = 0; candidate < CANDIDATES; candidate = candidate + 1) begin : gen_candidates
        wire [27*SAMPLES-1:0] magnitudes;
        wire [2*27-1:0] halves;
        wire [26:0] largest;
        reg [26:0] most;
        wire [5:0] most_bits; // two cycles behind
        reg [4:0] guess; // brings the leading bit to that of the full scale
        reg [26:0] guessed;
        reg [4:0] found;

        assign exponents[5*candidate +: 5] = found;

        for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_samples
            wire [26:0] stress = stresses[27*(SAMPLES*candidate+sample) +: 27];
            reg [26:0] magnitude;

            assign magnitudes[27*sample +: 27] = magnitude;

            always @(posedge clock) begin
                magnitude <= stress[26] ? -stress : stress;
            end
        end

        sptfra_tree #(
            .COUNT   (SAMPLES),
            .WIDTH   (27),
            .LARGEST (1)
        ) largest_of_beat (
            .clock   (clock),
            .numbers (magnitudes),
            .halves  (halves),
            .result  (largest)
        );

        sptfra_leading_bit #(
            .WIDTH (32)
        ) leading_bit (
            .clock (clock),
            .value ({5'd0, most}),
            .bits  (most_bits)
        );

        always @(posedge clock) begin
            if (valid[LEVELS]) begin
                most <= (largest > most) ? largest : most;
            end
            guess <= BOUND_BITS[4:0] - most_bits[4:0];
            guessed <= most << guess;
            if (settles[SETTLES]) begin
                // What another frame has left where this one is too short is not this one's to scale
                found <= is_bad ? 5'd0 : (guessed > STRESS_BOUND) ? guess - 5'd1 : guess;
            end
            if (reset || settles[SETTLES]) begin
                most <= 27'd0;
            end
        end

        wire _unused_bits = &{1'b0, most_bits, halves};
    end

    wire _unused = &{1'b0, BOUND_BITS, valid_next, settles_next};

endmodule

`default_nettype wire
