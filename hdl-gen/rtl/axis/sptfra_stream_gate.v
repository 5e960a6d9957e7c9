// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Soft reset of a core between two AXI4-Streams that may not notice: no beat on offer is withdrawn, no packet out cut.
//
// On request the output sends the packet it has begun to its end and closes. The core is reset for one cycle, then
// both streams open again. A packet that is coming in is taken to its TLAST and dropped. The next one is a frame
// again. At all other times both streams pass in the same cycle.

`default_nettype none

module sptfra_stream_gate (
    input  wire clock,
    input  wire reset,
    input  wire request, // for one cycle
    output reg  core_reset,
    output reg  resetting, // request to core_reset
    output reg  discarding, // the rest of a packet
    output reg  receiving, // a beat was taken, its TLAST was not
    output reg  sending, // a beat was offered, its TLAST was not taken
    // Stream in: outside, core
    input  wire s_tvalid,
    input  wire s_tlast,
    output wire s_tready,
    output wire core_s_tvalid,
    input  wire core_s_tready,
    // Stream out: core, outside
    input  wire core_m_tvalid,
    input  wire core_m_tlast,
    output wire core_m_tready,
    output wire m_tvalid,
    input  wire m_tready
);

    // ---- In
    wire in_open = !resetting && !discarding;
    wire take = s_tvalid && s_tready;
    wire in_packet_next = take ? !s_tlast : receiving;

    assign core_s_tvalid = s_tvalid && in_open;
    assign s_tready = discarding || (core_s_tready && !resetting);

    // ---- Out
    wire out_open = !resetting || sending;

    assign m_tvalid = core_m_tvalid && out_open;
    assign core_m_tready = m_tready && out_open;

    always @(posedge clock) begin
        receiving <= in_packet_next;
        if (m_tvalid) begin
            sending <= !(m_tready && core_m_tlast);
        end
        if (take && s_tlast) begin
            discarding <= 1'b0;
        end
        core_reset <= resetting && !sending && !core_reset;
        if (core_reset) begin
            resetting <= 1'b0;
        end
        if (request) begin
            resetting <= 1'b1;
            discarding <= in_packet_next;
        end
        if (reset) begin
            resetting <= 1'b0;
            core_reset <= 1'b0;
            discarding <= 1'b0;
            receiving <= 1'b0;
            sending <= 1'b0;
        end
    end

endmodule

`default_nettype wire
