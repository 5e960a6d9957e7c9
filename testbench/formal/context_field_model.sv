// SPDX-License-Identifier: MIT OR Apache-2.0
//
// A context field whose words are a register: sptfra_context_field with its words to be looked at.
module sptfra_context_field #(
    parameter WIDTH = 32
) (
    input  wire clock,
    input  wire reset,
    input  wire write,
    input  wire [WIDTH-1:0] write_data,
    input  wire take,
    output wire [WIDTH-1:0] oldest
);

    reg [WIDTH*16-1:0] words;
    reg [3:0] newest_place;
    reg [3:0] oldest_place;
    reg [WIDTH-1:0] word;
    integer frame;

    assign oldest = word;

    // Of constant places: a solver has a hard time with a memory's word at any place of a long register
    always @(*) begin
        word = words[WIDTH-1:0];
        for (frame = 1; frame < 16; frame = frame + 1) begin
            if (oldest_place == frame) begin
                word = words[WIDTH*frame +: WIDTH];
            end
        end
    end

    always @(posedge clock) begin
        for (frame = 0; frame < 16; frame = frame + 1) begin
            if (write && (newest_place == frame)) begin
                words[WIDTH*frame +: WIDTH] <= write_data;
            end
        end
        if (write) begin
            newest_place <= newest_place + 4'd1;
        end
        if (take) begin
            oldest_place <= oldest_place + 4'd1;
        end
        if (reset) begin
            newest_place <= 4'd0;
            oldest_place <= 4'd0;
        end
    end

endmodule
