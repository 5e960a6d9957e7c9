// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A check that only simulations make: from start to done it takes CYCLES. Stops the simulation if it does not.

`default_nettype none

module sptfra_check_latency #(
    // Cycles from start to done; 0: any
    parameter integer CYCLES = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire done
);

`ifdef SIMULATION
    integer count;
    reg running;

    always @(posedge clock) begin
        count <= start ? 1 : count + 1;
        running <= (running && !done) || start;
        if (running && done && !reset && (CYCLES != 0) && (count != CYCLES)) begin
            $fdisplay(32'h80000002, "%m: %0d cycles from start to done, expected %0d", count, CYCLES);
            $fatal(1);
        end
        if (reset) begin
            running <= 1'b0;
        end
    end
`else
    wire _unused = &{1'b0, clock, reset, start, done, CYCLES != 0};
`endif

endmodule

`default_nettype wire
