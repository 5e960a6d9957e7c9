// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Standard error of the tangential force over |F_z|, as a logarithm: model, noise and border, added as squares.
//
// s = |MODEL, NOISE largest / stress_sum, BORDER e|. e is the share of the stress at the grid's border beyond 1/32.
// |x, y| is max(x, y, 7/8 of the larger + 1/2 of the smaller). No multiplier: each bit of a quotient adds its weight.
// Latency: 54 cycles from start to the result, which holds until the next start.

`default_nettype none

module sptfra_standard_error #(
    // Error of the model, as a share of |F_z| with 16 fraction bits
    parameter [17:0] MODEL = 18'd0,
    // Errors by noise and by stress at the border, as the header multiplies them, with 13 fraction bits
    parameter [16:0] NOISE = 17'd0,
    parameter [16:0] BORDER = 17'd0
) (
    input  wire clock,
    input  wire reset,
    input  wire start, // with these
    input  wire [39:0] stress_sum, // sum |b|
    input  wire [26:0] largest, // max |b|
    input  wire [39:0] border, // sum |b| of the taxels at the border
    output reg  signed [17:0] error_log // of base 2, from -10 to 2, 12 fraction bits: n + f for 2^n (1 + f)
);

    localparam [5:0] NOISE_END = 6'd16, BORDER_END = 6'd33, ADD = 6'd34, CLIP = 6'd40, LAST = 6'd52;
    localparam [17:0] LEAST = 18'd64; // 2^-10
    localparam [22:0] MOST = 23'd262143; // just below 4

    reg busy;
    reg [5:0] step;
    // ---- Two quotients, a bit a cycle: remainder, and the sum of the weights
    reg [39:0] divisor;
    reg [39:0] excess;
    reg [40:0] remainder;
    reg [33:0] sum;
    wire of_border = (step > NOISE_END);
    wire [41:0] less = {1'b0, remainder} - {2'b00, divisor};
    wire fits = !less[41];
    wire [40:0] kept = fits ? less[40:0] : remainder;
    wire [16:0] weight = of_border ? BORDER : NOISE;
    wire [33:0] next_sum = {sum[32:0], 1'b0} + (fits ? {17'd0, weight} : 34'd0);
    wire [39:0] allowed = {5'd0, divisor[39:5]};

    // ---- Two errors added, then with the third: each in three cycles, for short paths
    reg [22:0] share_noise;
    reg [22:0] share_border;
    reg [22:0] total;
    reg [22:0] larger;
    reg [22:0] smaller;
    reg [22:0] mixed;
    wire [22:0] other = (step == ADD) ? share_noise : share_border;
    wire is_larger = (total > other);

    // ---- Logarithm
    reg [17:0] mantissa;
    reg signed [5:0] exponent;

    always @(posedge clock) begin
        if (start) begin
            busy <= 1'b1;
            step <= 6'd0;
            divisor <= stress_sum;
            excess <= border;
            remainder <= {14'd0, largest};
            sum <= 34'd0;
            total <= {5'd0, MODEL};
        end else if (busy) begin
            step <= step + 6'd1;
            remainder <= {kept[39:0], 1'b0};
            sum <= next_sum;
            if (step == 6'd0) begin
                excess <= (excess > allowed) ? excess - allowed : 40'd0;
            end
            if (step == NOISE_END) begin
                share_noise <= {2'd0, next_sum[33:13]};
                sum <= 34'd0;
                remainder <= {1'b0, excess};
            end
            if (step == BORDER_END) begin
                share_border <= {2'd0, next_sum[33:13]};
            end
            if ((step == ADD) || (step == ADD + 6'd3)) begin
                larger <= is_larger ? total : other;
                smaller <= is_larger ? other : total;
            end
            mixed <= larger - {3'd0, larger[22:3]} + {1'b0, smaller[22:1]};
            if ((step == ADD + 6'd2) || (step == ADD + 6'd5)) begin
                total <= (mixed > larger) ? mixed : larger;
            end
            if (step == CLIP) begin
                mantissa <= (total > MOST) ? MOST[17:0] : (total[17:0] < LEAST) ? LEAST : total[17:0];
                exponent <= 6'sd1;
            end else if (!mantissa[17]) begin
                mantissa <= {mantissa[16:0], 1'b0};
                exponent <= exponent - 6'sd1;
            end
            if (step == LAST) begin
                busy <= 1'b0;
                error_log <= {exponent, mantissa[16:5]};
            end
        end
        if (reset) begin
            busy <= 1'b0;
        end
    end

    wire _unused = &{1'b0, mantissa[4:0], kept[40], sum[33], smaller[0]};

endmodule

`default_nettype wire
