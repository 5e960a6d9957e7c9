// SPDX-License-Identifier: MIT OR Apache-2.0
//
// A memory as a register: sptfra_ram with its words to be looked at.
module sptfra_ram #(
    parameter WIDTH = 27,
    parameter DEPTH = 512,
    parameter ADDRESS_WIDTH = 9
) (
    input  wire                     clock,
    input  wire                     write_enable,
    input  wire [ADDRESS_WIDTH-1:0] write_address,
    input  wire [WIDTH-1:0]         write_data,
    input  wire                     read_enable,
    input  wire [ADDRESS_WIDTH-1:0] read_address,
    output reg  [WIDTH-1:0]         read_data
);

    reg [WIDTH*DEPTH-1:0] words;

    always @(posedge clock) begin
        if (write_enable) begin
            words[WIDTH*write_address +: WIDTH] <= write_data;
        end
        if (read_enable) begin
            read_data <= words[WIDTH*read_address +: WIDTH];
        end
    end

endmodule
