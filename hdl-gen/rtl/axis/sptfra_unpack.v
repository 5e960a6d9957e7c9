// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Serialiser of a wide stream: one sample a cycle, the one in a beat's lowest bits first.
//
// Latency: 1 cycle. What fills a frame's last beat behind its samples is dropped. A frame with too many beats has one
// sample for each of them, so that it stays too long.

`default_nettype none

module sptfra_unpack #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Bits of a beat, and of a sample
    parameter STREAM_BITS = 128,
    parameter SAMPLE_BITS = 32
) (
    input  wire clock,
    input  wire reset,
    // Beats
    input  wire [STREAM_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Samples
    output wire [SAMPLE_BITS-1:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    localparam SAMPLES = STREAM_BITS / SAMPLE_BITS;
    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam BEAT_WIDTH = $clog2(BEATS + 1);
    localparam [31:0] END_WIDE = BEATS;
    localparam [31:0] LAST_BEAT_WIDE = BEATS - 1;
    localparam [BEAT_WIDTH-1:0] END = END_WIDE[BEAT_WIDTH-1:0];
    localparam [BEAT_WIDTH-1:0] LAST_BEAT = LAST_BEAT_WIDE[BEAT_WIDTH-1:0];
    localparam LEFT_WIDTH = $clog2(SAMPLES + 1);
    localparam [LEFT_WIDTH-1:0] ONE = 1;
    localparam [31:0] ALL = SAMPLES;
    localparam [31:0] REMAINDER = TAXELS - (BEATS - 1) * SAMPLES; // of a frame's last beat

    if ((SAMPLES < 2) || (SAMPLES > 8)) begin : gen_check_samples
        sptfra_error_samples_of_a_beat_must_be_2_to_8 invalid ();
    end

    reg [STREAM_BITS-1:0] held;
    reg held_last;
    reg [LEFT_WIDTH-1:0] left; // samples in it
    reg [BEAT_WIDTH-1:0] beat; // the next one, stops at BEATS
    wire last_sample = (left == ONE);
    wire inner_beat = (beat < LAST_BEAT);
    wire last_beat = (beat == LAST_BEAT);

    assign m_tdata = held[SAMPLE_BITS-1:0];
    assign m_tlast = held_last && last_sample;
    assign m_tvalid = (left != {LEFT_WIDTH{1'b0}});
    assign s_tready = !m_tvalid || (last_sample && m_tready);

    always @(posedge clock) begin
        if (m_tvalid && m_tready) begin
            held <= held >> SAMPLE_BITS;
            left <= left - 1'b1;
        end
        if (s_tvalid && s_tready) begin
            held <= s_tdata;
            held_last <= s_tlast;
            left <= inner_beat ? ALL[LEFT_WIDTH-1:0] : last_beat ? REMAINDER[LEFT_WIDTH-1:0] : ONE;
            beat <= s_tlast ? {BEAT_WIDTH{1'b0}} : (beat == END) ? beat : beat + 1'b1;
        end
        if (reset) begin
            left <= {LEFT_WIDTH{1'b0}};
            beat <= {BEAT_WIDTH{1'b0}};
        end
    end

endmodule

`default_nettype wire
