// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Unsigned restoring divider: quotient (64 bits) = numerator (64 bits) / denominator (48 bits), rounded down.
//
// One quotient bit a cycle. A start in cycle 0 gives done for one cycle in cycle 65. A new start is taken from then
// on. A denominator of zero gives all ones.

`default_nettype none

module sptfra_divider (
    input  wire clock,               // rising edge
    input  wire reset,               // synchronous, high: gives up the division under way
    input  wire start,               // takes the operands; ignored while a division is under way
    input  wire [63:0] numerator,    // dividend
    input  wire [47:0] denominator,  // divisor
    output wire [63:0] quotient,     // valid from done until the next start
    output wire done                 // high for one cycle, 65 cycles after start
);

    reg busy;
    reg finished;
    reg [5:0] left;
    reg [63:0] digits;
    reg [47:0] remainder;
    reg [47:0] divisor;

    // bring the next digit down, try to subtract: bit 49 of the difference is the borrow
    wire [49:0] shifted = ({2'd0, remainder} << 1) | {49'd0, digits[63]};
    wire [49:0] trial = shifted - {2'd0, divisor};
    wire fits = !trial[49];

    always @(posedge clock) begin
        finished <= 1'b0;

        // the numerator leaves its register at the top while the quotient enters at the bottom
        if (busy) begin
            digits <= (digits << 1) | {63'd0, fits};
            if (fits) begin
                remainder <= trial[47:0];
            end else begin
                remainder <= shifted[47:0];
            end
            left <= left - 6'd1;
            if (left == 6'd0) begin
                busy <= 1'b0;
                finished <= 1'b1;
            end
        end else if (start) begin
            digits <= numerator;
            divisor <= denominator;
            remainder <= 48'd0;
            left <= 6'd63;
            busy <= 1'b1;
        end

        // reset ends what is under way
        if (reset) begin
            busy <= 1'b0;
            finished <= 1'b0;
        end
    end

    assign quotient = digits;
    assign done = finished;

    // Bits left unread on purpose.
    wire _unused = &{1'b0, trial};

endmodule

`default_nettype wire
