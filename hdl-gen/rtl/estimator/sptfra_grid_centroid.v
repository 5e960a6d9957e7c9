// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Centroid of the weighted points of the 21 x 21 grid of (mu_x, mu_y), which come in the order of the walk: there and
// back in alternate rows. From divide to done: 20 cycles.

`default_nettype none

module sptfra_grid_centroid (
    input  wire clock,
    input  wire reset,
    // Weights
    input  wire start, // before the first one
    input  wire valid,
    input  wire signed [26:0] weight, // not negative
    input  wire divide, // all are in the sums
    // Result, held until the next start
    output reg  done, // one cycle
    output reg  signed [17:0] mu_x, // 16 fraction bits
    output reg  signed [17:0] mu_y
);

    localparam signed [17:0] BORDER = 18'sd10; // steps from the middle of the grid to its border
    // Of a moment over a sum of weights, in steps of the grid, which are eighths
    localparam integer QUOTIENT_FRACTION = 13;

    localparam integer WHOLE_BITS = 4; // of that quotient, up to BORDER

    // ---- Sums of the weights, and of their products with the column and the row from the middle
    reg signed [17:0] column;
    reg signed [17:0] row;
    reg back;
    wire row_end = (column == (back ? -BORDER : BORDER));
    reg first;
    reg [47:0] weight_sum;
    wire signed [47:0] moment_x;
    wire signed [47:0] moment_y;

    sptfra_mac moments_x (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (column),
        .data        (weight),
        .accumulator (moment_x)
    );

    sptfra_mac moments_y (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (row),
        .data        (weight),
        .accumulator (moment_y)
    );

    always @(posedge clock) begin
        if (valid) begin
            first <= 1'b0;
            weight_sum <= weight_sum + {21'd0, weight};
            if (row_end) begin
                back <= !back;
                row <= row + 18'sd1;
            end else begin
                column <= back ? column - 18'sd1 : column + 18'sd1;
            end
        end
        if (start) begin
            first <= 1'b1;
            weight_sum <= 48'd0;
            column <= -BORDER;
            row <= -BORDER;
            back <= 1'b0;
        end
    end

    // ---- Centroid: mu = (moment / sum of weights) / 8
    localparam integer RATIO_BITS = WHOLE_BITS + QUOTIENT_FRACTION;
    reg divide_start;
    reg [47:0] magnitude_x;
    reg [47:0] magnitude_y;
    wire divide_done;
    wire [RATIO_BITS-1:0] ratio_x;
    wire [RATIO_BITS-1:0] ratio_y;

    sptfra_ratio #(
        .WIDTH        (48),
        .INTEGER_BITS (WHOLE_BITS),
        .BITS         (RATIO_BITS)
    ) ratio (
        .clock       (clock),
        .reset       (reset),
        .start       (divide_start),
        .numerator_x (magnitude_x),
        .numerator_y (magnitude_y),
        .denominator (weight_sum),
        .done        (divide_done),
        .quotient_x  (ratio_x),
        .quotient_y  (ratio_y)
    );

    always @(posedge clock) begin
        magnitude_x <= moment_x[47] ? -moment_x : moment_x;
        magnitude_y <= moment_y[47] ? -moment_y : moment_y;
        divide_start <= divide;
        done <= divide_done;
        if (divide_done) begin
            mu_x <= moment_x[47] ? -{1'b0, ratio_x} : {1'b0, ratio_x};
            mu_y <= moment_y[47] ? -{1'b0, ratio_y} : {1'b0, ratio_y};
        end
        if (reset) begin
            divide_start <= 1'b0;
            done <= 1'b0;
        end
    end

endmodule

`default_nettype wire
