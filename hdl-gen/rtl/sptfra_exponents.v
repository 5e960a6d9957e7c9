// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The exponent with which the next beat's count goes through the float conversion: each taxel has its own, from a ROM.
//
// It stands there with the beat, for as long as the beat waits: the ROM reads one taxel ahead.

`default_nettype none

module sptfra_exponents #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = ""
) (
    input  wire clock,
    input  wire reset,
    // The beat is taken; with last, the next one is of the first taxel
    input  wire accept,
    input  wire last,
    output wire signed [9:0] exponent
);

    localparam TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1;
    localparam [31:0] LAST_WIDE = TAXELS - 1;
    localparam [TAXEL_WIDTH-1:0] LAST = LAST_WIDE[TAXEL_WIDTH-1:0];

    reg [TAXEL_WIDTH-1:0] ahead; // the taxel after that of the next beat
    wire restart = reset || last;
    wire [TAXEL_WIDTH-1:0] address = restart ? {TAXEL_WIDTH{1'b0}} : ahead;
    wire [9:0] exponent_bits;

    assign exponent = $signed(exponent_bits);

    sptfra_rom #(
        .WIDTH         (10),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_exponents.mem"})
    ) exponents (
        .clock   (clock),
        .enable  (accept || reset),
        .address (address),
        .data    (exponent_bits)
    );

    always @(posedge clock) begin
        if (accept || reset) begin
            ahead <= (address == LAST) ? {TAXEL_WIDTH{1'b0}} : address + 1;
        end
    end

endmodule

`default_nettype wire
