// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Multiply-accumulate lane of a PE, with the carry of a row that is cut in two.
//
// Coefficients of up to 18 and operands of up to 27 bits take one multiplier. Wider ones take two, and sum products
// over 2^17, rounded. There coefficients and friction components are left-aligned, so that short ones lose little or
// nothing. Operands to row sum: 3 cycles. Initiation interval: 1.

`default_nettype none

module sptfra_spmv_lane #(
    // Bits of a coefficient, at most 27, and of an operand, at most 35
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
    input  wire tail_ends, // it is the carry for the PE before
    input  wire is_head, // the next PE's carry completes it
    input  wire [47:0] next_carry,
    output reg  [47:0] carry,
    output wire [47:0] row_sum
);

    if ((COEFFICIENT_BITS > 27) || (DATA_BITS > 35)) begin : gen_check_factors
        sptfra_error_two_multipliers_have_27_by_35_bits invalid ();
    end

    localparam WIDE = (COEFFICIENT_BITS > 18) || (DATA_BITS > 27);
    localparam LEFT_BITS = WIDE ? 27 : 18;
    localparam RIGHT_BITS = WIDE ? 35 : 27;
    // Where in the left operand the last bit of a coefficient stands, and of a friction component
    localparam COEFFICIENT_PLACE = !WIDE ? 0 : (COEFFICIENT_BITS < 10) ? 17 : 27 - COEFFICIENT_BITS;
    localparam FRICTION_PLACE = WIDE ? 9 : 0;
    localparam signed [17:0] ONE = 18'sd65536; // friction has 16 fraction bits

    // ---- To the multipliers' widths
    wire signed [LEFT_BITS-1:0] own;
    wire signed [LEFT_BITS-1:0] component;
    wire signed [LEFT_BITS-1:0] left = ((FRICTION != 0) && friction) ? component : own;
    wire signed [RIGHT_BITS-1:0] right;
    reg  signed [17:0] chosen;
    wire [47:0] accumulator;
    genvar place;
    for (place = 0; place < LEFT_BITS; place = place + 1) begin : gen_left
        localparam OF_COEFFICIENT = place - COEFFICIENT_PLACE;

        if (OF_COEFFICIENT < 0) begin : gen_below
            assign own[place] = 1'b0;
        end else begin : gen_own
            assign own[place] = coefficient[(OF_COEFFICIENT < COEFFICIENT_BITS) ? OF_COEFFICIENT
                : COEFFICIENT_BITS - 1];
        end
        if (place < FRICTION_PLACE) begin : gen_below_component
            assign component[place] = 1'b0;
        end else begin : gen_component
            assign component[place] = chosen[place-FRICTION_PLACE];
        end
    end
    for (place = 0; place < RIGHT_BITS; place = place + 1) begin : gen_right
        assign right[place] = operand[(place < DATA_BITS) ? place : DATA_BITS - 1];
    end

    always @(*) begin
        case (coefficient[1:0])
            2'd0: chosen = ONE;
            2'd1: chosen = mu_x;
            default: chosen = mu_y;
        endcase
    end

    sptfra_mac #(
        .WIDE (WIDE)
    ) mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (left),
        .data        (right),
        .accumulator (accumulator)
    );

    // ---- Sums
    assign row_sum = accumulator + (next_carry & {48{is_head}});

    always @(posedge clock) begin
        if (tail_ends) begin
            carry <= accumulator;
        end
    end

endmodule

`default_nettype wire
