// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts frames and measures their cycles, from the handshakes of a core's two streams; counts dropped frames too.
//
// Sixteen frames may be inside.

`default_nettype none

module sptfra_frame_meter (
    input  wire clock,
    input  wire reset,
    // Handshakes
    input  wire in_taken,
    input  wire in_last,
    input  wire out_taken,
    input  wire out_last,
    input  wire [31:0] out_word,
    input  wire dropped, // a frame, for one cycle
    // Figures
    output reg  [31:0] frames_in,
    output reg  [31:0] frames_out,
    output reg  [31:0] frames_bad,
    output reg  [31:0] last_status,
    output reg  [31:0] last_latency,
    output reg  [31:0] last_interval,
    output reg  [31:0] frames_dropped,
    // For one cycle, after a frame's last beat
    output reg  frame_done,
    output reg  frame_error
);

    reg [31:0] now;
    reg in_frame;
    reg out_frame;
    reg [31:0] status; // of the frame going out
    // When each frame inside began
    reg [31:0] beginnings [0:15];
    reg [3:0] newest;
    reg [3:0] oldest;
    reg [31:0] last_end;
    reg seen_end;

    wire frame_ends = out_taken && out_last;
    wire faulty = (status[5:4] != 2'd0);

    always @(posedge clock) begin
        now <= now + 32'd1;
        if (in_taken) begin
            in_frame <= !in_last;
            if (!in_frame) begin
                beginnings[newest] <= now;
                newest <= newest + 4'd1;
            end
            if (in_last) begin
                frames_in <= frames_in + 32'd1;
            end
        end
        if (out_taken) begin
            out_frame <= !out_last;
            if (!out_frame) begin
                status <= out_word;
            end
        end
        frames_dropped <= frames_dropped + {31'd0, dropped};
        frame_done <= frame_ends;
        frame_error <= frame_ends && faulty;
        if (frame_ends) begin
            frames_out <= frames_out + 32'd1;
            frames_bad <= frames_bad + {31'd0, faulty};
            last_status <= status;
            last_latency <= now - beginnings[oldest] + 32'd1;
            last_interval <= seen_end ? now - last_end : 32'd0;
            last_end <= now;
            seen_end <= 1'b1;
            oldest <= oldest + 4'd1;
        end
        if (reset) begin
            now <= 32'd0;
            in_frame <= 1'b0;
            out_frame <= 1'b0;
            newest <= 4'd0;
            oldest <= 4'd0;
            seen_end <= 1'b0;
            frames_in <= 32'd0;
            frames_out <= 32'd0;
            frames_bad <= 32'd0;
            last_status <= 32'd0;
            last_latency <= 32'd0;
            last_interval <= 32'd0;
            frames_dropped <= 32'd0;
            frame_done <= 1'b0;
            frame_error <= 1'b0;
        end
    end

endmodule

`default_nettype wire
