// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Feature window: stress of the normal forces alone, around the contact's centre.
//
// First comes the scale, 1 / sum |b|, during the grid search. Then the stress, an orbit in two cycles, the moments of
// its compression and their centroid. The window waits until the network is free, and is folded into parity
// components. While one frame is in the window the next one may start.
//
// From start to the scale: 8 cycles and a division. From features_start to features_done: two cycles an orbit, and 33.
// From window_start to window_done: 10, and one a word.

`default_nettype none

module sptfra_features #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of the number of an orbit
    parameter integer ROW_WIDTH = 5,
    // Taxels on either side of the window's middle
    parameter integer HALF_X = 4,
    parameter integer HALF_Y = 4,
    // Words of the network's inputs
    parameter integer LENGTH = 27,
    // Bits of a word's number
    parameter integer WORD_WIDTH = 5,
    // Left shift of a stress times the reciprocal, before the right shift by the bits of sum |b|
    parameter integer STRESS_LEFT = 9,
    // From features_start to features_done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // A frame, with its sum |b| held from the next cycle on until its centroid of the level set is there
    input  wire start,
    input  wire [39:0] stress_sum,
    // u_q of an orbit's taxels, image 0 and u_0 in the lowest bits, as the search reads them
    input  wire read_valid,
    input  wire [ROW_WIDTH-1:0] read_orbit,
    input  wire [3*4*27-1:0] read_values,
    // The centroid is there, and held from the next cycle on until the window is done
    input  wire features_start,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    output wire features_done, // one cycle: the contact's centre is there, and held
    output wire saturated, // a share was clipped; held until the next features
    // Inputs of the network
    input  wire window_start,
    output wire input_valid,
    output wire input_first, // with the first of them
    output wire [WORD_WIDTH-1:0] input_word,
    output wire [4*27-1:0] input_values, // component 0 in the lowest bits
    output wire window_done // one cycle, with the last of them
);

    // Of the centre: taxels, and fraction of a pitch
    localparam integer CENTRE_BITS = 22;
    localparam integer TAXEL_BITS = 6;
    localparam integer ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2);
    localparam integer SUM_BITS = 40;
    localparam integer RECIPROCAL_BITS = 16;

    // ---- Scale, of the frame that is searched: sum |b|, its leading bit at the top
    wire [5:0] found_bits;
    reg [5:0] next_sum_bits;
    reg [39:0] sum_fours;
    reg [39:0] normalised;
    reg [2:0] prepare; // cycles since the start
    wire [5:0] to_top = SUM_BITS[5:0] - next_sum_bits;

    sptfra_leading_bit #(
        .WIDTH (SUM_BITS)
    ) leading_bit (
        .clock (clock),
        .value (stress_sum),
        .bits  (found_bits)
    );

    // ---- Its reciprocal; then of the frame whose features are computed
    reg inverting;
    wire divide_done;
    wire [RECIPROCAL_BITS+1:0] quotient;
    wire [RECIPROCAL_BITS+1:0] no_quotient;
    wire invert = (prepare == 3'd6);
    reg signed [17:0] next_reciprocal; // 2^-(16 + sum_bits) a step
    reg [5:0] sum_bits;
    reg signed [17:0] reciprocal;

    sptfra_ratio #(
        .WIDTH        (SUM_BITS),
        .INTEGER_BITS (1),
        .BITS         (RECIPROCAL_BITS + 2),
        .QUOTIENTS    (1)
    ) inverse (
        .clock       (clock),
        .reset       (reset),
        .start       (invert),
        .numerator_x ({1'b1, {(SUM_BITS - 1){1'b0}}}),
        .numerator_y ({SUM_BITS{1'b0}}),
        .denominator (normalised),
        .done        (divide_done),
        .quotient_x  (quotient),
        .quotient_y  (no_quotient)
    );

    always @(posedge clock) begin
        next_sum_bits <= found_bits;
        sum_fours <= stress_sum << {to_top[5:2], 2'd0};
        normalised <= sum_fours << to_top[1:0];
        if (prepare != 3'd0) begin
            prepare <= prepare + 3'd1;
        end
        if (invert) begin
            prepare <= 3'd0;
            inverting <= 1'b1;
        end
        if (start) begin
            prepare <= 3'd1;
        end
        if (divide_done && inverting) begin
            inverting <= 1'b0;
            next_reciprocal <= quotient[17] ? 18'sd131071 : {1'b0, quotient[16:0]};
        end
        if (features_start) begin
            sum_bits <= next_sum_bits;
            reciprocal <= next_reciprocal;
        end
        if (reset) begin
            prepare <= 3'd0;
            inverting <= 1'b0;
        end
    end

    // ---- u_q, of a frame of its own: the next one may be searched meanwhile
    wire [ROW_WIDTH-1:0] u_orbit;
    wire [3*4*27-1:0] u_values;
    genvar index;

    // A search that begins after features is behind them all the way: two cycles an orbit at least
    for (index = 0; index < 3; index = index + 1) begin : gen_memories
        sptfra_ram #(
            .WIDTH         (4 * 27),
            .DEPTH         ((ORBITS > 8) ? ORBITS : 8),
            .ADDRESS_WIDTH (ROW_WIDTH)
        ) of_q (
            .clock         (clock),
            .write_enable  (read_valid),
            .write_address (read_orbit),
            .write_data    (read_values[4*27*index +: 4*27]),
            .read_enable   (1'b1),
            .read_address  (u_orbit),
            .read_data     (u_values[4*27*index +: 4*27])
        );
    end

    // ---- Stress
    wire share_valid;
    wire [ROW_WIDTH-1:0] share_orbit;
    wire [4*25-1:0] shares;
    wire stresses_there;
    wire [47:0] weight_sum;
    wire [47:0] moment_x;
    wire [47:0] moment_y;

    sptfra_features_stress #(
        .COLUMNS     (COLUMNS),
        .ROWS        (ROWS),
        .ROW_WIDTH   (ROW_WIDTH),
        .STRESS_LEFT (STRESS_LEFT)
    ) stress (
        .clock       (clock),
        .reset       (reset),
        .sum_bits    (sum_bits),
        .reciprocal  (reciprocal),
        .start       (features_start),
        .mu_x        (mu_x),
        .mu_y        (mu_y),
        .u_orbit     (u_orbit),
        .u_values    (u_values),
        .share_valid (share_valid),
        .share_orbit (share_orbit),
        .shares      (shares),
        .done        (stresses_there),
        .weight_sum  (weight_sum),
        .moment_x    (moment_x),
        .moment_y    (moment_y),
        .saturated   (saturated)
    );

    // ---- Centroid of the compression; without any the first taxel does
    wire [CENTRE_BITS-1:0] ratio_x;
    wire [CENTRE_BITS-1:0] ratio_y;
    wire nothing = (weight_sum == 48'd0);

    sptfra_ratio #(
        .WIDTH        (48),
        .INTEGER_BITS (TAXEL_BITS),
        .BITS         (CENTRE_BITS)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (stresses_there),
        .numerator_x (moment_x),
        .numerator_y (moment_y),
        .denominator (weight_sum | {47'd0, nothing}),
        .done        (features_done),
        .quotient_x  (ratio_x),
        .quotient_y  (ratio_y)
    );

    // ---- Window
    sptfra_features_window #(
        .COLUMNS    (COLUMNS),
        .ROWS       (ROWS),
        .ROW_WIDTH  (ROW_WIDTH),
        .HALF_X     (HALF_X),
        .HALF_Y     (HALF_Y),
        .LENGTH     (LENGTH),
        .WORD_WIDTH (WORD_WIDTH)
    ) window (
        .clock        (clock),
        .reset        (reset),
        .share_valid  (share_valid),
        .share_orbit  (share_orbit),
        .shares       (shares),
        .start        (window_start),
        .centroid_x   (ratio_x),
        .centroid_y   (ratio_y),
        .mu_x         (mu_x),
        .mu_y         (mu_y),
        .input_valid  (input_valid),
        .input_first  (input_first),
        .input_word   (input_word),
        .input_values (input_values),
        .done         (window_done)
    );

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (features_start),
        .done  (features_done)
    );

    wire _unused = &{1'b0, no_quotient};

endmodule

`default_nettype wire
