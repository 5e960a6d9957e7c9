// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame gate of Bz: takes the stream's frames one at a time, counts their beats, and follows each through the pipeline
// behind.
//
// A frame begins while nothing of another one is in the pipeline and there is room. Beats of a frame of a wrong length
// are taken up to its TLAST and marked.
//
// Latency from a beat to its stage k: k cycles. Interval: a beat a cycle, a frame in BEATS + STAGES + 1 cycles.

`default_nettype none

module sptfra_frame_gate #(
    // Beats of a frame
    parameter BEATS = 100,
    // Stages of the pipeline
    parameter STAGES = 5
) (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Room for another frame, which a frame's first beat alone takes
    input  wire room,
    output wire accept,
    output wire opens, // a frame's first beat comes in
    output reg  in_frame,
    output wire under_way, // beats are in the pipeline
    // The beat in each stage, 0 being the one that comes in: it is of the frame; the last one
    output wire [STAGES:0] takes,
    output wire [STAGES:0] ends,
    // The beat in the last stage
    output wire out_valid,
    output wire out_bad_length // the frame ends with it and has another length
);

    localparam INDEX_WIDTH = $clog2(BEATS + 1);
    localparam [31:0] BEATS_WIDE = BEATS;
    localparam [31:0] LAST_WIDE = BEATS - 1;
    localparam [INDEX_WIDTH-1:0] BEYOND = BEATS_WIDE[INDEX_WIDTH-1:0];
    localparam [INDEX_WIDTH-1:0] LAST = LAST_WIDE[INDEX_WIDTH-1:0];

    reg [INDEX_WIDTH-1:0] index; // of the next beat, stops at BEATS
    reg may_open; // a register, so that the stream's ready has a short way
    reg [STAGES:1] valid;
    reg [STAGES:1] stores;
    reg [STAGES:1] lasts;
    reg [STAGES:1] bad_lengths;
    wire store = (index != BEYOND);

    assign s_tready = in_frame || may_open;
    assign accept = s_tvalid && s_tready;
    assign opens = accept && !in_frame;
    assign under_way = (valid != {STAGES{1'b0}});
    assign takes = {valid & stores, accept && store};
    assign ends = {valid & lasts, accept && s_tlast};
    assign out_valid = valid[STAGES];
    assign out_bad_length = bad_lengths[STAGES];

    always @(posedge clock) begin
        if (accept) begin
            in_frame <= !s_tlast;
            index <= s_tlast ? {INDEX_WIDTH{1'b0}} : store ? index + 1'b1 : index;
        end
        may_open <= !accept && !under_way && room;
        valid <= {valid[STAGES-1:1], accept};
        stores <= {stores[STAGES-1:1], store};
        lasts <= {lasts[STAGES-1:1], s_tlast};
        bad_lengths <= {bad_lengths[STAGES-1:1], index != LAST};
        if (reset) begin
            may_open <= 1'b1;
            in_frame <= 1'b0;
            index <= {INDEX_WIDTH{1'b0}};
            valid <= {STAGES{1'b0}};
        end
    end

endmodule

`default_nettype wire
