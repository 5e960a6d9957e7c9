// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane: sums coefficient * data with two multipliers of 18 by 18 bits, for Lattice ECP5. Other
// fabrics have an sptfra_mac with one of 27 by 18, with the same sums in the same cycles.
//
// Latency 3 cycles (operands, two products, accumulator), one product a cycle. All are two's complement integers. The
// accumulator wraps, which up to 15 products never make it do.

`default_nettype none

module sptfra_mac #(
    // Must be 0: a wide lane would take four multipliers
    parameter WIDE = 0,
    // Derived
    parameter COEFFICIENT_BITS = 18,
    parameter DATA_BITS = 27
) (
    input  wire clock,
    input  wire reset, // discards products under way, keeps the accumulator
    input  wire valid, // the operands count
    input  wire first, // with valid: start a new sum with this product
    input  wire signed [COEFFICIENT_BITS-1:0] coefficient,
    input  wire signed [DATA_BITS-1:0] data,
    output wire signed [47:0] accumulator // the sum, three cycles after the operands; holds without valid ones
);

    if (WIDE) begin : gen_check_wide
        sptfra_error_ecp5_has_no_wide_mac invalid ();
    end

    reg valid_a;
    reg first_a;
    reg signed [17:0] coefficient_a;
    reg signed [26:0] data_a;
    reg valid_m;
    reg first_m;
    reg signed [35:0] low;
    reg signed [27:0] high;
    reg signed [47:0] sum;
    wire signed [17:0] data_low = {1'b0, data_a[16:0]};
    wire signed [9:0] data_high = data_a[26:17];
    wire signed [47:0] addend_low = {{12{low[35]}}, low};
    wire signed [47:0] addend_high = {{3{high[27]}}, high, 17'd0};

    assign accumulator = sum;

    always @(posedge clock) begin
        valid_a <= valid && !reset;
        first_a <= first;
        coefficient_a <= coefficient;
        data_a <= data;
        valid_m <= valid_a && !reset;
        first_m <= first_a;
        low <= coefficient_a * data_low;
        high <= coefficient_a * data_high;
        // A sum of three: no adder stands between the products and the accumulator's
        if (valid_m) begin
            sum <= ((first_m ? 48'sd0 : sum) + addend_low) + addend_high;
        end
    end

endmodule

`default_nettype wire
