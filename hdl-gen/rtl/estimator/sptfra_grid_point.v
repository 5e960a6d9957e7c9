// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Evaluator of condition 1 at a point of the grid: the sum of max(0, x + y) over all taxels.
//
// Controls act a cycle later, on the terms of that cycle. A tension is in the sum TAXELS + 2 cycles after its terms.
// The top bit of a sum says that it has overflowed, and stays.

`default_nettype none

module sptfra_grid_point #(
    // Taxels a cycle
    parameter integer TAXELS = 1,
    // Bits of x; y has one less
    parameter integer X_BITS = 24,
    // Bits of a sum
    parameter integer VALUE_BITS = 23
) (
    input  wire clock,
    input  wire clear, // a frame begins, or a row
    input  wire nothing, // no taxel is there
    input  wire count, // a tension, or the row above, is taken
    input  wire turn, // the row above
    input  wire [TAXELS*X_BITS-1:0] x,
    input  wire [TAXELS*(X_BITS-1)-1:0] y,
    input  wire [VALUE_BITS:0] above,
    output wire [VALUE_BITS:0] sum
);

    localparam integer ONE_BITS = X_BITS - 1; // of a taxel's tension
    localparam integer TENSION_BITS = ONE_BITS - 1 + TAXELS; // of the taxels of a cycle

    // For each point its own: a tool puts a row's points where there is room, all over a device
    (* keep = "true" *) reg clears;
    (* keep = "true" *) reg is_nothing;
    (* keep = "true" *) reg counts;
    (* keep = "true" *) reg turns;
    wire [TAXELS*ONE_BITS-1:0] tensions;
    wire [TENSION_BITS-1:0] tension; // of all taxels of a cycle; none in a turn
    reg [VALUE_BITS-1:0] total;
    reg over;
    wire [VALUE_BITS:0] next = { {(VALUE_BITS + 1 - TENSION_BITS){1'b0}}, tension}
        + {1'b0, turns ? above[VALUE_BITS-1:0] : total};

    assign sum = {over, total};

    genvar taxel;

    for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_tensions
        wire [X_BITS-1:0] along_x = x[X_BITS*taxel +: X_BITS];
        wire [X_BITS-2:0] along_y = y[(X_BITS-1)*taxel +: X_BITS-1];
        wire [X_BITS:0] stress = {along_x[X_BITS-1], along_x} + { {2{along_y[X_BITS-2]}}, along_y};
        reg presses_1;
        reg [ONE_BITS-1:0] stress_1;
        reg [ONE_BITS-1:0] tension_2;

        wire _unused_stress = &{1'b0, stress[X_BITS-1]}; // of a tension, which is below four powers, 0

        // The sign waits in a register of its own: it resets all bits
        always @(posedge clock) begin
            presses_1 <= stress[X_BITS];
            if (is_nothing) begin
                presses_1 <= 1'b1;
            end
            stress_1 <= stress[ONE_BITS-1:0];
            tension_2 <= stress_1;
            if (presses_1) begin
                tension_2 <= {ONE_BITS{1'b0}};
            end
        end

        assign tensions[ONE_BITS*taxel +: ONE_BITS] = tension_2;
    end
    if (TAXELS == 1) begin : gen_one
        assign tension = tensions;
    end else begin : gen_both
        reg [TENSION_BITS-1:0] both_3;

        always @(posedge clock) begin
            both_3 <= {1'b0, tensions[0 +: ONE_BITS]} + {1'b0, tensions[(TAXELS-1)*ONE_BITS +: ONE_BITS]};
        end

        assign tension = both_3;
    end

    always @(posedge clock) begin
        clears <= clear;
        is_nothing <= nothing;
        counts <= count;
        turns <= turn;
        if (clears) begin
            total <= {VALUE_BITS{1'b0}};
            over <= 1'b0;
        end else if (counts) begin
            total <= next[VALUE_BITS-1:0];
            over <= next[VALUE_BITS] || (turns ? above[VALUE_BITS] : over);
        end
    end

endmodule

`default_nettype wire
