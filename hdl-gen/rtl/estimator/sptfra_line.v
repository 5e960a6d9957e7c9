// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The line in the (mu_x, mu_y) plane that the direction of the push allows (Eqs. 22 and 23, without poles).
//
//     a mu_x + e mu_y = k;  a = G11 d_y - G21 d_x,  e = G12 d_y - G22 d_x,  k = G20 d_x - G10 d_y
//
// The component of the larger of |d_x|, |d_y| is the free variable t. The other component is c0 + c1 t, with 15
// fraction bits in c0 and c1. Complete sums are held. Once sums and direction are there, the line follows after 18
// cycles and a division.

`default_nettype none

module sptfra_line #(
    // From the direction to the line, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // From Co, held until taken
    input  wire sums_complete,
    output reg  sums_take, // one cycle, behind the taking
    input  wire [18*40-1:0] sums_in, // G10, G11, G12, G20 .. G32 from the lowest bits on
    // From CeAn
    input  wire direction_valid,
    output wire direction_take,
    input  wire signed [26:0] direction_x,
    input  wire signed [26:0] direction_y,
    input  wire no_direction,
    // The line, held until taken
    output wire line_valid,
    input  wire line_take,
    output reg  [18*40-1:0] sums,
    output reg  x_is_free,
    output reg  unknown, // no direction, or a line without sense
    output reg  signed [17:0] c0,
    output reg  signed [17:0] c1
);

    localparam integer LINE_FRACTION = 15;
    // Significant bits that the largest of the six sums keeps: with the sign, a coefficient of the multiplier
    localparam [5:0] LINE_SUM_BITS = 6'd17;

    localparam [2:0] SUMS = 3'd0, DIRECTION = 3'd1, EQUATION = 3'd2, DIVIDE = 3'd3, READY = 3'd4;

    reg [2:0] state;
    reg [3:0] step;
    reg no_push;
    reg signed [26:0] push_x;
    reg signed [26:0] push_y;

    assign direction_take = (state == DIRECTION) && direction_valid;
    assign line_valid = (state == READY);

    // ---- Scale: the largest of the six sums
    wire signed [39:0] g10 = sums[40*0 +: 40];
    wire signed [39:0] g11 = sums[40*1 +: 40];
    wire signed [39:0] g12 = sums[40*2 +: 40];
    wire signed [39:0] g20 = sums[40*3 +: 40];
    wire signed [39:0] g21 = sums[40*4 +: 40];
    wire signed [39:0] g22 = sums[40*5 +: 40];

    reg [39:0] spread;
    wire [5:0] spread_bits; // two cycles later
    reg [5:0] significant;
    reg [5:0] shift;

    sptfra_leading_bit #(
        .WIDTH (40)
    ) leading_bit (
        .clock (clock),
        .value (spread),
        .bits  (spread_bits)
    );

    // ---- Equation: six products, two a coefficient
    reg signed [39:0] factor_sum;
    reg signed [26:0] factor_push;
    reg signed [39:0] chosen_sum;
    reg signed [26:0] chosen_push;

    always @(*) begin
        case (step)
            4'd3: begin factor_sum = g11; factor_push = push_y; end
            4'd4: begin factor_sum = g21; factor_push = -push_x; end
            4'd5: begin factor_sum = g12; factor_push = push_y; end
            4'd6: begin factor_sum = g22; factor_push = -push_x; end
            4'd7: begin factor_sum = g20; factor_push = push_x; end
            default: begin factor_sum = g10; factor_push = -push_y; end
        endcase
    end

    wire signed [39:0] factor_shifted = chosen_sum >>> shift;
    reg signed [17:0] mac_coefficient;
    reg signed [26:0] mac_data;
    reg mac_valid;
    reg mac_first;
    wire signed [47:0] accumulator;

    sptfra_mac line_mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (mac_valid),
        .first       (mac_first),
        .coefficient (mac_coefficient),
        .data        (mac_data),
        .accumulator (accumulator)
    );

    always @(posedge clock) begin
        chosen_sum <= factor_sum;
        chosen_push <= factor_push;
        mac_coefficient <= factor_shifted[17:0];
        mac_data <= chosen_push;
        mac_valid <= (state == EQUATION) && (step >= 4'd4) && (step <= 4'd9);
        mac_first <= !step[0];
        if (reset) begin
            mac_valid <= 1'b0;
        end
    end

    reg signed [47:0] a;
    reg signed [47:0] e;
    reg signed [47:0] k;

    // ---- Divide: slope and offset at a time
    reg signed [26:0] magnitude_x;
    reg signed [26:0] magnitude_y;
    wire larger_x = (magnitude_x >= magnitude_y);
    // Chosen, then made positive, while k is still on its way
    reg signed [47:0] denominator;
    reg signed [47:0] slope; // less than zero where this over the denominator is more
    reg [47:0] denominator_magnitude;
    reg [47:0] slope_magnitude;
    reg [47:0] offset_magnitude;
    reg divide_start;
    wire divide_done;
    wire [LINE_FRACTION+1:0] slope_quotient;
    wire [LINE_FRACTION+1:0] offset_quotient;
    // No push, or a ratio of 4 or more, or a denominator of zero
    reg no_line;
    reg too_large;
    reg divided;
    reg slope_negative;
    reg offset_negative;
    wire signed [17:0] slope_ratio = slope_negative ? -{1'b0, slope_quotient} : {1'b0, slope_quotient};
    wire signed [17:0] offset_ratio = offset_negative ? -{1'b0, offset_quotient} : {1'b0, offset_quotient};

    sptfra_ratio #(
        .WIDTH        (48),
        .INTEGER_BITS (2),
        .BITS         (LINE_FRACTION + 2)
    ) divider (
        .clock       (clock),
        .reset       (reset),
        .start       (divide_start),
        .numerator_x (slope_magnitude),
        .numerator_y (offset_magnitude),
        .denominator (denominator_magnitude),
        .done        (divide_done),
        .quotient_x  (slope_quotient),
        .quotient_y  (offset_quotient)
    );

    // ---- Sequence
    always @(posedge clock) begin
        divide_start <= 1'b0;
        step <= step + 4'd1;
        sums_take <= (state == SUMS) && sums_complete;
        // The sums hold from DIRECTION on, that is, a cycle before EQUATION at least
        spread <= (g10 ^ {40{g10[39]}}) | (g11 ^ {40{g11[39]}}) | (g12 ^ {40{g12[39]}})
            | (g20 ^ {40{g20[39]}}) | (g21 ^ {40{g21[39]}}) | (g22 ^ {40{g22[39]}});
        significant <= spread_bits;
        magnitude_x <= push_x[26] ? -push_x : push_x;
        magnitude_y <= push_y[26] ? -push_y : push_y;
        denominator <= x_is_free ? e : a;
        slope <= x_is_free ? a : e;
        denominator_magnitude <= denominator[47] ? -denominator : denominator;
        slope_magnitude <= slope[47] ? -slope : slope;
        offset_magnitude <= k[47] ? -k : k;
        case (state)
            SUMS: begin
                sums <= sums_in;
                if (sums_complete) begin
                    state <= DIRECTION;
                end
            end
            DIRECTION: begin
                step <= 4'd0;
                push_x <= direction_x;
                push_y <= direction_y;
                no_push <= no_direction;
                if (direction_valid) begin
                    state <= EQUATION;
                end
            end
            EQUATION: begin
                case (step)
                    4'd3: shift <= (significant > LINE_SUM_BITS) ? significant - LINE_SUM_BITS : 6'd0;
                    4'd9: a <= accumulator;
                    4'd11: e <= accumulator;
                    4'd13: k <= accumulator;
                    default: ;
                endcase
                x_is_free <= larger_x || no_push;
                if (step == 4'd14) begin
                    divide_start <= 1'b1;
                    divided <= 1'b0;
                    state <= DIVIDE;
                end
            end
            DIVIDE: begin
                too_large <= ({2'd0, slope_magnitude} >= {denominator_magnitude, 2'd0})
                    || ({2'd0, offset_magnitude} >= {denominator_magnitude, 2'd0});
                no_line <= no_push || too_large;
                slope_negative <= !slope[47] ^ denominator[47];
                offset_negative <= k[47] ^ denominator[47];
                divided <= divide_done;
                unknown <= no_line;
                c0 <= no_line ? 18'sd0 : offset_ratio;
                c1 <= no_line ? 18'sd0 : slope_ratio;
                if (divided) begin
                    x_is_free <= x_is_free || no_line;
                    state <= READY;
                end
            end
            default: begin
                if (line_take) begin
                    state <= SUMS;
                end
            end
        endcase
        if (reset) begin
            state <= SUMS;
            divide_start <= 1'b0;
            sums_take <= 1'b0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (direction_take),
        .done  (line_valid)
    );

    // Shifted sums have 18 bits, sign included
    wire _unused = &{1'b0, factor_shifted[39:18]};

endmodule

`default_nettype wire
