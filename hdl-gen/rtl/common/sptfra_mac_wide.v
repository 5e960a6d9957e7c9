// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane of two DSP blocks of 27 by 18 bits: sums coefficient * data / 2^17, each product rounded to
// the nearest integer, ties upwards.
//
// The data's lower 17 bits and its upper 18 are multiplied side by side; a DSP48E2 takes the former's product, shifted
// by 17, from the block below. Rounded, not cut: cut bits would add up to a bias. Latency 3 cycles (operands, products,
// accumulator), one product a cycle. The accumulator wraps; what it sums is bounded by the plan.

`default_nettype none

module sptfra_mac_wide (
    input  wire clock,                      // rising edge
    input  wire reset,                      // synchronous, high: discards products under way, keeps the accumulator
    input  wire valid,                      // the operands count
    input  wire first,                      // with valid: start a new sum with this product
    input  wire signed [26:0] coefficient,  // left operand
    input  wire signed [34:0] data,         // right operand
    output wire signed [47:0] accumulator   // the sum, three cycles after the operands; holds without valid ones
);

    localparam signed [44:0] HALF = 45'sd65536; // of what is dropped

    reg valid_a;
    reg first_a;
    reg signed [26:0] coefficient_a;
    reg signed [34:0] data_a;
    reg valid_m;
    reg first_m;
    reg signed [44:0] low;
    reg signed [44:0] high;
    reg signed [47:0] sum;

    wire signed [17:0] data_low = {1'b0, data_a[16:0]};
    wire signed [17:0] data_high = data_a[34:17];

    // operands
    always @(posedge clock) begin
        valid_a <= valid && !reset;
        first_a <= first;
        coefficient_a <= coefficient;
        data_a <= data;
    end

    // products
    always @(posedge clock) begin
        valid_m <= valid_a && !reset;
        first_m <= first_a;
        low <= coefficient_a * data_low + HALF;
        high <= coefficient_a * data_high;
    end

    // sum
    wire signed [47:0] base = sum & {48{!first_m}};
    wire signed [47:0] addend = $signed({{3{high[44]}}, high}) + $signed({{20{low[44]}}, low[44:17]});

    always @(posedge clock) begin
        if (valid_m) begin
            sum <= base + addend;
        end
    end

    assign accumulator = sum;

    wire _unused = &{1'b0, low[16:0]};

endmodule

`default_nettype wire
