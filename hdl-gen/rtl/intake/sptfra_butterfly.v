// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Butterfly of four numbers: their sums and differences by parity.
//
//     0: a + b + c + d    1: a - b + c - d    2: a + b - c - d    3: a - b - c + d
//
// Folds the taxels of an orbit into parity components, and unfolds the components into four times the taxels.
//
// Latency: two enabled cycles.

`default_nettype none

module sptfra_butterfly #(
    // Bits of a number
    parameter WIDTH = 27,
    // Added to each result, for its rounding
    parameter signed [WIDTH+1:0] HALF = 0
) (
    input  wire clock,
    input  wire enable,
    input  wire [4*WIDTH-1:0] values, // a in the lowest bits
    output wire [4*WIDTH+7:0] sums
);

    wire signed [WIDTH-1:0] a = values[WIDTH*0 +: WIDTH];
    wire signed [WIDTH-1:0] b = values[WIDTH*1 +: WIDTH];
    wire signed [WIDTH-1:0] c = values[WIDTH*2 +: WIDTH];
    wire signed [WIDTH-1:0] d = values[WIDTH*3 +: WIDTH];
    reg signed [WIDTH:0] even_ab;
    reg signed [WIDTH:0] odd_ab;
    reg signed [WIDTH:0] even_cd;
    reg signed [WIDTH:0] odd_cd;
    reg signed [WIDTH+1:0] sum_0;
    reg signed [WIDTH+1:0] sum_1;
    reg signed [WIDTH+1:0] sum_2;
    reg signed [WIDTH+1:0] sum_3;

    always @(posedge clock) begin
        if (enable) begin
            even_ab <= {a[WIDTH-1], a} + {b[WIDTH-1], b};
            odd_ab <= {a[WIDTH-1], a} - {b[WIDTH-1], b};
            even_cd <= {c[WIDTH-1], c} + {d[WIDTH-1], d};
            odd_cd <= {c[WIDTH-1], c} - {d[WIDTH-1], d};
            sum_0 <= {even_ab[WIDTH], even_ab} + {even_cd[WIDTH], even_cd} + HALF;
            sum_1 <= {odd_ab[WIDTH], odd_ab} + {odd_cd[WIDTH], odd_cd} + HALF;
            sum_2 <= {even_ab[WIDTH], even_ab} - {even_cd[WIDTH], even_cd} + HALF;
            sum_3 <= {odd_ab[WIDTH], odd_ab} - {odd_cd[WIDTH], odd_cd} + HALF;
        end
    end

    assign sums = {sum_3, sum_2, sum_1, sum_0};

endmodule

`default_nettype wire
