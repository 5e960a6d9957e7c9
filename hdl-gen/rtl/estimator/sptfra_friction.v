// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Friction from the centroid of the level set: mu = c1 mu^ + c3 mu^ |mu^|^2 + correction, clipped to [-2, 2).
//
// One multiplier, step by step. All friction components have 16 fraction bits. From start to done: 20 cycles; where a
// correction comes later than 18 cycles after start, 2 from the correction.

`default_nettype none

module sptfra_friction #(
    // 1: there is a correction, which comes 18 cycles after start or later; 0: none
    parameter integer CORRECTED = 0,
    // c1, 22 fraction bits
    parameter signed [26:0] LINEAR = 27'sd4194304,
    // c3, 15 fraction bits
    parameter signed [17:0] CUBIC = 18'sd0,
    // From start, or from the correction, to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start, // with these held from then on
    input  wire signed [17:0] centroid_x,
    input  wire signed [17:0] centroid_y,
    input  wire unknown, // the components are zero then
    input  wire corrected, // one cycle: these are there
    input  wire signed [17:0] correction_x,
    input  wire signed [17:0] correction_y,
    // Result, held until the next start
    output reg  done, // one cycle
    output reg  signed [17:0] mu_x,
    output reg  signed [17:0] mu_y,
    output reg  clipped
);

    localparam integer FRICTION_FRACTION = 16;
    localparam integer LINEAR_FRACTION = 22; // of c1 and of |mu^|^2
    localparam integer CUBIC_FRACTION = 15; // of c3
    localparam integer FACTOR_FRACTION = 21; // of c1 + c3 |mu^|^2
    localparam integer SQUARE_SHIFT = 2 * FRICTION_FRACTION - LINEAR_FRACTION;
    localparam integer FACTOR_SHIFT = LINEAR_FRACTION + CUBIC_FRACTION - FACTOR_FRACTION;
    localparam signed [17:0] CUBIC_ONE = 18'sd1 <<< CUBIC_FRACTION;
    localparam signed [47:0] FACTOR_HALF = 48'sd1 <<< (FACTOR_FRACTION - 1);

    reg running;
    reg [4:0] step;
    reg valid;
    reg first;
    reg signed [17:0] coefficient;
    reg signed [26:0] data;
    wire signed [47:0] accumulator;
    wire signed [47:0] rounded = accumulator + FACTOR_HALF;
    wire signed [27:0] product = {rounded[47], rounded[FACTOR_FRACTION +: 27]};
    reg signed [26:0] square; // |mu^|^2
    reg signed [26:0] factor; // c1 + c3 |mu^|^2
    reg signed [27:0] sum_x;
    reg signed [27:0] sum_y;
    reg summed; // with the correction
    wire fits_x = (sum_x[27:17] == {11{sum_x[17]}});
    wire fits_y = (sum_y[27:17] == {11{sum_y[17]}});

    // Operands a cycle after the step, sums four after it
    always @(posedge clock) begin
        valid <= 1'b0;
        first <= 1'b1;
        coefficient <= centroid_x;
        data <= factor;
        if (running) begin
            case (step)
                5'd0: begin
                    valid <= 1'b1;
                    data <= { {9{centroid_x[17]}}, centroid_x};
                end
                5'd1: begin
                    valid <= 1'b1;
                    first <= 1'b0;
                    coefficient <= centroid_y;
                    data <= { {9{centroid_y[17]}}, centroid_y};
                end
                5'd6: begin
                    valid <= 1'b1;
                    coefficient <= CUBIC;
                    data <= square;
                end
                5'd7: begin
                    valid <= 1'b1;
                    first <= 1'b0;
                    coefficient <= CUBIC_ONE;
                    data <= LINEAR;
                end
                5'd12: valid <= 1'b1;
                5'd13: begin
                    valid <= 1'b1;
                    coefficient <= centroid_y;
                end
                default: ;
            endcase
        end
        if (reset) begin
            valid <= 1'b0;
        end
    end

    sptfra_mac friction_mac (
        .clock       (clock),
        .reset       (reset),
        .valid       (valid),
        .first       (first),
        .coefficient (coefficient),
        .data        (data),
        .accumulator (accumulator)
    );

    always @(posedge clock) begin
        done <= 1'b0;
        if (running) begin
            step <= step + 5'd1;
            case (step)
                5'd5: square <= accumulator[SQUARE_SHIFT +: 27];
                5'd11: factor <= accumulator[FACTOR_SHIFT +: 27];
                5'd16: sum_x <= product;
                5'd17: begin
                    sum_y <= product;
                    running <= 1'b0;
                end
                default: ;
            endcase
        end
        if (corrected) begin
            sum_x <= sum_x + { {10{correction_x[17]}}, correction_x};
            sum_y <= sum_y + { {10{correction_y[17]}}, correction_y};
        end
        summed <= (CORRECTED != 0) ? corrected : running && (step == 5'd17);
        if (summed) begin
            mu_x <= unknown ? 18'sd0 : fits_x ? sum_x[17:0] : {sum_x[27], {17{!sum_x[27]}}};
            mu_y <= unknown ? 18'sd0 : fits_y ? sum_y[17:0] : {sum_y[27], {17{!sum_y[27]}}};
            clipped <= !unknown && !(fits_x && fits_y);
            done <= 1'b1;
        end
        if (start) begin
            running <= 1'b1;
            step <= 5'd0;
        end
        if (reset) begin
            running <= 1'b0;
            summed <= 1'b0;
            done <= 1'b0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start ((CORRECTED != 0) ? corrected : start),
        .done  (done)
    );

    wire _unused = &{1'b0, accumulator, rounded};

endmodule

`default_nettype wire
