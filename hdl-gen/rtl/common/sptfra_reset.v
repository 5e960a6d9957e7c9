// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Reset register of a core: delays the reset by one cycle. Set at power-up.
//
// The streams do not wait for it: they see the reset itself.

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
