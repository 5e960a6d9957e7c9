// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Resultants, friction coefficient and angle of a frame from the estimator's answer and the sums G_pq.
//
// F_p = G_p0 + mu_x G_p1 + mu_y G_p2, the torques likewise; mu = sqrt(F_x^2 + F_y^2) / |F_z|; phi = atan2(F_y, F_x).
// A step of F is 2^-16 of one of G; mu is quotient * 2^exponent, a floating-point number; phi has 29 fraction bits.
// From start to done: 37 cycles, a rotation of 62 and a division of 34; the torques are made during the rotation.
// The standard error is 2^error_log |F_z|, with 2^(n + f) taken as 2^n (1 + f); it is made during the division.
// Results hold until the next start.

`default_nettype none

module sptfra_summary #(
    // 1: the other component is other + slope * free; 0: it is as it comes
    parameter integer DEPENDENT = 1,
    // From start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start, // with these held from the next cycle on, the sums from the one after
    input  wire [18*40-1:0] sums,
    input  wire x_is_free, // the free component is mu_x
    input  wire unknown, // both components are zero
    input  wire signed [17:0] free, // 16 fraction bits
    input  wire signed [17:0] other, // 15 fraction bits if DEPENDENT, as slope, else 16
    input  wire signed [17:0] slope,
    input  wire signed [17:0] error_log, // 12 fraction bits
    output wire friction_done, // one cycle, when mu_x and mu_y are there
    output reg  done, // one cycle
    output reg  signed [17:0] mu_x, // 16 fraction bits
    output reg  signed [17:0] mu_y,
    output reg  dependent_clipped, // the dependent component left [-2, 2)
    output reg  [6*64-1:0] wrench, // forces in x, y, z, torques in x, y, z, the first in the lowest bits
    output wire [63:0] friction_quotient,
    output reg  signed [9:0] friction_exponent,
    output wire signed [31:0] angle,
    output reg  [63:0] error_value, // standard error of (F_x, F_y), in steps of F times 2^error_exponent
    output reg  signed [9:0] error_exponent
);

    localparam [2:0] IDLE = 3'd0, FORCES = 3'd1, ROTATE = 3'd2, GAIN = 3'd3, DIVIDE = 3'd4;
    localparam integer LINE_FRACTION = 15;
    localparam signed [47:0] LINE_HALF = 48'sd1 <<< (LINE_FRACTION - 1);
    // 1 / gain of the CORDIC, 26 fraction bits
    localparam signed [26:0] INVERSE_GAIN = 27'sd40752055;
    localparam signed [17:0] ONE = 18'sd65536;

    wire signed [63:0] force_x = wrench[64*0 +: 64];
    wire signed [63:0] force_y = wrench[64*1 +: 64];
    wire signed [63:0] force_z = wrench[64*2 +: 64];
    reg [2:0] state;
    reg [5:0] step;

    // ---- Multiply-accumulate: dependent component (steps 0, 1), forces and torques (steps 6 to 41), gain (steps 0, 1
    // of GAIN)
    reg low_half; // of the sums
    reg [1:0] q;
    reg [4:0] sum_index; // 3 * (component - 1) + q, torques from component 4 on
    integer four;
    wire resultants = (state == FORCES) || (state == ROTATE);
    // A sum in two cycles: one of each four, and one of these
    reg forces; // in steps 3 to 38: a sum is chosen
    reg forces_1, forces_2, forces_3; // the last: half of it goes into the multiplier
    reg [1:0] q_1, q_2, q_3;
    reg low_half_1, low_half_2;
    reg [4:2] sum_index_1;
    reg [40*5-1:0] candidates_1;
    reg [39:0] sum_2;
    reg signed [26:0] half_3;

    reg [31:0] unit_z; // |F_z|, with its leading bit at the top
    reg signed [17:0] coefficient;
    reg signed [26:0] data;
    reg first, mac_valid, mac_first;
    reg signed [17:0] mac_coefficient;
    reg signed [26:0] mac_data;
    wire dependent_steps = (DEPENDENT != 0) && (state == FORCES) && (step <= 6'd1);
    wire other_steps = ((state == GAIN) && (step <= 6'd1)) || ((state == DIVIDE) && (step == 6'd8));
    wire issue = dependent_steps || forces_3 || other_steps;
    wire signed [47:0] accumulator;
    wire [33:0] magnitude;

    always @(*) begin
        if (state == GAIN) begin
            coefficient = (step == 6'd0) ? {1'b0, magnitude[33:17]} : {1'b0, magnitude[16:0]};
            data = INVERSE_GAIN;
            first = 1'b1;
        end else if (state == DIVIDE) begin
            coefficient = {2'b01, error_log[11:0], 4'd0};
            data = {1'b0, unit_z[31:6]};
            first = 1'b1;
        end else if (forces_3) begin
            coefficient = (q_3 == 2'd0) ? ONE : (q_3 == 2'd1) ? mu_x : mu_y;
            data = half_3;
            first = (q_3 == 2'd0);
        end else begin
            coefficient = (step == 6'd0) ? slope : other;
            data = (step == 6'd0) ? { {9{free[17]}}, free} : { {9{ONE[17]}}, ONE};
            first = (step == 6'd0);
        end
    end

    always @(posedge clock) begin
        forces <= resultants && (step >= 6'd2) && (step <= 6'd37);
        {forces_3, forces_2, forces_1} <= {forces_2, forces_1, forces};
        {q_3, q_2, q_1} <= {q_2, q_1, q};
        {low_half_2, low_half_1} <= {low_half_1, low_half};
        sum_index_1 <= sum_index[4:2];
        for (four = 0; four < 4; four = four + 1) begin
            candidates_1[40*four +: 40] <= sums[40*{four[2:0], sum_index[1:0]} +: 40];
        end
        candidates_1[160 +: 40] <= sum_index[0] ? sums[40*17 +: 40] : sums[40*16 +: 40];
        sum_2 <= candidates_1[40*sum_index_1 +: 40];
        half_3 <= low_half_2 ? {7'd0, sum_2[19:0]} : { {7{sum_2[39]}}, sum_2[39:20]};
        mac_valid <= issue;
        mac_first <= first;
        mac_coefficient <= coefficient;
        mac_data <= data;
        if (reset) begin
            {forces, forces_1, forces_2, forces_3} <= 4'd0;
            mac_valid <= 1'b0;
        end
    end

    sptfra_mac summary_mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (mac_valid),
        .first       (mac_first),
        .coefficient (mac_coefficient),
        .data        (mac_data),
        .accumulator (accumulator)
    );

    // ---- The dependent component, clipped
    reg signed [47:0] dependent_rounded;
    wire signed [47-LINE_FRACTION:0] dependent = dependent_rounded[47:LINE_FRACTION];
    wire sign = dependent_rounded[47];
    wire dependent_fits = (dependent[47-LINE_FRACTION:17] == {(31 - LINE_FRACTION){dependent[17]}});
    wire signed [17:0] dependent_limited = dependent_fits ? dependent[17:0] : {sign, {17{!sign}}};
    wire signed [17:0] bound = (DEPENDENT != 0) ? dependent_limited : other;

    // ---- Normalise for the CORDIC and the division
    reg signed [47:0] high_part;
    wire signed [63:0] joined = {high_part[43:0], 20'd0} + { {16{accumulator[47]}}, accumulator};
    // The gain product: both halves together
    wire [63:0] gained = {high_part[46:0], 17'd0} + {16'd0, accumulator};
    reg [63:0] spread_xy, magnitude_z;
    reg [6:0] bits_xy, bits_z;
    reg no_quotient;
    reg signed [31:0] unit_x, unit_y;

    // Two cycles behind the numbers
    wire [6:0] found_xy, found_z;

    sptfra_leading_bit #(.WIDTH (64)) leading_bit_xy (
        .clock (clock),
        .value (spread_xy),
        .bits  (found_xy)
    );

    sptfra_leading_bit #(.WIDTH (64)) leading_bit_z (
        .clock (clock),
        .value (magnitude_z),
        .bits  (found_z)
    );

    // Up to the 64th bit by left shifts, fours first, then down to the width wanted
    reg [5:0] left_xy, left_z;
    reg signed [63:0] fours_x, fours_y;
    reg [63:0] fours_z;
    wire signed [63:0] shifted_x = fours_x <<< left_xy[1:0];
    wire signed [63:0] shifted_y = fours_y <<< left_xy[1:0];
    wire [63:0] shifted_z = fours_z << left_z[1:0];

    // Step by step behind the forces, which hold
    always @(posedge clock) begin
        spread_xy <= (force_x ^ {64{force_x[63]}}) | (force_y ^ {64{force_y[63]}});
        magnitude_z <= force_z[63] ? -force_z : force_z;
        bits_xy <= found_xy;
        bits_z <= found_z;
        left_xy <= 6'd63 - found_xy[5:0];
        left_z <= 6'd0 - found_z[5:0];
        fours_x <= force_x <<< {left_xy[5:2], 2'd0};
        fours_y <= force_y <<< {left_xy[5:2], 2'd0};
        fours_z <= magnitude_z << {left_z[5:2], 2'd0};
        unit_x <= {shifted_x[63], shifted_x[63:33]};
        unit_y <= {shifted_y[63], shifted_y[63:33]};
        unit_z <= shifted_z[63:32];
        friction_exponent <= {3'd0, bits_xy} - {3'd0, bits_z} - 10'sd30;
        no_quotient <= (bits_z == 7'd0) || (bits_xy == 7'd0);
    end

    // ---- Rotate: magnitude and angle
    reg rotate_start;
    wire rotate_done;
    sptfra_cordic cordic (
        .clock     (clock),
        .reset     (reset),
        .start     (rotate_start),
        .x         (unit_x),
        .y         (unit_y),
        .magnitude (magnitude),
        .angle     (angle),
        .done      (rotate_done)
    );

    // ---- Divide
    reg [39:0] tangential;
    reg divide_start;
    wire divide_done;
    // |F_z| has its leading bit at the top: the quotient of 38 by 32 bits is below 2^7, with 26 fraction bits
    wire [32:0] quotient, nothing;
    sptfra_ratio #(
        .WIDTH        (38),
        .INTEGER_BITS (7),
        .BITS         (33),
        .QUOTIENTS    (1)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (divide_start),
        .numerator_x (tangential[37:0]),
        .numerator_y (38'd0),
        .denominator ({6'd0, unit_z}),
        .done        (divide_done),
        .quotient_x  (quotient),
        .quotient_y  (nothing)
    );

    assign friction_quotient = no_quotient ? 64'd0 : {31'd0, quotient};
    assign friction_done = (state == FORCES) && (step == 6'd7);

    always @(posedge clock) begin
        done <= 1'b0;
        {rotate_start, divide_start} <= 2'd0;
        step <= (step == 6'd63) ? step : step + 6'd1;
        dependent_rounded <= accumulator + LINE_HALF;
        if (forces) begin
            q <= (q == 2'd2) ? 2'd0 : q + 2'd1;
            // The three of a component twice
            sum_index <= ((q == 2'd2) && !low_half) ? sum_index - 5'd2 : sum_index + 5'd1;
            if (q == 2'd2) begin
                low_half <= !low_half;
            end
        end
        if (resultants) begin
            case (step)
                6'd12, 6'd18, 6'd24, 6'd30, 6'd36, 6'd42: high_part <= accumulator;
                6'd15: wrench[64*0 +: 64] <= joined;
                6'd21: wrench[64*1 +: 64] <= joined;
                6'd27: wrench[64*2 +: 64] <= joined;
                6'd33: wrench[64*3 +: 64] <= joined;
                6'd39: wrench[64*4 +: 64] <= joined;
                6'd45: wrench[64*5 +: 64] <= joined;
                default: ;
            endcase
        end
        case (state)
            IDLE: begin
                step <= 6'd0;
                sum_index <= 5'd0;
                low_half <= 1'b0;
                q <= 2'd0;
                if (start) begin
                    state <= FORCES;
                end
            end
            FORCES: begin
                if (step == 6'd6) begin
                    mu_x <= unknown ? 18'sd0 : x_is_free ? free : bound;
                    mu_y <= unknown ? 18'sd0 : x_is_free ? bound : free;
                    dependent_clipped <= (DEPENDENT != 0) && !unknown && !dependent_fits;
                end
                if (step == 6'd27) begin // x and y are there, F_z and the torques follow
                    rotate_start <= 1'b1;
                    state <= ROTATE;
                end
            end
            ROTATE: begin
                if (rotate_done) begin
                    step <= 6'd0;
                    state <= GAIN;
                end
            end
            GAIN: begin
                if (step == 6'd4) begin
                    high_part <= accumulator;
                end
                if (step == 6'd5) begin
                    tangential <= gained[59:20];
                    divide_start <= 1'b1;
                    state <= DIVIDE;
                end
            end
            default: begin
                if (step == 6'd12) begin
                    error_value <= {16'd0, accumulator};
                    error_exponent <= {3'd0, bits_z} + { {4{error_log[17]}}, error_log[17:12]} - 10'sd42;
                end
                if (divide_done) begin
                    done <= 1'b1;
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
            done <= 1'b0;
            {rotate_start, divide_start} <= 2'd0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (done)
    );

    wire _unused = &{1'b0, nothing, dependent_rounded[LINE_FRACTION-1:0], high_part[47], tangential[39:38],
        gained[63:60], gained[19:0], shifted_x[32:0], shifted_y[32:0], shifted_z[31:0]};

endmodule

`default_nettype wire
