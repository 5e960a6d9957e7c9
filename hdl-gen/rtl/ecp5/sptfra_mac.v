// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane: sums coefficient * data with two multipliers of 18 by 18 bits, for Lattice ECP5. Other
// fabrics have an sptfra_mac with one of 27 by 18, with the same sums in the same cycles.
//
// Latency 3 cycles (operands, two products, accumulator), one product a cycle. Operands of 18 and 27 bits and the
// accumulator of 48 are two's complement integers; the binary point is the user's. The accumulator wraps; a sum of up
// to 15 products, and any sum whose coefficients add up to less than 2^21 in magnitude, never does.

`default_nettype none

module sptfra_mac (
    input  wire clock,                      // rising edge
    input  wire reset,                      // synchronous, high: discards products under way, keeps the accumulator
    input  wire valid,                      // the operands count
    input  wire first,                      // with valid: start a new sum with this product
    input  wire signed [17:0] coefficient,  // left operand
    input  wire signed [26:0] data,         // right operand
    output wire signed [47:0] accumulator   // the sum, three cycles after the operands; holds without valid ones
);

    reg valid_a;
    reg first_a;
    reg signed [17:0] coefficient_a;
    reg signed [26:0] data_a;
    reg valid_m;
    reg first_m;
    reg signed [35:0] low;
    reg signed [27:0] high;
    reg signed [47:0] sum;

    reg signed [47:0] base;

    // operands
    always @(posedge clock) begin
        valid_a <= valid && !reset;
        first_a <= first;
        coefficient_a <= coefficient;
        data_a <= data;
    end

    // products with the lower 17 bits of the data and with the upper 10
    wire [26:0] data_bits = $unsigned(data_a);
    wire [17:0] lower = {1'b0, data_bits[16:0]};
    wire [9:0] upper = data_bits[26:17];
    wire signed [17:0] data_low = $signed(lower);
    wire signed [9:0] data_high = $signed(upper);

    always @(posedge clock) begin
        valid_m <= valid_a && !reset;
        first_m <= first_a;
        low <= coefficient_a * data_low;
        high <= coefficient_a * data_high;
    end

    // sum of three: no adder stands between the products and the accumulator's
    wire signed [47:0] addend_low = $signed({{12{low[35]}}, low});
    wire signed [47:0] high_wide = $signed({{20{high[27]}}, high});
    wire signed [47:0] addend_high = high_wide << 17;

    always @(*) begin
        base = sum;
        if (first_m) begin
            base = 48'sd0;
        end
    end

    always @(posedge clock) begin
        if (valid_m) begin
            sum <= (base + addend_low) + addend_high;
        end
    end

    assign accumulator = sum;

endmodule

`default_nettype wire
