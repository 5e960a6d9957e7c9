// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts the frames that had no room, beside the registers of sptfra_registers: FRAMES_DROPPED, 0x068 of the map in the
// design's control/NAME.rdl, and bit 5 of FEATURES.
//
// Reads answer in the same cycle. A soft reset clears the count.

`default_nettype none

module sptfra_overrun_registers (
    input  wire clock,
    input  wire reset,
    input  wire dropped, // a frame, for one cycle
    // Accesses
    input  wire [9:0] write_word,
    output wire write_mapped,
    input  wire [9:0] read_word,
    output wire [31:0] read_data, // zero elsewhere
    output wire read_mapped
);

    // Addresses, in words
    localparam [9:0] FEATURES = 10'd6;
    localparam [9:0] FRAMES_DROPPED = 10'd26;

    reg [31:0] frames_dropped;

    assign write_mapped = (write_word == FRAMES_DROPPED);
    assign read_mapped = (read_word == FRAMES_DROPPED);
    assign read_data = (read_word == FEATURES) ? 32'h00000020 : read_mapped ? frames_dropped : 32'd0;

    always @(posedge clock) begin
        frames_dropped <= frames_dropped + {31'd0, dropped};
        if (reset) begin
            frames_dropped <= 32'd0;
        end
    end

endmodule

`default_nettype wire
