// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One block of read-only memory with a registered output, filled from FILE by $readmemh; zeros without a FILE.
//
// Latency: 1 cycle, held while enable is low. One read a cycle.

`default_nettype none

module sptfra_rom_bank #(
    // Bits of a word
    parameter WIDTH = 18,
    // Words
    parameter DEPTH = 1024,
    // Bits of the address
    parameter ADDRESS_WIDTH = 10,
    // Prefix of the file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Hexadecimal words, one a line, as many as DEPTH
    parameter FILE = ""
) (
    input  wire                     clock,
    input  wire                     enable,
    input  wire [ADDRESS_WIDTH-1:0] address,
    output reg  [WIDTH-1:0]         data
);

    reg [WIDTH-1:0] memory [0:DEPTH-1];

    generate
        if (FILE != "" && ROM_DIR != "") begin : gen_contents
            initial $readmemh({ROM_DIR, FILE}, memory);
        end else if (FILE != "") begin : gen_contents_here
            // An empty prefix would put a null character before the name
            initial $readmemh(FILE, memory);
        end else begin : gen_zeros
            integer word;

            initial begin
                for (word = 0; word < DEPTH; word = word + 1) begin
                    memory[word] = {WIDTH{1'b0}};
                end
            end
        end
    endgenerate

    always @(posedge clock) begin
        if (enable) begin
            data <= memory[address];
        end
    end

endmodule

`default_nettype wire
