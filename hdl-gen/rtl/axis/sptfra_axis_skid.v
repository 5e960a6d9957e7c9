// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// AXI-Stream skid buffer: a register in every wire of a stream, tready included.
//
// Latency 1 cycle, one beat a cycle, two beats of storage. Both tvalid and tready are low from the first clock edge in
// reset; tready rises one cycle after reset ends.

`default_nettype none

module sptfra_axis_skid #(
    // Bits of a beat
    parameter WIDTH = 32
) (
    input  wire clock,
    input  wire reset, // drops what is stored
    // Stream in
    input  wire [WIDTH-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output reg  s_tready,
    // Stream out: data and last hold while valid waits for ready
    output reg  [WIDTH-1:0] m_tdata,
    output reg  m_tlast,
    output reg  m_tvalid,
    input  wire m_tready
);

    reg spare_full;
    reg [WIDTH-1:0] spare_data;
    reg spare_last;

    wire taken = s_tvalid && s_tready;
    wire blocked = m_tvalid && !m_tready;

    // A beat that arrives while the output is blocked becomes the spare one
    wire spare_needed = blocked && (spare_full || taken);

    always @(posedge clock) begin
        if (s_tready) begin
            spare_data <= s_tdata;
            spare_last <= s_tlast;
        end
    end

    always @(posedge clock) begin
        // The output register takes the spare beat first; nothing is taken in while there is one
        if (!blocked) begin
            m_tvalid <= spare_full || taken;
            if (spare_full) begin
                m_tdata <= spare_data;
                m_tlast <= spare_last;
            end else begin
                m_tdata <= s_tdata;
                m_tlast <= s_tlast;
            end
        end

        // Nothing is offered or taken in reset
        if (reset) begin
            m_tvalid <= 1'b0;
        end
        spare_full <= spare_needed && !reset;
        s_tready <= !(spare_needed || reset);
    end

endmodule

`default_nettype wire
