// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Assertion for simulations: done follows start by CYCLES cycles. A violation stops the simulation.

`default_nettype none

module sptfra_check_delay #(
    // Cycles from start to done; 0: any
    parameter integer CYCLES = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire done
);

`ifdef SIMULATION
    localparam integer STAGES = (CYCLES > 0) ? CYCLES : 1;
    reg [STAGES-1:0] starts;
    wire [STAGES:0] next_starts = {starts, start};

    always @(posedge clock) begin
        starts <= next_starts[STAGES-1:0];
        if (!reset && (CYCLES != 0) && (done != starts[STAGES-1])) begin
            $fdisplay(32'h80000002, "%m: done is not start, %0d cycles later", CYCLES);
            $fatal(1);
        end
        if (reset) begin
            starts <= {STAGES{1'b0}};
        end
    end

    wire _unused = next_starts[STAGES];
`else
    wire _unused = &{1'b0, clock, reset, start, done, CYCLES != 0};
`endif

endmodule

`default_nettype wire
