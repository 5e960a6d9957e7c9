// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// float32, an operation at a time: sum, difference, product, quotient, root, and the angle of (a, b) in radians.
//
// Results are rounded to nearest even. There are no denormals, infinities and NaN: a denormal is 0, in and out; what
// is larger than the largest finite number is that, with its sign; x / 0 and the root of what is below 0 are 0; an
// operand with all bits of the exponent set is the number that it would be if that exponent were as any other. A zero
// is positive. The angle is within 2^-24 rad (sptfra_cordic), 0 for (0, 0).
//
// From start to done, one cycle: 9 cycles for a sum, difference or product, 33 for a quotient, 32 for a root, 73 for
// an angle, 2 for the comparison.

`default_nettype none

module sptfra_float_unit (
    input  wire clock,
    input  wire reset,              // gives up what is under way
    input  wire start,              // takes operands and operation; not before the last one is done
    input  wire [2:0] operation,    // 0: a + b, 1: a - b, 2: a * b, 3: a / b, 4: root of a, 5: angle, else |a| < |b|
    input  wire [31:0] a,
    input  wire [31:0] b,
    output wire done,
    output wire [31:0] result,      // from done until the next
    output reg  below               // |a| < |b|: from done until the next start
);

    localparam [2:0] SUBTRACT = 3'd1, MULTIPLY = 3'd2, DIVIDE = 3'd3, ROOT = 3'd4, ANGLE = 3'd5;

    // ---- Operands; denormals are zero
    reg [2:0] operation_1; // held
    reg [31:0] a_1; // held, too
    reg [31:0] b_1;
    reg a_zero;
    reg b_zero;
    reg [4:1] stage; // cycles since the start
    wire [23:0] significand_a = a_zero ? 24'd0 : {1'b1, a_1[22:0]};
    wire [23:0] significand_b = b_zero ? 24'd0 : {1'b1, b_1[22:0]};
    wire compare = (operation_1 > ANGLE);
    wire by_digits = (operation_1 == DIVIDE) || (operation_1 == ROOT);

    always @(posedge clock) begin
        stage <= {stage[3:1], start};
        if (start) begin
            operation_1 <= operation;
            a_1 <= a;
            b_1 <= {b[31] ^ (operation == SUBTRACT), b[30:0]};
            a_zero <= (a[30:23] == 8'd0);
            b_zero <= (b[30:23] == 8'd0);
        end
        if (reset) begin
            stage <= 4'd0;
        end
    end

    // ---- Which one is larger, and how far the other one goes right; the exponent of the result
    wire a_below = (a_1[30:0] < b_1[30:0]) && !b_zero;
    wire [8:0] exponent_a = {1'b0, a_1[30:23]};
    wire [8:0] exponent_b = {1'b0, b_1[30:23]};
    wire [8:0] behind = exponent_b - exponent_a;
    wire [8:0] ahead = exponent_a - exponent_b;
    reg [23:0] large_2;
    reg [23:0] small_2;
    reg [7:0] distance_2;
    reg signed [9:0] exponent_2;
    reg signed [9:0] exponent_3;
    reg nothing; // the result is zero, whatever comes out
    reg negative;

    always @(posedge clock) begin
        if (stage[1]) begin
            below <= a_below;
            large_2 <= a_below ? significand_b : significand_a;
            small_2 <= a_below ? significand_a : significand_b;
            distance_2 <= a_below ? behind[7:0] : ahead[7:0];
            nothing <= ((operation_1 == DIVIDE) && b_zero) || ((operation_1 == ROOT) && (a_1[31] || a_zero));
            case (operation_1)
                MULTIPLY: exponent_2 <= {1'b0, exponent_a} + {1'b0, exponent_b};
                DIVIDE: exponent_2 <= {1'b0, exponent_a} - {1'b0, exponent_b};
                ROOT: exponent_2 <= {1'b0, exponent_a} + 10'd127;
                ANGLE: exponent_2 <= 10'sd127;
                default: exponent_2 <= a_below ? {1'b0, exponent_b} : {1'b0, exponent_a};
            endcase
        end
        if (stage[2]) begin
            case (operation_1)
                MULTIPLY: exponent_3 <= exponent_2 - 10'sd127;
                DIVIDE: exponent_3 <= exponent_2 + 10'sd127;
                ROOT: exponent_3 <= exponent_2 >>> 1;
                default: exponent_3 <= exponent_2;
            endcase
        end
    end

    // ---- The smaller one behind the larger one, with two bits more and one for all that is lost
    wire [26:0] small_wide = {small_2, 3'd0};
    reg [26:0] octets_3;
    reg lost_3;
    reg [2:0] distance_3;
    reg [26:0] aligned_4;
    wire [33:0] bits_3 = {octets_3, 7'd0} >> distance_3;

    always @(posedge clock) begin
        distance_3 <= distance_2[2:0];
        if (distance_2[7:5] != 3'd0) begin
            octets_3 <= 27'd0;
            lost_3 <= (small_2 != 24'd0);
        end else begin
            case (distance_2[4:3])
                2'd0: {octets_3, lost_3} <= {small_wide, 1'b0};
                2'd1: {octets_3, lost_3} <= {8'd0, small_wide[26:8], small_wide[7:0] != 8'd0};
                2'd2: {octets_3, lost_3} <= {16'd0, small_wide[26:16], small_wide[15:0] != 16'd0};
                default: {octets_3, lost_3} <= {24'd0, small_wide[26:24], small_wide[23:0] != 24'd0};
            endcase
        end
        aligned_4 <= {bits_3[33:8], bits_3[7] || lost_3 || (bits_3[6:0] != 7'd0)};
    end

    wire [27:0] large_wide = {1'b0, large_2, 3'd0};
    wire [27:0] small_4 = {1'b0, aligned_4};
    wire [27:0] sum = (a_1[31] ^ b_1[31]) ? large_wide - small_4 : large_wide + small_4;

    // ---- Product, quotient and root
    wire [47:0] product;
    wire digits_done;
    wire [25:0] digits;
    wire digits_rest;

    sptfra_float_product multiplier (
        .clock   (clock),
        .start   (stage[1]),
        .a       (significand_a),
        .b       (significand_b),
        .product (product)
    );

    sptfra_float_digits divider (
        .clock   (clock),
        .reset   (reset),
        .start   (stage[1] && by_digits),
        .root    (operation_1 == ROOT),
        .doubled (!a_1[23]), // the exponent less 127 is odd
        .a       (significand_a),
        .b       (significand_b),
        .done    (digits_done),
        .digits  (digits),
        .rest    (digits_rest)
    );

    // ---- The angle, of both with the larger one's exponent
    wire [31:0] x_wide = {2'd0, below ? aligned_4 : large_wide[26:0], 3'd0};
    wire [31:0] y_wide = {2'd0, below ? large_wide[26:0] : aligned_4, 3'd0};
    reg rotate;
    reg signed [31:0] x;
    reg signed [31:0] y;
    wire [33:0] length;
    wire signed [31:0] angle;
    wire angle_done;
    reg angle_there;
    reg [31:0] turned; // |angle|

    sptfra_cordic cordic (
        .clock     (clock),
        .reset     (reset),
        .start     (rotate),
        .x         (x),
        .y         (y),
        .magnitude (length),
        .angle     (angle),
        .done      (angle_done)
    );

    always @(posedge clock) begin
        rotate <= stage[4] && (operation_1 == ANGLE) && !reset;
        angle_there <= angle_done && !reset;
        x <= a_1[31] ? -x_wide : x_wide;
        y <= b_1[31] ? -y_wide : y_wide;
        turned <= angle[31] ? -angle : angle;
    end

    // ---- One of them is rounded
    reg round;
    reg [27:0] value;
    reg [9:0] rest;
    wire rounded;
    wire [31:0] float_bits;
    reg compared;

    always @(posedge clock) begin
        compared <= stage[1] && compare && !reset;
        round <= ((stage[4] && !by_digits && (operation_1 != ANGLE) && !compare) || digits_done || angle_there)
            && !reset;
        rest <= 10'd0;
        case (operation_1)
            MULTIPLY: begin
                value <= {product[47:21], 1'b0};
                rest <= {product[20:12], product[11:0] != 12'd0};
                negative <= a_1[31] ^ b_1[31];
            end
            DIVIDE, ROOT: begin
                value <= {1'b0, digits, digits_rest};
                negative <= (operation_1 == DIVIDE) && (a_1[31] ^ b_1[31]);
            end
            ANGLE: begin
                value <= {turned[30:4], turned[3:0] != 4'd0};
                negative <= angle[31];
            end
            default: begin
                value <= sum;
                negative <= below ? b_1[31] : a_1[31];
            end
        endcase
        if (nothing) begin
            value <= 28'd0;
            rest <= 10'd0;
        end
    end

    sptfra_float_round rounding (
        .clock      (clock),
        .reset      (reset),
        .start      (round),
        .negative   (negative),
        .value      (value),
        .rest       (rest),
        .exponent   (exponent_3),
        .done       (rounded),
        .float_bits (float_bits)
    );

    assign done = rounded || compared;
    assign result = float_bits;

    // Exponents of 8 bits are at most so far apart; an angle is below 4
    wire _unused = &{1'b0, behind[8], ahead[8], length, turned[31]};

endmodule

`default_nettype wire
