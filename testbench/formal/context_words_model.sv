// SPDX-License-Identifier: MIT OR Apache-2.0
//
// A context memory as a register: sptfra_context_words with its words to be looked at.
module sptfra_context_words #(
    parameter WIDTH = 32
) (
    input  wire clock,
    input  wire write,
    input  wire [3:0] write_frame,
    input  wire [WIDTH-1:0] write_data,
    input  wire [3:0] read_frame,
    output wire [WIDTH-1:0] read_data
);

    reg [WIDTH*16-1:0] words;
    reg [WIDTH-1:0] word;
    integer frame;

    assign read_data = word;

    // Of constant places: a solver has a hard time with a memory's word at any place of a long register
    always @(*) begin
        word = words[WIDTH-1:0];
        for (frame = 1; frame < 16; frame = frame + 1) begin
            if (read_frame == frame) begin
                word = words[WIDTH*frame +: WIDTH];
            end
        end
    end

    always @(posedge clock) begin
        for (frame = 0; frame < 16; frame = frame + 1) begin
            if (write && (write_frame == frame)) begin
                words[WIDTH*frame +: WIDTH] <= write_data;
            end
        end
    end

endmodule
