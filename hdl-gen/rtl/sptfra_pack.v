// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Puts the words of a stream together to the beats of a wide one, the first word in the lowest bits: what sptfra_unpack
// takes apart. Zeros fill a frame's last beat.
//
// Latency 1 cycle from a beat's last word, one word a cycle.

`default_nettype none

module sptfra_pack #(
    // Words of a beat: 2 or 4
    parameter WORDS = 4
) (
    input  wire clock,
    input  wire reset,
    // Words
    input  wire [31:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Beats
    output reg  [32*WORDS-1:0] m_tdata,
    output reg  m_tlast,
    output reg  m_tvalid,
    input  wire m_tready
);

    generate
        if ((WORDS != 2) && (WORDS != 4)) begin : gen_check_words
            sptfra_error_words_must_be_2_or_4 invalid ();
        end
    endgenerate

    localparam [31:0] TOP = WORDS - 1;

    reg [1:0] index; // of the next word
    wire [32*WORDS-1:0] word = {{(32*WORDS-32){1'b0}}, s_tdata} << {index, 5'd0};
    wire taken = s_tvalid && s_tready;
    wire full = s_tlast || (index == TOP[1:0]);

    assign s_tready = !m_tvalid || m_tready;

    always @(posedge clock) begin
        if (taken) begin
            m_tdata <= (index == 2'd0) ? word : m_tdata | word;
            m_tlast <= s_tlast;
            index <= full ? 2'd0 : index + 2'd1;
        end
        if (s_tready) begin
            m_tvalid <= taken && full;
        end
        if (reset) begin
            index <= 2'd0;
            m_tvalid <= 1'b0;
        end
    end

endmodule

`default_nettype wire
