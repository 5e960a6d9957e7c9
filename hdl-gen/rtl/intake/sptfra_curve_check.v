// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Check of a curve's segments. None is empty, each slope leads to the next segment's value, and values only rise or
// only fall. It multiplies by two bits of the slope a cycle. From begins to contradicts: 17 cycles; the next
// segment's value is taken in the 12th.

`default_nettype none

module sptfra_curve_check (
    input  wire clock,
    input  wire forget,
    // A segment; its value, slope and shift are there
    input  wire begins,
    input  wire signed [27:0] along, // numbers from its beginning to its end
    input  wire signed [26:0] value,
    input  wire signed [17:0] slope,
    input  wire [5:0] shift,
    input  wire is_last,
    input  wire signed [26:0] last_value, // at the end of the last one
    input  wire value_taken, // value is that of the next segment
    output reg  contradicts
);

    localparam [4:0] SHIFTS = 5'd10, ROUNDS = 5'd11, AIMS = 5'd14, MISSES = 5'd15, JUDGES = 5'd16, ENDS = 5'd17;

    reg [4:0] step; // 0: none under way
    reg [17:0] multiplier;
    reg [45:0] multiplicand;
    reg [45:0] product;
    reg [5:0] shift_held;
    reg negative;
    reg ends_curve;
    reg signed [26:0] from;
    reg signed [26:0] taken;
    reg signed [46:0] rise;
    reg signed [27:0] way;
    reg signed [47:0] missed;
    reg [27:0] tolerance;
    reg rises;
    reg falls;
    wire [46:0] rounded = {1'b0, product} + 47'd1;
    wire signed [46:0] half = {1'b0, rounded[46:1]};
    wire [27:0] distance = way[27] ? -way : way;
    wire signed [47:0] allowed = {20'd0, tolerance};

    always @(posedge clock) begin
        step <= ((step == 5'd0) || (step == ENDS)) ? 5'd0 : step + 5'd1;
        if (value_taken) begin
            taken <= value;
        end
        multiplier <= multiplier >> 2;
        multiplicand <= multiplicand << 2;
        if (step < SHIFTS) begin
            product <= product + (multiplier[0] ? multiplicand : 46'd0)
                + (multiplier[1] ? {multiplicand[44:0], 1'b0} : 46'd0);
        end
        if (step == SHIFTS) begin
            product <= product >> (shift_held - 6'd1);
        end
        if (step == ROUNDS) begin
            rise <= negative ? -half : half;
        end
        if (step == AIMS) begin
            way <= (ends_curve ? {last_value[26], last_value} : {taken[26], taken}) - {from[26], from};
        end
        if (step == MISSES) begin
            missed <= {rise[46], rise} - {{20{way[27]}}, way};
            tolerance <= (distance >> 16) + 28'd1;
            rises <= rises || (way > 28'sd0);
            falls <= falls || way[27];
        end
        if (step == JUDGES) begin
            contradicts <= contradicts || (missed > allowed) || (missed < -allowed) || (rises && falls);
        end
        if (begins) begin
            step <= 5'd1;
            multiplier <= slope[17] ? -slope : slope;
            multiplicand <= {18'd0, along};
            product <= 46'd0;
            shift_held <= shift;
            negative <= slope[17];
            ends_curve <= is_last;
            from <= value;
            contradicts <= contradicts || (along <= 28'sd0);
        end
        if (forget) begin
            step <= 5'd0;
            contradicts <= 1'b0;
            rises <= 1'b0;
            falls <= 1'b0;
        end
    end

    wire _unused = &{1'b0, rounded[0]};

endmodule

`default_nettype wire
