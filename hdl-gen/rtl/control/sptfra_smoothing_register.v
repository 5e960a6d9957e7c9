// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Register SMOOTHING, the k of the moving average with the weight 2^-k, and bit 7 of FEATURES. Beside the registers of
// sptfra_registers: 0x06C of the map in the design's control/NAME.rdl.
//
// Reads answer in the same cycle. A soft reset leaves it as it is.

`default_nettype none

module sptfra_smoothing_register #(
    // k after reset, 1 to 8
    parameter [3:0] RATE = 4'd4
) (
    input  wire clock,
    input  wire reset,
    // Accesses
    input  wire write_enable,
    input  wire [9:0] write_word,
    input  wire [31:0] write_data,
    input  wire [31:0] write_mask,
    output wire write_mapped,
    input  wire [9:0] read_word,
    output wire [31:0] read_data, // zero elsewhere
    output wire read_mapped,
    output wire [3:0] rate // 8 at most
);

    // Addresses, in words
    localparam [9:0] FEATURES = 10'd6;
    localparam [9:0] SMOOTHING = 10'd27;

    reg [3:0] written;

    assign write_mapped = (write_word == SMOOTHING);
    assign read_mapped = (read_word == SMOOTHING);
    assign read_data = (read_word == FEATURES) ? 32'h00000080 : read_mapped ? {28'd0, written} : 32'd0;
    assign rate = written[3] ? 4'd8 : written;

    always @(posedge clock) begin
        if (write_enable && write_mapped) begin
            written <= (written & ~write_mask[3:0]) | (write_data[3:0] & write_mask[3:0]);
        end
        if (reset) begin
            written <= RATE;
        end
    end

    wire _unused = &{1'b0, write_data[31:4], write_mask[31:4]};

endmodule

`default_nettype wire
