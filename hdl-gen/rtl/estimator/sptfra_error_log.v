// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Logarithm of the remaining error, base 2: a weighted sum over the hidden units, within its range.
//
// Throughput: a unit a cycle. Latency from the last unit: six cycles.

`default_nettype none

module sptfra_error_log #(
    // Bits dropped from the sum; negative: added
    parameter integer SHIFT = 12,
    // What is added to it then, 12 fraction bits
    parameter signed [17:0] BASE = 18'sd0
) (
    input  wire clock,
    input  wire reset,
    input  wire valid,
    input  wire first, // of the units
    input  wire signed [17:0] weight,
    input  wire signed [26:0] unit, // half the sum over its mirror images
    output reg  signed [17:0] error_log // from -10 to 2, 12 fraction bits
);

    localparam integer RIGHT = (SHIFT > 0) ? SHIFT : 0;
    localparam integer LEFT = (SHIFT < 0) ? -SHIFT : 0;
    localparam signed [63:0] HALF = (RIGHT == 0) ? 64'sd0 : 64'sd1 <<< (RIGHT - 1);
    localparam signed [63:0] LEAST = -64'sd40960; // -10
    localparam signed [63:0] MOST = 64'sd8191; // just below 2
    localparam signed [63:0] WIDE_BASE = { {46{BASE[17]}}, BASE};

    wire signed [47:0] sum;
    wire signed [63:0] wide = { {16{sum[47]}}, sum};
    reg signed [63:0] exact;

    sptfra_mac weigh (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (weight),
        .data        (unit),
        .accumulator (sum)
    );

    always @(posedge clock) begin
        exact <= (((wide + HALF) >>> RIGHT) <<< LEFT) + WIDE_BASE;
        error_log <= (exact > MOST) ? MOST[17:0] : (exact < LEAST) ? LEAST[17:0] : exact[17:0];
    end

endmodule

`default_nettype wire
