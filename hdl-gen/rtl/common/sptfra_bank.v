// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Memory with one port that reads and writes and one that reads, filled from FILE by $readmemh when the device is
// configured; zeros without a FILE. No reset touches it. Two copies of one write and one read port each: such a memory
// is a block RAM of half the size, or LUTs.
//
// Latency: 1 cycle from address to data, on the second port held while read_enable is low. A word read in the cycle in
// which it is written is the old one.

`default_nettype none

module sptfra_bank #(
    // Bits of a word
    parameter WIDTH = 28,
    // Bits of an address; all of them are words
    parameter ADDRESS_WIDTH = 8,
    // Prefix of the file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Hexadecimal words, one a line, as many as there are
    parameter FILE = ""
) (
    input  wire                     clock,
    // Reads and writes
    input  wire                     write_enable,
    input  wire [ADDRESS_WIDTH-1:0] address,
    input  wire [WIDTH-1:0]         write_data,
    output reg  [WIDTH-1:0]         data,
    // Reads
    input  wire                     read_enable,
    input  wire [ADDRESS_WIDTH-1:0] read_address,
    output reg  [WIDTH-1:0]         read_data
);

    localparam DEPTH = 1 << ADDRESS_WIDTH;

    reg [WIDTH-1:0] memory [0:DEPTH-1];
    reg [WIDTH-1:0] copy [0:DEPTH-1];

    generate
        if (FILE != "" && ROM_DIR != "") begin : gen_contents
            initial begin
                $readmemh({ROM_DIR, FILE}, memory);
                $readmemh({ROM_DIR, FILE}, copy);
            end
        end else if (FILE != "") begin : gen_contents_here
            // An empty prefix would put a null character before the name
            initial begin
                $readmemh(FILE, memory);
                $readmemh(FILE, copy);
            end
        end else begin : gen_zeros
            integer word;

            initial begin
                for (word = 0; word < DEPTH; word = word + 1) begin
                    memory[word] = {WIDTH{1'b0}};
                    copy[word] = {WIDTH{1'b0}};
                end
            end
        end
    endgenerate

    always @(posedge clock) begin
        if (write_enable) begin
            memory[address] <= write_data;
        end
        data <= memory[address];
    end

    always @(posedge clock) begin
        if (write_enable) begin
            copy[address] <= write_data;
        end
        if (read_enable) begin
            read_data <= copy[read_address];
        end
    end

endmodule

`default_nettype wire
