// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// AXI-Stream skid buffer: a register in every wire of a stream, tready included.
//
// Latency 1 cycle, one word of 32 bits a cycle, two words of storage. Both tvalid and tready are low from the
// first clock edge in reset; tready rises one cycle after reset ends.

`default_nettype none

module sptfra_axis_skid (
    input  wire clock,           // rising edge
    input  wire reset,           // synchronous, high: drops what is stored
    input  wire [31:0] s_tdata,  // word in
    input  wire s_tlast,         // last word of its frame, in
    input  wire s_tvalid,        // a word is offered
    output wire s_tready,        // a word offered now is taken
    output wire [31:0] m_tdata,  // word out; with tlast stable while tvalid waits for tready
    output wire m_tlast,         // last word of its frame, out
    output wire m_tvalid,        // a word is offered
    input  wire m_tready         // the word offered now is taken
);

    reg ready;
    reg valid;
    reg [31:0] data;
    reg last;
    reg spare_full;
    reg [31:0] spare_data;
    reg spare_last;

    wire taken = s_tvalid && ready;
    wire blocked = valid && !m_tready;

    // a word that arrives while the output is blocked becomes the spare word
    wire spare_needed = blocked && (spare_full || taken);

    always @(posedge clock) begin
        if (ready) begin
            spare_data <= s_tdata;
            spare_last <= s_tlast;
        end
    end

    always @(posedge clock) begin
        // the output register takes the spare word first; nothing is taken in while there is one
        if (!blocked) begin
            valid <= spare_full || taken;
            if (spare_full) begin
                data <= spare_data;
                last <= spare_last;
            end else begin
                data <= s_tdata;
                last <= s_tlast;
            end
        end

        // nothing is offered or taken in reset
        if (reset) begin
            valid <= 1'b0;
        end
        spare_full <= spare_needed && !reset;
        ready <= !(spare_needed || reset);
    end

    assign s_tready = ready;
    assign m_tdata = data;
    assign m_tlast = last;
    assign m_tvalid = valid;

endmodule

`default_nettype wire
