// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts to stress: times the taxel's gain, rounded, plus its offset, clipped to the full scale.
//
// Count to stress: 4 cycles, with SHIFTS 7, one a cycle. Names end in the number of cycles since the count came in.

`default_nettype none

module sptfra_counts #(
    // 1: a gain's exponent is a shift behind the product; 0: the count was decoded by it
    parameter SHIFTS = 0,
    // Bits of an offset, in steps of the stress
    parameter OFFSET_BITS = 27,
    // Bits dropped of the product: with SHIFTS less the gain's exponent, 0 to 47
    parameter integer SHIFT = 16,
    // In steps of the stress: full scale less what the rounding of gains takes, and what a larger stress becomes
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000
) (
    input  wire clock,
    // Counts
    input  wire signed [26:0] number,
    input  wire number_saturated,
    input  wire number_not_finite,
    // Constants of the taxel, a cycle after its count
    input  wire signed [9:0] exponent_1,
    input  wire [17:0] gain_1,
    input  wire [OFFSET_BITS-1:0] offset_1,
    // Stress
    output reg  signed [26:0] stress,
    output reg  saturated,
    output wire not_finite
);

    localparam SUMMED = (SHIFTS != 0) ? 6 : 3; // cycles to the sum

    // ---- Product
    reg signed [26:0] number_1;
    wire signed [44:0] exact_2;
    wire signed [47:0] product_2 = {{3{exact_2[44]}}, exact_2};

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient (gain_1),
        .data        (number_1),
        .product     (exact_2)
    );

    // ---- Rounded, with the offset: a cycle before the sum
    wire signed [47:0] rounded;
    wire [OFFSET_BITS-1:0] offset;

    if (SHIFTS != 0) begin : gen_shifts
        localparam [31:0] SHIFT_WIDE = SHIFT;
        localparam signed [11:0] MOST = 12'sd47;
        wire signed [11:0] drop = $signed(SHIFT_WIDE[11:0]) - $signed({{2{exponent_1[9]}}, exponent_1});
        reg [5:0] drop_2;
        reg [5:0] drop_3;
        reg [2:0] drop_4;
        // Twice what they are, to be rounded
        reg signed [48:0] product_3;
        reg signed [48:0] coarse_4;
        reg signed [48:0] fine_5;
        wire signed [48:0] half = fine_5 + 49'sd1;
        reg [4*OFFSET_BITS-1:0] offsets; // of stages 5 to 2

        assign rounded = half[48:1];
        assign offset = offsets[4*OFFSET_BITS-1 -: OFFSET_BITS];

        always @(posedge clock) begin
            drop_2 <= drop[11] ? 6'd0 : (drop > MOST) ? MOST[5:0] : drop[5:0];
            drop_3 <= drop_2;
            product_3 <= {product_2, 1'b0};
            coarse_4 <= product_3 >>> {drop_3[5:3], 3'd0};
            drop_4 <= drop_3[2:0];
            fine_5 <= coarse_4 >>> drop_4;
            offsets <= {offsets[3*OFFSET_BITS-1:0], offset_1};
        end

        wire _unused = &{1'b0, half[0], SHIFT_WIDE, drop};
    end else begin : gen_shift
        localparam signed [47:0] HALF = (48'sd1 <<< SHIFT) >>> 1;
        reg [OFFSET_BITS-1:0] offset_2;

        assign rounded = (product_2 + HALF) >>> SHIFT;
        assign offset = offset_2;

        always @(posedge clock) begin
            offset_2 <= offset_1;
        end

        wire _unused = &{1'b0, exponent_1};
    end

    // ---- Sum, clipping
    reg signed [47:0] sum;
    reg [SUMMED:1] number_saturated_to;
    reg [SUMMED+1:1] not_finite_to;
    wire above = (sum >= FULL_SCALE);
    wire below = (sum <= -FULL_SCALE);

    assign not_finite = not_finite_to[SUMMED+1];

    always @(posedge clock) begin
        number_1 <= number;
        sum <= rounded + {{(48-OFFSET_BITS){offset[OFFSET_BITS-1]}}, offset};
        stress <= above ? STRESS_BOUND : below ? -STRESS_BOUND : sum[26:0];
        saturated <= above || below || number_saturated_to[SUMMED];
        number_saturated_to <= {number_saturated_to[SUMMED-1:1], number_saturated};
        not_finite_to <= {not_finite_to[SUMMED:1], number_not_finite};
    end

endmodule

`default_nettype wire
