// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Distributed memory of sixteen words, one for each frame inside the core: written on the clock edge, read in the same
// cycle.

`default_nettype none

module sptfra_context_words #(
    // Bits of a word
    parameter WIDTH = 32
) (
    input  wire clock,
    input  wire write,
    input  wire [3:0] write_frame,
    input  wire [WIDTH-1:0] write_data,
    input  wire [3:0] read_frame,
    output wire [WIDTH-1:0] read_data
);

    reg [WIDTH-1:0] words [0:15];

    assign read_data = words[read_frame];

    always @(posedge clock) begin
        if (write) begin
            words[write_frame] <= write_data;
        end
    end

endmodule

`default_nettype wire
