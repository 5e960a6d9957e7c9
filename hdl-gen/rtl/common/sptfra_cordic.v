// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Vectoring CORDIC: magnitude (34 bits) and angle (32 bits) of (x, y), components within +-2^30.
//
// 30 micro-rotations, two cycles each. A start in cycle 0 gives done for one cycle in cycle 62. A new start is taken
// from then on. The angle is atan2(y, x) in radians with 29 fraction bits. The magnitude is the length
// times 1.6467602581210654 (the CORDIC gain), in units of x and y. For max(|x|, |y|) >= 2^29 the angle is within
// 2^-26 rad and the magnitude within 2^-26 of itself; (0, 0) gives zeros.

`default_nettype none

module sptfra_cordic (
    input  wire clock,                // rising edge
    input  wire reset,                // synchronous, high: gives up the conversion under way
    input  wire start,                // takes the operands; ignored while a conversion is under way
    input  wire signed [31:0] x,      // component along angle 0
    input  wire signed [31:0] y,      // component along angle pi/2
    output wire [33:0] magnitude,     // valid from done until the next done
    output wire signed [31:0] angle,  // valid from done until the next done
    output wire done                  // high for one cycle, 62 cycles after start
);

    localparam signed [36:0] QUARTER_TURN = 37'sh6487ed511;

    reg rotating;
    reg shifted;
    reg rounding;
    reg finished;
    reg [4:0] iteration;
    reg origin;
    reg signed [38:0] along;
    reg signed [38:0] across;
    reg signed [36:0] turned;
    reg signed [38:0] along_part;
    reg signed [38:0] across_part;
    reg signed [36:0] arc_tangent;
    reg [33:0] magnitude_out;
    reg signed [31:0] angle_out;

    // a micro-rotation, first cycle: the angle and the part of each component that moves to the other
    always @(posedge clock) begin
        along_part <= along >>> iteration;
        across_part <= across >>> iteration;
        case (iteration)
            5'd0: arc_tangent <= 37'sh3243f6a89;
            5'd1: arc_tangent <= 37'sh1dac67056;
            5'd2: arc_tangent <= 37'shfadbafc9;
            5'd3: arc_tangent <= 37'sh7f56ea6b;
            5'd4: arc_tangent <= 37'sh3feab76e;
            5'd5: arc_tangent <= 37'sh1ffd55bc;
            5'd6: arc_tangent <= 37'shfffaaae;
            5'd7: arc_tangent <= 37'sh7fff555;
            5'd8: arc_tangent <= 37'sh3fffeab;
            5'd9: arc_tangent <= 37'sh1ffffd5;
            5'd10: arc_tangent <= 37'shfffffb;
            5'd11: arc_tangent <= 37'sh7fffff;
            5'd12: arc_tangent <= 37'sh400000;
            5'd13: arc_tangent <= 37'sh200000;
            5'd14: arc_tangent <= 37'sh100000;
            5'd15: arc_tangent <= 37'sh80000;
            5'd16: arc_tangent <= 37'sh40000;
            5'd17: arc_tangent <= 37'sh20000;
            5'd18: arc_tangent <= 37'sh10000;
            5'd19: arc_tangent <= 37'sh8000;
            5'd20: arc_tangent <= 37'sh4000;
            5'd21: arc_tangent <= 37'sh2000;
            5'd22: arc_tangent <= 37'sh1000;
            5'd23: arc_tangent <= 37'sh800;
            5'd24: arc_tangent <= 37'sh400;
            5'd25: arc_tangent <= 37'sd512;
            5'd26: arc_tangent <= 37'sd256;
            5'd27: arc_tangent <= 37'sd128;
            5'd28: arc_tangent <= 37'sd64;
            default: arc_tangent <= 37'sd32;
        endcase
    end

    // components with guard bits
    wire signed [38:0] x_wide = $signed({{7{x[31]}}, x}) << 5;
    wire signed [38:0] y_wide = $signed({{7{y[31]}}, y}) << 5;

    // round the guard bits away
    wire signed [38:0] along_rounded = along + 39'sd16;
    wire signed [36:0] turned_rounded = turned + 37'sd16;
    wire [38:0] along_bits = $unsigned(along_rounded);
    wire [36:0] turned_bits = $unsigned(turned_rounded);
    wire [31:0] angle_bits = turned_bits[36:5];

    always @(posedge clock) begin
        if (rounding) begin
            magnitude_out <= along_bits[38:5];
            angle_out <= $signed(angle_bits);
            if (origin) begin
                angle_out <= 32'sd0;
            end
        end
    end

    always @(posedge clock) begin
        shifted <= rotating && !shifted;
        rounding <= 1'b0;
        finished <= rounding;

        // a micro-rotation, second cycle: towards angle 0
        // at the start a vector in the left half plane turns by a quarter: the rest reaches 1.74 rad
        if (rotating && shifted) begin
            if (across[38]) begin
                along <= along - across_part;
                across <= across + along_part;
                turned <= turned - arc_tangent;
            end else begin
                along <= along + across_part;
                across <= across - along_part;
                turned <= turned + arc_tangent;
            end
            iteration <= iteration + 5'd1;
            if (iteration == 5'd29) begin
                rotating <= 1'b0;
                rounding <= 1'b1;
            end
        end else if ((start && !rotating) && !rounding) begin
            if (!x[31]) begin
                along <= x_wide;
                across <= y_wide;
                turned <= 37'sd0;
            end else if (!y[31]) begin
                along <= y_wide;
                across <= -x_wide;
                turned <= QUARTER_TURN;
            end else begin
                along <= -y_wide;
                across <= x_wide;
                turned <= -QUARTER_TURN;
            end
            origin <= (x == 32'sd0) && (y == 32'sd0);
            iteration <= 5'd0;
            rotating <= 1'b1;
        end

        // reset ends what is under way
        if (reset) begin
            rotating <= 1'b0;
            rounding <= 1'b0;
            finished <= 1'b0;
        end
    end

    assign magnitude = magnitude_out;
    assign angle = angle_out;
    assign done = finished;

    // Bits left unread on purpose.
    wire _unused = &{1'b0, along_bits, turned_bits};

endmodule

`default_nettype wire
