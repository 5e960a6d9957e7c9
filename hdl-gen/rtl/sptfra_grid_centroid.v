// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Centroid of the weighted points of the 21 x 21 grid of (mu_x, mu_y), which come in the order of the walk: there and
// back in alternate rows. From divide to done: one cycle and two divisions.

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

    localparam [1:0] IDLE = 2'd0, DIVIDE_X = 2'd1, DIVIDE_Y = 2'd2;

    reg [1:0] state;

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
    reg divide_start;
    reg of_y;
    wire signed [47:0] moment = of_y ? moment_y : moment_x;
    reg [47:0] magnitude;
    reg negative;
    wire divide_done;
    wire [63:0] quotient;
    reg negative_ratio;
    wire signed [17:0] ratio = negative_ratio ? -quotient[17:0] : quotient[17:0];

    sptfra_divider divider (
        .clock       (clock),
        .reset       (reset),
        .start       (divide_start),
        .numerator   ({ {(16 - QUOTIENT_FRACTION){1'b0}}, magnitude, {QUOTIENT_FRACTION{1'b0}}}),
        .denominator (weight_sum),
        .quotient    (quotient),
        .done        (divide_done)
    );

    // ---- Sequence
    always @(posedge clock) begin
        done <= 1'b0;
        divide_start <= 1'b0;
        negative <= moment[47];
        if (divide_start) begin
            negative_ratio <= negative;
        end
        magnitude <= moment[47] ? -moment : moment;
        case (state)
            IDLE: begin
                of_y <= 1'b0;
                if (divide) begin
                    divide_start <= 1'b1;
                    state <= DIVIDE_X;
                end
            end
            DIVIDE_X: begin
                of_y <= 1'b1;
                if (divide_done) begin
                    mu_x <= ratio;
                    divide_start <= 1'b1;
                    state <= DIVIDE_Y;
                end
            end
            default: begin
                if (divide_done) begin
                    mu_y <= ratio;
                    done <= 1'b1;
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
            divide_start <= 1'b0;
            done <= 1'b0;
        end
    end

    wire _unused = &{1'b0, quotient[63:18]};

endmodule

`default_nettype wire
