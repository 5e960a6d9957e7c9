// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One way of a lane: multiply-accumulate, the carry of a row that is cut in two, and two places for finished sums.
//
// Operands to accumulator: 3 cycles; accumulator to result: 1. Initiation interval: 1.

`default_nettype none

module sptfra_spmv_way #(
    // Bits of a coefficient, at most 18, and of an operand, at most 27
    parameter COEFFICIENT_BITS = 18,
    parameter DATA_BITS = 27,
    // Whether friction components take the coefficients' place in some products
    parameter FRICTION = 1
) (
    input  wire clock,
    input  wire reset,
    // Operands
    input  wire valid,
    input  wire first, // of a row segment
    input  wire [COEFFICIENT_BITS-1:0] coefficient,
    input  wire [DATA_BITS-1:0] operand,
    input  wire friction, // the coefficient is a code: 0 stands for one, 1 for mu_x, 2 for mu_y
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // With the accumulated sum
    input  wire tail_ends, // it is the carry of the lane before
    input  wire result_ends, // it is a result
    input  wire is_head, // which the next lane's carry completes
    input  wire no_other, // no result waits, or the only one is being taken
    input  wire take,
    input  wire [47:0] next_carry,
    output reg  [47:0] carry,
    output reg  [47:0] result
);

    generate
        if ((COEFFICIENT_BITS > 18) || (DATA_BITS > 27)) begin : gen_check_factors
            sptfra_error_a_multiplier_has_18_by_27_bits invalid ();
        end
    endgenerate

    localparam signed [17:0] ONE = 18'sd65536; // friction has 16 fraction bits

    // ---- Sign extension to the multiplier's widths
    wire signed [17:0] own;
    wire signed [26:0] data;
    reg  signed [17:0] multiplier;
    wire [47:0] accumulator;
    genvar place;
    generate
        for (place = 0; place < 18; place = place + 1) begin : gen_coefficient
            assign own[place] = coefficient[(place < COEFFICIENT_BITS) ? place : COEFFICIENT_BITS - 1];
        end
        for (place = 0; place < 27; place = place + 1) begin : gen_operand
            assign data[place] = operand[(place < DATA_BITS) ? place : DATA_BITS - 1];
        end
    endgenerate

    always @(*) begin
        multiplier = own;
        if ((FRICTION != 0) && friction) begin
            case (coefficient[1:0])
                2'd0: multiplier = ONE;
                2'd1: multiplier = mu_x;
                default: multiplier = mu_y;
            endcase
        end
    end

    sptfra_mac mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (multiplier),
        .data        (data),
        .accumulator (accumulator)
    );

    // ---- Sums
    wire [47:0] row_sum = accumulator + (next_carry & {48{is_head}});
    reg [47:0] second_result;

    always @(posedge clock) begin
        if (tail_ends) begin
            carry <= accumulator;
        end
        if (take) begin
            result <= second_result;
        end
        if (result_ends && no_other) begin
            result <= row_sum;
        end
        if (result_ends) begin
            second_result <= row_sum;
        end
    end

endmodule

`default_nettype wire
