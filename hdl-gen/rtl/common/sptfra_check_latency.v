// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A check that only simulations make: done comes CYCLES after start. Stops the simulation if it does not.

`default_nettype none

module sptfra_check_latency #(
    // Cycles from start to done; 0: any
    parameter integer CYCLES = 0,
    // 1: a start may come in any cycle, and done is low where none was; 0: the first done behind the last start counts
    parameter integer PIPELINED = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire done
);

`ifdef SIMULATION
    localparam integer STAGES = ((PIPELINED != 0) && (CYCLES > 0)) ? CYCLES : 1;
    integer count;
    reg running;
    reg [STAGES-1:0] starts;
    wire [STAGES:0] next_starts = {starts, start};
    wire wrong = (PIPELINED != 0) ? (done != starts[STAGES-1]) : (running && done && (count != CYCLES));

    always @(posedge clock) begin
        count <= start ? 1 : count + 1;
        running <= (running && !done) || start;
        starts <= next_starts[STAGES-1:0];
        if (!reset && (CYCLES != 0) && wrong) begin
            if (PIPELINED != 0) begin
                $fdisplay(32'h80000002, "%m: done is not start, %0d cycles later", CYCLES);
            end else begin
                $fdisplay(32'h80000002, "%m: %0d cycles from start to done, expected %0d", count, CYCLES);
            end
            $fatal(1);
        end
        if (reset) begin
            running <= 1'b0;
            starts <= {STAGES{1'b0}};
        end
    end

    wire _unused = next_starts[STAGES];
`else
    wire _unused = &{1'b0, clock, reset, start, done, CYCLES != 0, PIPELINED != 0};
`endif

endmodule

`default_nettype wire
