// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// AXI-Stream skid buffer of a wide stream: one of 32 bits for each word of a beat, all in step.
//
// Latency 1 cycle, one beat a cycle, two beats of storage: see sptfra_axis_skid.

`default_nettype none

module sptfra_axis_skids #(
    // Words of a beat, 2 or more
    parameter WORDS = 4
) (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire [32*WORDS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Stream out
    output wire [32*WORDS-1:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    wire [WORDS-1:0] s_treadys; // all the same, as those below
    wire [WORDS-1:0] m_tlasts;
    wire [WORDS-1:0] m_tvalids;
    genvar word;

    assign s_tready = s_treadys[0];
    assign m_tlast = m_tlasts[0];
    assign m_tvalid = m_tvalids[0];

    generate
        for (word = 0; word < WORDS; word = word + 1) begin : gen_words
            sptfra_axis_skid skid (
                .clock    (clock),
                .reset    (reset),
                .s_tdata  (s_tdata[32*word +: 32]),
                .s_tlast  (s_tlast),
                .s_tvalid (s_tvalid),
                .s_tready (s_treadys[word]),
                .m_tdata  (m_tdata[32*word +: 32]),
                .m_tlast  (m_tlasts[word]),
                .m_tvalid (m_tvalids[word]),
                .m_tready (m_tready)
            );
        end
    endgenerate

    wire _unused = &{1'b0, s_treadys, m_tlasts, m_tvalids};

endmodule

`default_nettype wire
