// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Memory with one write port and one read port, both synchronous, filled from FILE by $readmemh when the device is
// configured; undefined without a FILE. A ROM is one that is not WRITABLE.
//
// Latency: 1 cycle from read_address to read_data, held while read_enable is low. A word that is read in the cycle of
// its write must not be used. Block memories differ in what they answer then, and a tool that has to keep to one
// answer adds logic. Simulations answer with the old word's complement.

`default_nettype none

module sptfra_ram #(
    // Bits of a word
    parameter WIDTH = 27,
    // Words
    parameter DEPTH = 512,
    // Bits of an address
    parameter ADDRESS_WIDTH = 9,
    // Prefix of the file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Hexadecimal words, one a line, as many as DEPTH
    parameter FILE = "",
    // 0: a ROM, without a write port
    parameter WRITABLE = 1
) (
    input  wire                     clock,
    input  wire                     write_enable,
    input  wire [ADDRESS_WIDTH-1:0] write_address,
    input  wire [WIDTH-1:0]         write_data,
    input  wire                     read_enable,
    input  wire [ADDRESS_WIDTH-1:0] read_address,
    output reg  [WIDTH-1:0]         read_data
);

    (* no_rw_check *) reg [WIDTH-1:0] memory [0:DEPTH-1];

    if (FILE != "" && ROM_DIR != "") begin : gen_contents
        initial $readmemh({ROM_DIR, FILE}, memory);
    end else if (FILE != "") begin : gen_contents_here
        // An empty prefix would put a null character before the name
        initial $readmemh(FILE, memory);
    end else if (WRITABLE == 0) begin : gen_no_contents
        // Neither a file nor a port writes it, and a memory needs a value
        initial memory[0] = {WIDTH{1'b0}};
    end

    // A tied-off port remains where a tool keeps the hierarchy: small ROMs would be block memories in place of LUTs
    if (WRITABLE != 0) begin : gen_write
        always @(posedge clock) begin
            if (write_enable) begin
                memory[write_address] <= write_data;
            end
        end
    end else begin : gen_no_write
        wire _unused_write = &{1'b0, write_enable, write_address, write_data};
    end

    always @(posedge clock) begin
        if (read_enable) begin
            read_data <= memory[read_address];
`ifdef SIMULATION
            if (write_enable && (write_address == read_address)) begin
                read_data <= ~memory[read_address];
            end
`endif
        end
    end

endmodule

`default_nettype wire
