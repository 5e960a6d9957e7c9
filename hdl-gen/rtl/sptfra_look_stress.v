// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The stress of the normal forces alone, taxel by taxel: n = u0 + mu_x u1 + mu_y u2 at the centroid of the level set.
//
// Three cycles a taxel on one multiplier; n is a quarter as fine as u. Out come n as a share of sum |b|, times 16, with
// 19 fraction bits, and the moments of the compression. From start to done: three cycles a taxel, and 13.

`default_nettype none

module sptfra_look_stress #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of the number of a quad
    parameter integer ROW_WIDTH = 5,
    // Bits of a taxel's place along x and along y
    parameter integer X_WIDTH = 4,
    parameter integer Y_WIDTH = 4,
    // Left shift of n times the reciprocal, before the right shift by the bits of sum |b|
    parameter integer STRESS_LEFT = 9
) (
    input  wire clock,
    input  wire reset,
    // A frame: its sum |b| is inverted meanwhile
    input  wire clear,
    input  wire [5:0] sum_bits,
    input  wire signed [17:0] reciprocal,
    // Its centroid of the level set is there, and held
    input  wire start,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // u_q of the taxels, three cycles after they are asked for
    output reg  [ROW_WIDTH-1:0] u_quad,
    output reg  [1:0] u_member,
    output reg  [1:0] u_q,
    input  wire signed [26:0] u_value,
    // Shares of the taxels
    output wire share_valid,
    output wire [Y_WIDTH+X_WIDTH-1:0] share_place, // {y, x}
    output reg  [24:0] share,
    // Moments of the compression, held until the next clear
    output wire done, // all are in; one cycle
    output reg  [47:0] weight_sum,
    output reg  [47:0] moment_x,
    output reg  [47:0] moment_y,
    output reg  saturated // a share was clipped
);

    localparam integer QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam integer QUAD_ROWS = (ROWS + 1) / 2;
    localparam integer LAST_COLUMN = COLUMNS - 1;
    localparam integer LAST_ROW = ROWS - 1;
    // 16 fraction bits of the friction, two by which n is coarser than u
    localparam integer NORMAL_SHIFT = 18;
    localparam signed [47:0] NORMAL_HALF = 48'sd1 <<< (NORMAL_SHIFT - 1);
    localparam integer STRESS_BITS = 25; // of a share
    localparam integer SHARE_BITS = 45 + STRESS_LEFT; // before it is clipped
    localparam signed [17:0] ONE = 18'sd65536;

    localparam [1:0] IDLE = 2'd0, TAXELS = 2'd1, DRAIN = 2'd2;

    reg [1:0] state;
    reg [3:0] wait_count;

    // ---- Taxels in the order of the grid, three cycles each
    reg [X_WIDTH-1:0] x;
    reg [Y_WIDTH-1:0] y;
    reg [1:0] q;
    wire asking = (state == TAXELS);
    wire last_x = (x == LAST_COLUMN[X_WIDTH-1:0]);
    wire last_taxel = last_x && (y == LAST_ROW[Y_WIDTH-1:0]) && (q == 2'd2);
    wire far_x = (x >= QUAD_COLUMNS[X_WIDTH-1:0]);
    wire far_y = (y >= QUAD_ROWS[Y_WIDTH-1:0]);
    wire [X_WIDTH-1:0] quad_x = far_x ? LAST_COLUMN[X_WIDTH-1:0] - x : x;
    wire [Y_WIDTH-1:0] quad_y = far_y ? LAST_ROW[Y_WIDTH-1:0] - y : y;
    wire [47:0] row_base;
    wire [15:0] quad = row_base[15:0] + { {(16 - X_WIDTH){1'b0}}, quad_x};
    reg [3:1] asked; // index k: k cycles after the counters
    reg [3:1] firsts;
    reg [6:1] lasts; // of a taxel's three
    reg [1:0] q_2;
    reg [1:0] q_3;

    sptfra_times_index #(
        .INDEX_WIDTH (Y_WIDTH)
    ) times_row (
        .number  (QUAD_COLUMNS[26:0]),
        .index   (quad_y),
        .product (row_base)
    );

    always @(posedge clock) begin
        if (asking) begin
            q <= (q == 2'd2) ? 2'd0 : q + 2'd1;
            if (q == 2'd2) begin
                x <= last_x ? {X_WIDTH{1'b0}} : x + 1'b1;
                y <= last_x ? y + 1'b1 : y;
            end
        end else begin
            q <= 2'd0;
            x <= {X_WIDTH{1'b0}};
            y <= {Y_WIDTH{1'b0}};
        end
        u_quad <= quad[ROW_WIDTH-1:0];
        u_member <= {far_y, far_x};
        u_q <= q;
        {q_3, q_2} <= {q_2, u_q};
        asked <= {asked[2:1], asking};
        firsts <= {firsts[2:1], q == 2'd0};
        lasts <= {lasts[5:1], asking && (q == 2'd2)};
        if (reset) begin
            asked <= 3'd0;
            lasts <= 6'd0;
        end
    end

    // ---- Stress of the normal forces
    wire signed [47:0] exact;
    wire signed [47:0] rounded = exact + NORMAL_HALF;
    reg signed [26:0] normal;
    reg signed [17:0] factor;

    always @(*) begin
        case (q_3)
            2'd0: factor = ONE;
            2'd1: factor = mu_x;
            default: factor = mu_y;
        endcase
    end

    sptfra_mac normal_mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (asked[3]),
        .first       (firsts[3]),
        .coefficient (factor),
        .data        (u_value),
        .accumulator (exact)
    );

    // ---- Compression and its moments. Index k: k cycles after a taxel's sum
    reg [6:1] there;
    reg [X_WIDTH-1:0] x_2;
    reg [Y_WIDTH-1:0] y_2;
    wire last_x_2 = (x_2 == LAST_COLUMN[X_WIDTH-1:0]);
    reg [26:0] weight_2;
    wire [47:0] moment_x_2;
    wire [47:0] moment_y_2;
    reg [47:0] weight_3;
    reg [47:0] moment_x_3;
    reg [47:0] moment_y_3;

    sptfra_times_index #(
        .INDEX_WIDTH (X_WIDTH)
    ) times_x (
        .number  (weight_2),
        .index   (x_2),
        .product (moment_x_2)
    );

    sptfra_times_index #(
        .INDEX_WIDTH (Y_WIDTH)
    ) times_y (
        .number  (weight_2),
        .index   (y_2),
        .product (moment_y_2)
    );

    always @(posedge clock) begin
        there <= {there[5:1], lasts[6]};
        normal <= rounded[NORMAL_SHIFT +: 27];
        weight_2 <= normal[26] ? -normal : 27'd0;
        weight_3 <= {21'd0, weight_2};
        moment_x_3 <= moment_x_2;
        moment_y_3 <= moment_y_2;
        if (there[2]) begin
            x_2 <= last_x_2 ? {X_WIDTH{1'b0}} : x_2 + 1'b1;
            y_2 <= last_x_2 ? y_2 + 1'b1 : y_2;
        end
        if (there[3]) begin
            weight_sum <= weight_sum + weight_3;
            moment_x <= moment_x + moment_x_3;
            moment_y <= moment_y + moment_y_3;
        end
        if (clear) begin
            x_2 <= {X_WIDTH{1'b0}};
            y_2 <= {Y_WIDTH{1'b0}};
            weight_sum <= 48'd0;
            moment_x <= 48'd0;
            moment_y <= 48'd0;
        end
        if (reset) begin
            there <= 6'd0;
        end
    end

    // ---- Share of sum |b|, clipped
    wire signed [44:0] product_low_2; // the product is their sum
    wire signed [44:0] product_high_2;
    wire signed [44:0] product_2 = product_low_2 + product_high_2;
    wire signed [SHARE_BITS-1:0] wide_2 = { {(STRESS_LEFT + 1){product_2[44]}}, product_2[43:0]};
    reg signed [SHARE_BITS-1:0] share_3;
    reg signed [SHARE_BITS-1:0] share_4;
    reg signed [SHARE_BITS-1:0] share_5;
    wire sign_5 = share_5[SHARE_BITS-1];
    // Not the most negative number either: the sum of four would leave its width
    wire fits_5 = (share_5[SHARE_BITS-1:STRESS_BITS-1] == {(SHARE_BITS - STRESS_BITS + 1){sign_5}})
        && (share_5[STRESS_BITS-1:0] != {1'b1, {(STRESS_BITS - 1){1'b0}}});
    reg [Y_WIDTH+X_WIDTH-1:0] place_3;
    reg [Y_WIDTH+X_WIDTH-1:0] place_4;
    reg [Y_WIDTH+X_WIDTH-1:0] place_5;
    reg [Y_WIDTH+X_WIDTH-1:0] place_6;

    sptfra_multiply share_multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient (reciprocal),
        .data        (normal),
        .low         (product_low_2),
        .high        (product_high_2)
    );

    assign share_valid = there[6];
    assign share_place = place_6;

    always @(posedge clock) begin
        share_3 <= wide_2 <<< STRESS_LEFT;
        share_4 <= share_3 >>> {sum_bits[5:3], 3'd0};
        share_5 <= share_4 >>> sum_bits[2:0];
        share <= fits_5 ? share_5[STRESS_BITS-1:0] : {sign_5, {(STRESS_BITS - 2){!sign_5}}, 1'b1};
        place_3 <= {y_2, x_2};
        place_4 <= place_3;
        place_5 <= place_4;
        place_6 <= place_5;
        if (there[5] && !fits_5) begin
            saturated <= 1'b1;
        end
        if (clear) begin
            saturated <= 1'b0;
        end
    end

    // ---- Sequence
    assign done = (state == DRAIN) && (wait_count == 4'd12);

    always @(posedge clock) begin
        wait_count <= wait_count + 4'd1;
        case (state)
            IDLE: begin
                if (start) begin
                    state <= TAXELS;
                end
            end
            TAXELS: begin
                wait_count <= 4'd0;
                if (last_taxel) begin
                    state <= DRAIN;
                end
            end
            default: begin
                if (done) begin
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
        end
    end

    wire _unused = &{1'b0, row_base, quad, rounded};

endmodule

`default_nettype wire
