// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A sum, product, quotient or root as float32: normalised, rounded to nearest even, limited.
//
// The number is value * 2^(exponent - 127 - 26), of its sign; rest, if any of it is set, stands for a little more
// than that, below the last bit. A zero is positive; what rounds to less than 2^-126 is zero, what rounds to more
// than the largest finite number is that. Latency: 4 cycles from start to done, which is one cycle; the result holds
// until the next.

`default_nettype none

module sptfra_float_round (
    input  wire clock,
    input  wire reset,
    input  wire start,                   // with these
    input  wire negative,                // the sign, held until done
    input  wire [27:0] value,
    input  wire [9:0] rest,
    input  wire signed [9:0] exponent,
    output reg  done,
    output reg  [31:0] float_bits        // IEEE 754 single precision
);

    localparam [30:0] LARGEST = 31'h7f7fffff;

    reg start_1, start_2, start_3;

    // ---- By octets, then by bits, until the leading one is bit 27
    wire sticky = value[0] || (rest != 10'd0);
    wire [27:0] whole = {value[27:1], sticky};
    wire [1:0] octets = (value[27:20] != 8'd0) ? 2'd0 : (value[19:12] != 8'd0) ? 2'd1
        : (value[11:4] != 8'd0) ? 2'd2 : 2'd3;
    reg [27:0] value_1, value_2;
    reg signed [9:0] exponent_1, exponent_2;
    reg [2:0] zeros; // of the first octet
    integer place;

    always @(*) begin
        zeros = 3'd0;
        for (place = 0; place < 8; place = place + 1) begin
            if (value_1[20 + place]) begin
                zeros = 3'd7 - place[2:0];
            end
        end
    end

    always @(posedge clock) begin
        case (octets)
            2'd0: value_1 <= whole;
            2'd1: value_1 <= {whole[19:0], 8'd0};
            2'd2: value_1 <= {whole[11:0], 16'd0};
            default: value_1 <= {whole[3:0], 24'd0};
        endcase
        // With the leading one at bit 27 the number is from 2^(exponent + 1 - 127) on
        exponent_1 <= exponent + 10'sd1 - $signed({5'd0, octets, 3'd0});
        value_2 <= value_1 << zeros;
        exponent_2 <= exponent_1 - $signed({7'd0, zeros});
    end

    // ---- A carry out of the fraction raises the exponent
    wire up = value_2[3] && (value_2[4] || (value_2[2:0] != 3'd0));
    reg signed [9:0] exponent_3;
    reg [22:0] fraction_3;
    reg zero_3;

    always @(posedge clock) begin
        {exponent_3, fraction_3} <= {exponent_2, value_2[26:4]} + {32'd0, up};
        zero_3 <= !value_2[27];
    end

    always @(posedge clock) begin
        {done, start_3, start_2, start_1} <= {start_3, start_2, start_1, start};
        if (start_3) begin
            if (zero_3 || (exponent_3 < 10'sd1)) begin
                float_bits <= 32'd0;
            end else if (exponent_3 > 10'sd254) begin
                float_bits <= {negative, LARGEST};
            end else begin
                float_bits <= {negative, exponent_3[7:0], fraction_3};
            end
        end
        if (reset) begin
            {done, start_3, start_2, start_1} <= 4'd0;
        end
    end

endmodule

`default_nettype wire
