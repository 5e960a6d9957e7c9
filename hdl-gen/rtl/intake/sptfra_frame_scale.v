// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame scale: the largest power of two, not below one, that keeps a frame's largest stress within the full scale.
//
// `whole` rises 5 cycles after the frame's last beat, the exponent is there two cycles later and held; each later by
// the logarithm of the samples of a beat. All behind the operand memories is homogeneous: the scaled frame has the
// friction of the frame, and forces that are larger by its power of two: see sptfra_frame_context.

`default_nettype none

module sptfra_frame_scale #(
    // Samples of a beat
    parameter SAMPLES = 1,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000
) (
    input  wire clock,
    input  wire reset,
    // Beats
    input  wire beat_valid,
    input  wire [27*SAMPLES-1:0] stresses,
    input  wire [SAMPLES-1:0] counted, // samples of the frame
    input  wire ends, // the frame ends, with its last beat or after it
    input  wire bad_length,
    input  wire restart, // nothing of the frame is needed any more
    output reg  whole,
    // The frame's power of two, for one cycle
    output reg  scaled,
    output reg  [4:0] exponent
);

    localparam LEVELS = $clog2(SAMPLES);
    localparam SETTLES = 6 + LEVELS;
    localparam [31:0] BOUND_WIDE = {5'd0, STRESS_BOUND};
    localparam [31:0] BOUND_BITS = $clog2(BOUND_WIDE + 1);

    // ---- The largest magnitude of a beat: a tree of its halves
    wire [26:0] largest [1:2*SAMPLES-1];
    genvar node;

    generate
        for (node = 1; node < 2 * SAMPLES; node = node + 1) begin : gen_nodes
            reg [26:0] held;

            assign largest[node] = held;

            if (node >= SAMPLES) begin : gen_leaf
                wire [26:0] stress = stresses[27*(node-SAMPLES) +: 27];

                always @(posedge clock) begin
                    held <= !counted[node-SAMPLES] ? 27'd0 : stress[26] ? -stress : stress;
                end
            end else begin : gen_pair
                always @(posedge clock) begin
                    held <= (largest[2*node] > largest[2*node+1]) ? largest[2*node] : largest[2*node+1];
                end
            end
        end
    endgenerate

    // ---- The largest of the frame, and the power of two
    reg [LEVELS:0] valid;
    reg [26:0] most;
    reg [SETTLES:1] settles; // index k: k cycles after the end
    reg is_bad;
    wire [5:0] most_bits; // two cycles behind
    reg [4:0] guess; // brings the leading bit to that of the full scale
    reg [26:0] guessed;
    wire [LEVELS+1:0] valid_next = {valid, beat_valid};
    wire [SETTLES+1:1] settles_next = {settles, ends};

    sptfra_leading_bit #(
        .WIDTH (32)
    ) leading_bit (
        .clock (clock),
        .value ({5'd0, most}),
        .bits  (most_bits)
    );

    always @(posedge clock) begin
        valid <= valid_next[LEVELS:0];
        if (valid[LEVELS]) begin
            most <= (largest[1] > most) ? largest[1] : most;
        end
        guess <= BOUND_BITS[4:0] - most_bits[4:0];
        guessed <= most << guess;
        settles <= settles_next[SETTLES:1];
        if (ends) begin
            is_bad <= bad_length;
        end
        if (settles[SETTLES-2]) begin
            whole <= 1'b1;
        end
        scaled <= settles[SETTLES];
        if (settles[SETTLES]) begin
            // What another frame has left where this one is too short is not this one's to scale
            exponent <= is_bad ? 5'd0 : (guessed > STRESS_BOUND) ? guess - 5'd1 : guess;
        end
        if (reset) begin
            valid <= {(LEVELS+1){1'b0}};
            settles <= {SETTLES{1'b0}};
            scaled <= 1'b0;
        end
        if (reset || restart) begin
            whole <= 1'b0;
        end
        if (reset || settles[SETTLES]) begin
            most <= 27'd0;
        end
    end

    wire _unused = &{1'b0, most_bits, BOUND_BITS, valid_next, settles_next};

endmodule

`default_nettype wire
