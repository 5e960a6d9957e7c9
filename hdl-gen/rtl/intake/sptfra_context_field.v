// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A field of the frames' contexts: FIFO of sixteen words, one for each frame inside the core.
//
// The oldest word is there in the same cycle. Frames come and go in one order, which simulations check.

`default_nettype none

module sptfra_context_field #(
    // Bits of a word
    parameter WIDTH = 32
) (
    input  wire clock,
    input  wire reset,
    input  wire write, // a frame's word
    input  wire [WIDTH-1:0] write_data,
    input  wire take, // the oldest one
    output wire [WIDTH-1:0] oldest
);

    reg [WIDTH-1:0] words [0:15];
    reg [3:0] newest_place;
    reg [3:0] oldest_place;

    assign oldest = words[oldest_place];

    always @(posedge clock) begin
        if (write) begin
            words[newest_place] <= write_data;
            newest_place <= newest_place + 4'd1;
        end
        if (take) begin
            oldest_place <= oldest_place + 4'd1;
        end
        if (reset) begin
            newest_place <= 4'd0;
            oldest_place <= 4'd0;
        end
    end

`ifdef SIMULATION
    reg [4:0] held;

    always @(posedge clock) begin
        held <= held + {4'd0, write} - {4'd0, take};
        if (reset) begin
            held <= 5'd0;
        end else if ((take && (held == 5'd0)) || (write && !take && (held == 5'd16))) begin
            $fdisplay(32'h80000002, "%m: a frame leaves that has not come, or more are inside than there is room for");
            $fatal(1);
        end
    end
`endif

endmodule

`default_nettype wire
