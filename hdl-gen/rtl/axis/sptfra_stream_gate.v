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
    output wire core_reset,
    output wire resetting, // request to core_reset
    output wire discarding, // the rest of a packet
    output wire receiving, // within a packet
    output wire sending,
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

    reg waiting;
    reg resets;
    reg discards;
    reg in_packet; // a beat was taken, its TLAST was not
    reg out_packet; // a beat was offered, its TLAST was not taken

    assign core_reset = resets;
    assign resetting = waiting;
    assign discarding = discards;
    assign receiving = in_packet;
    assign sending = out_packet;

    // ---- In
    wire in_open = !waiting && !discards;
    wire take = s_tvalid && s_tready;
    wire in_packet_next = take ? !s_tlast : in_packet;

    assign core_s_tvalid = s_tvalid && in_open;
    assign s_tready = discards || (core_s_tready && !waiting);

    // ---- Out
    wire out_open = !waiting || out_packet;

    assign m_tvalid = core_m_tvalid && out_open;
    assign core_m_tready = m_tready && out_open;

    always @(posedge clock) begin
        in_packet <= in_packet_next;
        if (m_tvalid) begin
            out_packet <= !(m_tready && core_m_tlast);
        end
        if (take && s_tlast) begin
            discards <= 1'b0;
        end
        resets <= waiting && !out_packet && !resets;
        if (resets) begin
            waiting <= 1'b0;
        end
        if (request) begin
            waiting <= 1'b1;
            discards <= in_packet_next;
        end
        if (reset) begin
            waiting <= 1'b0;
            resets <= 1'b0;
            discards <= 1'b0;
            in_packet <= 1'b0;
            out_packet <= 1'b0;
        end
    end

endmodule

`default_nettype wire
