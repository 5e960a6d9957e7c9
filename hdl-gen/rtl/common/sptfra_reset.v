// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The register that resets all of a core but its streams, which stop at once: one cycle later, for as many cycles. It
// resets from power-up on, too.

`default_nettype none

module sptfra_reset (
    input  wire clock,
    input  wire now,
    output wire reset
);

    reg later;

    initial begin
        later = 1'b1;
    end

    always @(posedge clock) begin
        later <= now;
    end

    assign reset = later;

endmodule

`default_nettype wire
