// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Memory with one port that reads or writes and one that reads, filled from FILE by $readmemh when the device is
// configured. No reset touches it. Two copies of one write and one read port each: such a memory is a block RAM of half
// the size, or LUTs.
//
// Latency: 1 cycle from address to data. A word must not be used that is read in the cycle in which it is written.

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
    // Reads, or writes
    input  wire                     write_enable,
    input  wire [ADDRESS_WIDTH-1:0] address,
    input  wire [WIDTH-1:0]         write_data,
    output wire [WIDTH-1:0]         data,
    // Reads
    input  wire [ADDRESS_WIDTH-1:0] read_address,
    output wire [WIDTH-1:0]         read_data
);

    sptfra_ram #(
        .WIDTH         (WIDTH),
        .DEPTH         (1 << ADDRESS_WIDTH),
        .ADDRESS_WIDTH (ADDRESS_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (FILE)
    ) first (
        .clock         (clock),
        .write_enable  (write_enable),
        .write_address (address),
        .write_data    (write_data),
        .read_enable   (1'b1),
        .read_address  (address),
        .read_data     (data)
    );

    sptfra_ram #(
        .WIDTH         (WIDTH),
        .DEPTH         (1 << ADDRESS_WIDTH),
        .ADDRESS_WIDTH (ADDRESS_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (FILE)
    ) second (
        .clock         (clock),
        .write_enable  (write_enable),
        .write_address (address),
        .write_data    (write_data),
        .read_enable   (1'b1),
        .read_address  (read_address),
        .read_data     (read_data)
    );

endmodule

`default_nettype wire
