// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Stress of the normal forces alone, an orbit in two cycles. n = u0 + mu_x u1 + mu_y u2 at the centroid of the level
// set, with steps four times those of u.
//
// Outputs: 16 n as a share of sum |b|, with 19 fraction bits, and the moments of the compression. From start to done:
// two cycles an orbit, and 10.

`default_nettype none

module sptfra_features_stress #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of the number of an orbit
    parameter integer ROW_WIDTH = 5,
    // Left shift of n times the reciprocal, before the right shift by the bits of sum |b|
    parameter integer STRESS_LEFT = 9
) (
    input  wire clock,
    input  wire reset,
    // 1 / sum |b|, held as the friction is
    input  wire [5:0] sum_bits,
    input  wire signed [17:0] reciprocal, // 2^-(16 + sum_bits) a step
    // The centroid of the level set is there, and held
    input  wire start,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // u_q of an orbit's taxels, a cycle after they are asked for
    output reg  [ROW_WIDTH-1:0] u_orbit,
    input  wire [3*4*27-1:0] u_values,
    // Shares of an orbit's taxels
    output wire share_valid,
    output wire [ROW_WIDTH-1:0] share_orbit,
    output wire [4*25-1:0] shares,
    // Moments of the compression, held until the next start
    output wire done, // all are in; one cycle
    output wire [47:0] weight_sum,
    output wire [47:0] moment_x,
    output wire [47:0] moment_y,
    output reg  saturated // a share was clipped
);

    localparam integer ORBIT_COLUMNS = (COLUMNS + 1) / 2;
    localparam integer ORBITS = ORBIT_COLUMNS * ((ROWS + 1) / 2);
    localparam integer LAST_ORBIT = ORBITS - 1;
    localparam integer LAST_ORBIT_COLUMN = ORBIT_COLUMNS - 1;
    localparam integer LAST_COLUMN = COLUMNS - 1;
    localparam integer LAST_ROW = ROWS - 1;
    localparam integer STRESS_BITS = 25; // of a share
    localparam integer SHARE_BITS = 45 + STRESS_LEFT; // before it is clipped
    localparam integer STAGES = 11; // from an orbit's second cycle to its shares
    localparam integer SUMMED = 10; // ... to its moments being in
    localparam integer INDEX_WIDTH = $clog2((COLUMNS > ROWS) ? COLUMNS : ROWS); // of a column and of a row
    localparam integer WEIGHT_BITS = 28 + $clog2(ORBITS); // of a sum of compressions
    localparam integer MOMENT_BITS = WEIGHT_BITS + INDEX_WIDTH;

    // ---- Orbits, two cycles each: u1, then u2. Index k: k cycles after the counters
    reg running;
    reg second; // of an orbit's cycles
    wire last_cycle = second && (u_orbit == LAST_ORBIT[ROW_WIDTH-1:0]);
    reg first_1;
    reg [STAGES:1] seconds;
    reg [SUMMED:1] lasts;

    always @(posedge clock) begin
        if (running) begin
            second <= !second;
            u_orbit <= second ? u_orbit + 1'b1 : u_orbit;
        end
        if (running && last_cycle) begin
            running <= 1'b0;
        end
        if (start) begin
            running <= 1'b1;
            second <= 1'b0;
            u_orbit <= {ROW_WIDTH{1'b0}};
        end
        first_1 <= running && !second;
        seconds <= {seconds[STAGES-1:1], running && second};
        lasts <= {lasts[SUMMED-1:1], running && last_cycle};
        if (reset) begin
            running <= 1'b0;
            first_1 <= 1'b0;
            seconds <= {STAGES{1'b0}};
            lasts <= {SUMMED{1'b0}};
        end
    end

    assign done = lasts[SUMMED];

    // ---- Stress of the normal forces: there five cycles after an orbit's second one, and for two
    wire [4*27-1:0] normals;
    wire [4*27-1:0] compressions; // a cycle later

    genvar index;

    for (index = 0; index < 4; index = index + 1) begin : gen_images
        wire signed [26:0] u0 = u_values[27*index +: 27];
        wire signed [26:0] u1 = u_values[27*(4 + index) +: 27];
        wire signed [26:0] u2 = u_values[27*(8 + index) +: 27];
        reg signed [26:0] u0_2; // from two cycles after the second one of its orbit on
        reg signed [27:0] u0_4; // with half a step of n, which is four of u
        wire signed [47:0] friction; // 16 fraction bits, which carry nothing into the sum
        wire signed [31:0] rounded = friction[47:16] + { {4{u0_4[27]}}, u0_4};
        reg signed [26:0] normal;
        reg signed [26:0] compression;

        sptfra_mac with_friction (
            .clock       (clock),
            .reset       (reset),
            .valid       (first_1 || seconds[1]),
            .first       (first_1),
            .coefficient (first_1 ? mu_x : mu_y),
            .data        (first_1 ? u1 : u2),
            .accumulator (friction)
        );

        always @(posedge clock) begin
            if (seconds[1]) begin
                u0_2 <= u0;
            end
            if (seconds[3]) begin
                u0_4 <= {u0_2[26], u0_2} + 28'sd2;
            end
            if (seconds[4]) begin
                normal <= rounded[2 +: 27];
            end
            compression <= normal[26] ? -normal : 27'd0;
        end

        assign normals[27*index +: 27] = normal;
        assign compressions[27*index +: 27] = compression;

        wire _unused = &{1'b0, rounded, friction};
    end

    // ---- Moments of the compression, index k: k cycles after an orbit's second one. One half, then the other
    reg [26:0] at_left; // two compressions: of three stresses added up, a quarter as fine
    reg [26:0] at_right;
    reg [26:0] at_top;
    reg [26:0] at_bottom;
    reg [INDEX_WIDTH-1:0] column; // of the orbit
    reg [INDEX_WIDTH-1:0] row;
    wire last_column = (column == LAST_ORBIT_COLUMN[INDEX_WIDTH-1:0]);
    wire other_half = seconds[8];
    wire [26:0] along_x = other_half ? at_right : at_left;
    wire [26:0] along_y = other_half ? at_bottom : at_top;
    wire [26+INDEX_WIDTH:0] moment_x_8;
    wire [26+INDEX_WIDTH:0] moment_y_8;
    reg [26:0] weight_9;
    reg [26+INDEX_WIDTH:0] moment_x_9;
    reg [26+INDEX_WIDTH:0] moment_y_9;
    reg [WEIGHT_BITS-1:0] weights;
    reg [MOMENT_BITS-1:0] moments_x;
    reg [MOMENT_BITS-1:0] moments_y;

    assign weight_sum = { {(48 - WEIGHT_BITS){1'b0}}, weights};
    assign moment_x = { {(48 - MOMENT_BITS){1'b0}}, moments_x};
    assign moment_y = { {(48 - MOMENT_BITS){1'b0}}, moments_y};

    sptfra_times_index #(
        .INDEX_WIDTH (INDEX_WIDTH)
    ) times_x (
        .number  (along_x),
        .index   (other_half ? LAST_COLUMN[INDEX_WIDTH-1:0] - column : column),
        .product (moment_x_8)
    );

    sptfra_times_index #(
        .INDEX_WIDTH (INDEX_WIDTH)
    ) times_y (
        .number  (along_y),
        .index   (other_half ? LAST_ROW[INDEX_WIDTH-1:0] - row : row),
        .product (moment_y_8)
    );

    always @(posedge clock) begin
        at_left <= compressions[27*0 +: 27] + compressions[27*2 +: 27];
        at_right <= compressions[27*1 +: 27] + compressions[27*3 +: 27];
        at_top <= compressions[27*0 +: 27] + compressions[27*1 +: 27];
        at_bottom <= compressions[27*2 +: 27] + compressions[27*3 +: 27];
        weight_9 <= along_x;
        moment_x_9 <= moment_x_8;
        moment_y_9 <= moment_y_8;
        if (other_half) begin
            column <= last_column ? {INDEX_WIDTH{1'b0}} : column + 1'b1;
            row <= last_column ? row + 1'b1 : row;
        end
        if (seconds[8] || seconds[9]) begin
            weights <= weights + { {(WEIGHT_BITS - 27){1'b0}}, weight_9};
            moments_x <= moments_x + { {(WEIGHT_BITS - 27){1'b0}}, moment_x_9};
            moments_y <= moments_y + { {(WEIGHT_BITS - 27){1'b0}}, moment_y_9};
        end
        if (start) begin
            column <= {INDEX_WIDTH{1'b0}};
            row <= {INDEX_WIDTH{1'b0}};
            weights <= {WEIGHT_BITS{1'b0}};
            moments_x <= {MOMENT_BITS{1'b0}};
            moments_y <= {MOMENT_BITS{1'b0}};
        end
    end

    // ---- Shares of sum |b|, clipped: of images 0 and 1 first, then of 2 and 3
    wire [2*STRESS_BITS-1:0] pair;
    wire [1:0] fits;
    reg [2*STRESS_BITS-1:0] first_pair;
    reg [ROW_WIDTH-1:0] orbit_11;

    for (index = 0; index < 2; index = index + 1) begin : gen_shares
        wire signed [44:0] product;
        wire signed [SHARE_BITS-1:0] wide = { {(STRESS_LEFT + 1){product[44]}}, product[43:0]};
        reg signed [SHARE_BITS-1:0] scaled;
        reg signed [SHARE_BITS-1:0] fours;
        wire signed [SHARE_BITS-1:0] bits = fours >>> sum_bits[1:0];
        reg [STRESS_BITS-1:0] exact;
        reg sign;
        reg is_whole; // exact has all of it
        reg [STRESS_BITS-1:0] share;

        // Not the most negative number either: the sum of four would leave its width
        assign fits[index] = is_whole && (exact != {1'b1, {(STRESS_BITS - 1){1'b0}}});

        sptfra_multiply multiplier (
            .clock       (clock),
            .enable      (1'b1),
            .coefficient (reciprocal),
            .data        (seconds[5] ? normals[27*index +: 27] : normals[27*(2 + index) +: 27]),
            .product     (product)
        );

        always @(posedge clock) begin
            scaled <= wide <<< STRESS_LEFT;
            fours <= scaled >>> {sum_bits[5:2], 2'd0};
            exact <= bits[STRESS_BITS-1:0];
            sign <= fours[SHARE_BITS-1];
            // Of the bits above, those that a shift of up to 3 brings down, and the others
            is_whole <= (bits[STRESS_BITS+2:STRESS_BITS-1] == {4{fours[SHARE_BITS-1]}})
                && (fours[SHARE_BITS-1:STRESS_BITS+3] == {(SHARE_BITS - STRESS_BITS - 3){fours[SHARE_BITS-1]}});
            share <= fits[index] ? exact : {sign, {(STRESS_BITS - 2){!sign}}, 1'b1};
        end

        wire _unused = &{1'b0, bits};

        assign pair[STRESS_BITS*index +: STRESS_BITS] = share;
    end

    assign share_valid = seconds[11];
    assign share_orbit = orbit_11;
    assign shares = {pair, first_pair};

    always @(posedge clock) begin
        first_pair <= pair;
        if (seconds[11]) begin
            orbit_11 <= orbit_11 + 1'b1;
        end
        if ((seconds[9] || seconds[10]) && (fits != 2'b11)) begin
            saturated <= 1'b1;
        end
        if (start) begin
            orbit_11 <= {ROW_WIDTH{1'b0}};
            saturated <= 1'b0;
        end
    end

endmodule

`default_nettype wire
