// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Remembers of each frame inside the cycle in which its first beat was taken, counted from the reset, modulo 2^32: 0 is
// the first cycle after that of the core, whose register resets this module a cycle later. Sixteen frames may be
// inside; they leave in their order.

`default_nettype none

module sptfra_timestamp (
    input  wire clock,
    input  wire reset,
    // Handshake of the stream in
    input  wire in_taken,
    input  wire in_last,
    // Of the oldest frame inside
    output wire [31:0] timestamp,
    input  wire take
);

    reg [31:0] now;
    reg in_frame;
    reg [31:0] beginnings [0:15];
    reg [3:0] newest;
    reg [3:0] oldest;
    wire begins = in_taken && !in_frame;

    assign timestamp = beginnings[oldest];

    always @(posedge clock) begin
        now <= now + 32'd1;
        if (in_taken) begin
            in_frame <= !in_last;
        end
        if (begins) begin
            beginnings[newest] <= now;
            newest <= newest + 4'd1;
        end
        if (take) begin
            oldest <= oldest + 4'd1;
        end
        if (reset) begin
            now <= 32'd1;
            in_frame <= 1'b0;
            newest <= 4'd0;
            oldest <= 4'd0;
        end
    end

`ifdef SIMULATION
    // A frame leaves after it has come, and no more are inside than there is room for
    reg [4:0] held;

    always @(posedge clock) begin
        held <= held + {4'd0, begins} - {4'd0, take};
        if (reset) begin
            held <= 5'd0;
        end else if ((take && (held == 5'd0)) || (begins && (held == 5'd16))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $finish;
        end
    end
`endif

endmodule

`default_nettype wire
