// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Centroids of compression and tension, and the direction of the push d = c - t (Eq. 24), as a vector.
//
// Stresses come in as magnitudes. done follows the last one after 9 cycles and two divisions of 28 cycles. d is there
// in the next cycle. Centroids have 20 fraction bits of a taxel index; d the same, in units of the larger pitch.

`default_nettype none

module sptfra_direction #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Pitch in x over the larger pitch, 16 fraction bits
    parameter signed [17:0] PITCH_X = 18'sd65536,
    // Pitch in y over the larger pitch, 16 fraction bits
    parameter signed [17:0] PITCH_Y = 18'sd65536
) (
    input  wire clock,
    input  wire reset,
    // Stress, taxel by taxel in rows
    input  wire clear, // for a new frame, and after a reset
    input  wire [26:0] noise, // of a taxel, in steps of the stress
    input  wire valid,
    input  wire [5:0] x, // of the taxel
    input  wire [5:0] y,
    input  wire tensile,
    input  wire [26:0] magnitude,
    // All stresses are in, the last one maybe in this cycle
    input  wire start,
    // Result, from the cycle after done until the next clear
    output wire done,
    output reg  signed [26:0] push_x,
    output reg  signed [26:0] push_y,
    output wire no_push // nothing above, or nothing below, the noise floor
);

    localparam integer CENTROID_FRACTION = 20;
    localparam integer INDEX_BITS = 6; // of a taxel's column or row
    localparam integer CENTROID_BITS = INDEX_BITS + CENTROID_FRACTION;
    localparam integer PITCH_FRACTION = 16;
    localparam signed [47:0] PITCH_HALF = 48'sd1 <<< (PITCH_FRACTION - 1);
    localparam integer X_WIDTH = (COLUMNS <= 2) ? 1 : $clog2(COLUMNS);
    localparam integer Y_WIDTH = (ROWS <= 2) ? 1 : $clog2(ROWS);
    // An index is multiplied in two halves
    localparam integer X_HALF = (X_WIDTH + 1) / 2;
    localparam integer Y_HALF = (Y_WIDTH + 1) / 2;

    // ---- Moments of the stress
    reg compression_seen;
    reg tension_seen;
    wire above_floor = (magnitude > noise);
    wire [26+X_HALF:0] lower_x;
    wire [26+X_HALF:0] upper_x;
    wire [26+Y_HALF:0] lower_y;
    wire [26+Y_HALF:0] upper_y;

    assign no_push = !(compression_seen && tension_seen);

    sptfra_times_index #(
        .INDEX_WIDTH (X_HALF)
    ) times_lower_x (
        .number  (magnitude),
        .index   (x[X_HALF-1:0]),
        .product (lower_x)
    );

    sptfra_times_index #(
        .INDEX_WIDTH (X_HALF)
    ) times_upper_x (
        .number  (magnitude),
        .index   (x[2*X_HALF-1:X_HALF]),
        .product (upper_x)
    );

    sptfra_times_index #(
        .INDEX_WIDTH (Y_HALF)
    ) times_lower_y (
        .number  (magnitude),
        .index   (y[Y_HALF-1:0]),
        .product (lower_y)
    );

    sptfra_times_index #(
        .INDEX_WIDTH (Y_HALF)
    ) times_upper_y (
        .number  (magnitude),
        .index   (y[2*Y_HALF-1:Y_HALF]),
        .product (upper_y)
    );

    always @(posedge clock) begin
        if (valid) begin
            compression_seen <= compression_seen || (!tensile && above_floor);
            tension_seen <= tension_seen || (tensile && above_floor);
        end
        if (clear) begin
            compression_seen <= 1'b0;
            tension_seen <= 1'b0;
        end
    end

    // ---- Sums
    reg valid_1;
    reg tensile_1;
    reg [47:0] magnitude_1;
    reg [26+X_HALF:0] lower_x_1;
    reg [26+X_HALF:0] upper_x_1;
    reg [26+Y_HALF:0] lower_y_1;
    reg [26+Y_HALF:0] upper_y_1;
    reg valid_2;
    reg tensile_2;
    reg [47:0] magnitude_2;
    reg [47:0] moment_x_2;
    reg [47:0] moment_y_2;
    reg [47:0] compression;
    reg [47:0] compression_x;
    reg [47:0] compression_y;
    reg [47:0] tension;
    reg [47:0] tension_x;
    reg [47:0] tension_y;

    always @(posedge clock) begin
        valid_1 <= valid && !reset;
        tensile_1 <= tensile;
        magnitude_1 <= {21'd0, magnitude};
        lower_x_1 <= lower_x;
        upper_x_1 <= upper_x;
        lower_y_1 <= lower_y;
        upper_y_1 <= upper_y;
        valid_2 <= valid_1 && !reset;
        tensile_2 <= tensile_1;
        magnitude_2 <= magnitude_1;
        moment_x_2 <= {{(21-X_HALF){1'b0}}, lower_x_1} + ({{(21-X_HALF){1'b0}}, upper_x_1} << X_HALF);
        moment_y_2 <= {{(21-Y_HALF){1'b0}}, lower_y_1} + ({{(21-Y_HALF){1'b0}}, upper_y_1} << Y_HALF);
        if (valid_2 && tensile_2) begin
            tension <= tension + magnitude_2;
            tension_x <= tension_x + moment_x_2;
            tension_y <= tension_y + moment_y_2;
        end
        if (valid_2 && !tensile_2) begin
            compression <= compression + magnitude_2;
            compression_x <= compression_x + moment_x_2;
            compression_y <= compression_y + moment_y_2;
        end
        if (clear) begin
            compression <= 48'd0;
            compression_x <= 48'd0;
            compression_y <= 48'd0;
            tension <= 48'd0;
            tension_x <= 48'd0;
            tension_y <= 48'd0;
        end
    end

    // ---- After the last stress: a division of both sums for c, then t; two products
    localparam [1:0] IDLE = 2'd0, SETTLE = 2'd1, DIVIDE = 2'd2, SCALE = 2'd3;

    reg [1:0] state;
    reg of_tension; // the division, rather than of the compression
    reg [2:0] step;
    reg divide_start;

    wire [CENTROID_BITS-1:0] quotient_x;
    wire [CENTROID_BITS-1:0] quotient_y;
    wire divide_done;

    sptfra_ratio #(
        .WIDTH        (48),
        .INTEGER_BITS (INDEX_BITS),
        .BITS         (CENTROID_BITS)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (divide_start),
        .numerator_x (of_tension ? tension_x : compression_x),
        .numerator_y (of_tension ? tension_y : compression_y),
        .denominator (of_tension ? tension : compression),
        .done        (divide_done),
        .quotient_x  (quotient_x),
        .quotient_y  (quotient_y)
    );

    reg signed [26:0] difference_x; // first c, then c - t
    reg signed [26:0] difference_y;
    wire signed [26:0] centroid_x = {1'b0, quotient_x};
    wire signed [26:0] centroid_y = {1'b0, quotient_y};
    wire signed [47:0] scaled;
    wire signed [47:0] rounded = scaled + PITCH_HALF;

    sptfra_mac pitch_mac (
        .clock       (clock),
        .reset       (reset),
        .valid       ((state == SCALE) && (step <= 3'd1)),
        .first       (1'b1),
        .coefficient ((step == 3'd0) ? PITCH_X : PITCH_Y),
        .data        ((step == 3'd0) ? difference_x : difference_y),
        .accumulator (scaled)
    );

    assign done = (state == SCALE) && (step == 3'd4);

    always @(posedge clock) begin
        divide_start <= 1'b0;
        step <= step + 3'd1;
        case (state)
            IDLE: begin
                step <= 3'd0;
                of_tension <= 1'b0;
                if (start) begin
                    state <= SETTLE;
                end
            end
            SETTLE: begin
                if (step == 3'd2) begin
                    divide_start <= 1'b1;
                    state <= DIVIDE;
                end
            end
            DIVIDE: begin
                step <= 3'd0;
                if (divide_done) begin
                    difference_x <= of_tension ? difference_x - centroid_x : centroid_x;
                    difference_y <= of_tension ? difference_y - centroid_y : centroid_y;
                    of_tension <= 1'b1;
                    divide_start <= !of_tension;
                    if (of_tension) begin
                        state <= SCALE;
                    end
                end
            end
            default: begin
                if (step == 3'd3) begin
                    push_x <= rounded[PITCH_FRACTION +: 27];
                end
                if (step == 3'd4) begin
                    push_y <= rounded[PITCH_FRACTION +: 27];
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
            divide_start <= 1'b0;
        end
    end

    // The scaled difference has at most 43 bits
    wire _unused = &{1'b0, rounded, x, y};

endmodule

`default_nettype wire
