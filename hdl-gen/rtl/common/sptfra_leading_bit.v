// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Significant bits of a number: the place of its leading one, counted from 1; 0 of a zero.
//
// In two steps: the highest byte that is not zero, then the highest bit in it. Latency: 2 cycles, in which the number
// holds.

`default_nettype none

module sptfra_leading_bit #(
    // Bits of the number, a multiple of 8
    parameter integer WIDTH = 40
) (
    input  wire clock,
    input  wire [WIDTH-1:0] value,
    output wire [$clog2(WIDTH+1)-1:0] bits
);

    localparam integer OCTETS = WIDTH / 8;
    localparam integer OCTET_WIDTH = $clog2(OCTETS);
    localparam integer BITS_WIDTH = $clog2(WIDTH + 1);

    if ((WIDTH % 8 != 0) || (WIDTH < 16)) begin : gen_check
        sptfra_error_width_must_be_a_multiple_of_8_from_16_on invalid ();
    end

    reg [OCTET_WIDTH-1:0] octet;
    reg [7:0] top;

    function [OCTET_WIDTH-1:0] top_octet(input [WIDTH-1:0] number);
        integer index;
        begin
            top_octet = {OCTET_WIDTH{1'b0}};
            for (index = 1; index < OCTETS; index = index + 1) begin
                if (number[8*index +: 8] != 8'd0) begin
                    top_octet = index[OCTET_WIDTH-1:0];
                end
            end
        end
    endfunction

    function [3:0] significant_bits(input [7:0] number);
        integer place;
        begin
            significant_bits = 4'd0;
            for (place = 0; place < 8; place = place + 1) begin
                if (number[place]) begin
                    significant_bits = place[3:0] + 4'd1;
                end
            end
        end
    endfunction

    always @(posedge clock) begin
        octet <= top_octet(value);
        top <= value[{octet, 3'd0} +: 8];
    end

    // Of a few bits, so that the sum has the width of the result
    wire [OCTET_WIDTH+3:0] sum = {1'b0, octet, 3'd0} + { {OCTET_WIDTH{1'b0}}, significant_bits(top)};

    assign bits = sum[BITS_WIDTH-1:0];

    wire _unused = &{1'b0, sum};

endmodule

`default_nettype wire
