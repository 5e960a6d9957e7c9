// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A number times an index of a few bits: shifts and additions, no multiplier. Combinational.

`default_nettype none

module sptfra_times_index #(
    // Bits of the index
    parameter integer INDEX_WIDTH = 4
) (
    input  wire [26:0] number,
    input  wire [INDEX_WIDTH-1:0] index,
    output reg  [26+INDEX_WIDTH:0] product
);

    localparam integer WIDTH = 27 + INDEX_WIDTH;

    wire [WIDTH-1:0] wide = {{INDEX_WIDTH{1'b0}}, number};
    integer place;

    always @(*) begin
        product = {WIDTH{1'b0}};
        for (place = 0; place < INDEX_WIDTH; place = place + 1) begin
            product = product + ((wide << place) & {WIDTH{index[place]}});
        end
    end

endmodule

`default_nettype wire
