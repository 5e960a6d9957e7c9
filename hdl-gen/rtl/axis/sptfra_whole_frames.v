// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Filter of whole frames for a stream that cannot be held. A frame that begins while there is room is kept to its
// TLAST. Of any other frame no beat is kept.
//
// Whether the beat on offer is kept is said in the same cycle. s_tready rises one cycle after reset ends.

`default_nettype none

module sptfra_whole_frames (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire s_tvalid,
    input  wire s_tlast,
    output reg  s_tready,
    // A frame that begins now has room, all of it
    input  wire room,
    output wire kept, // the beat taken now
    output wire begins, // it is the first of a frame that is kept
    output wire dropping, // within a frame of which nothing is kept
    output wire dropped // it ends now
);

    reg in_frame;
    reg keeps; // the frame coming in
    wire taken = s_tvalid && s_tready;
    wire keeps_this = in_frame ? keeps : room;

    assign kept = taken && keeps_this;
    assign begins = kept && !in_frame;
    assign dropping = in_frame && !keeps;
    assign dropped = taken && s_tlast && !keeps_this;

    always @(posedge clock) begin
        s_tready <= !reset;
        if (taken) begin
            in_frame <= !s_tlast;
            keeps <= keeps_this;
        end
        if (reset) begin
            in_frame <= 1'b0;
        end
    end

endmodule

`default_nettype wire
