// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The DSP48E2 as Yosys uses it on UltraScale+: a multiplier without registers. Yosys' own cells have no model of it.
//
// Whatever a netlist asks for that is not described here makes the result unknown, so that it cannot go unnoticed.
module DSP48E2 #(
    parameter integer ACASCREG = 1,
    parameter integer ADREG = 1,
    parameter integer ALUMODEREG = 1,
    parameter AMULTSEL = "A",
    parameter integer AREG = 1,
    parameter A_INPUT = "DIRECT",
    parameter integer BCASCREG = 1,
    parameter BMULTSEL = "B",
    parameter integer BREG = 1,
    parameter B_INPUT = "DIRECT",
    parameter integer CARRYINREG = 1,
    parameter integer CARRYINSELREG = 1,
    parameter integer CREG = 1,
    parameter integer DREG = 1,
    parameter integer INMODEREG = 1,
    parameter integer MREG = 1,
    parameter integer OPMODEREG = 1,
    parameter integer PREG = 1,
    parameter USE_MULT = "MULTIPLY",
    parameter USE_SIMD = "ONE48"
) (
    input  wire [29:0] A,
    input  wire [29:0] ACIN,
    input  wire [3:0] ALUMODE,
    input  wire [17:0] B,
    input  wire [17:0] BCIN,
    input  wire [47:0] C,
    input  wire CARRYIN,
    input  wire [2:0] CARRYINSEL,
    input  wire [26:0] D,
    input  wire [4:0] INMODE,
    input  wire [8:0] OPMODE,
    input  wire [47:0] PCIN,
    output wire [47:0] P
);

    wire combinational = (AREG + BREG + CREG + DREG + ADREG + MREG + PREG + INMODEREG + OPMODEREG + ALUMODEREG
        + CARRYINREG + CARRYINSELREG) == 0;
    wire plain = (AMULTSEL == "A") && (BMULTSEL == "B") && (A_INPUT == "DIRECT") && (B_INPUT == "DIRECT")
        && (USE_MULT == "MULTIPLY") && (USE_SIMD == "ONE48");
    wire product_only = (OPMODE == 9'h005) && (ALUMODE == 4'h0) && (INMODE == 5'h00) && (CARRYIN == 1'b0)
        && (CARRYINSEL == 3'h0);
    wire signed [26:0] a = A[26:0];
    wire signed [17:0] b = B;
    wire signed [47:0] product = a * b;

    assign P = (combinational && plain && product_only) ? product : 48'hx;

endmodule
